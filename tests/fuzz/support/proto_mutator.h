// Structured mutation: changes to a protobuf message that leave it one, by reflection.
//
// Random bytes hardly ever parse as a job; a job with one odd field does, and reaches the code
// behind the parser.

#ifndef TRAVERSE_TESTS_FUZZ_SUPPORT_PROTO_MUTATOR_H_
#define TRAVERSE_TESTS_FUZZ_SUPPORT_PROTO_MUTATOR_H_

#include <google/protobuf/message.h>

#include <random>

namespace traverse::fuzz {

// Makes one change somewhere in `message`: a scalar takes an ordinary, an extreme or a random
// value; a field is set or cleared; an element of a list is added, repeated, moved or removed.
// `donor`, of the same type, is where whole fields may be taken from.
void MutateMessage(google::protobuf::Message& message, const google::protobuf::Message& donor,
                   std::mt19937& random);

}  // namespace traverse::fuzz

#endif  // TRAVERSE_TESTS_FUZZ_SUPPORT_PROTO_MUTATOR_H_

// Messages of the API from JSON, by protobuf's mapping: fields under their names in the .proto or
// in camel case, numbers also as text, enums by name or number, null for what is not set.
//
// protobuf's own reader takes the last of keys given twice, and names no place of what it refuses.

#ifndef TRAVERSE_CLIENT_FORMATS_MESSAGE_JSON_H_
#define TRAVERSE_CLIENT_FORMATS_MESSAGE_JSON_H_

#include <google/protobuf/message.h>

#include <string_view>

#include "absl/status/status.h"

namespace traverse {

// Adds what `json` says to `message`. Takes time and memory as the text is long, however it is
// nested: nothing nests deeper than the messages do.
//
// Errors, in one line with the place as the service names it, `layers[3].islands[0].id: given
// twice`: InvalidArgument for what is not JSON, values of another type or out of its range, and
// keys given twice; Unimplemented for fields and values of enums that are unknown. `message` is
// then of no use. "NaN" and "Infinity" are numbers of the mapping: the service refuses them.
//
// REQUIRES: no field of `message` is of type bytes, or a well-known type other than Duration.
absl::Status ReadMessageJson(std::string_view json, google::protobuf::Message& message);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_FORMATS_MESSAGE_JSON_H_

#ifndef TRAVERSE_CLIENT_INPUT_INPUT_FORMAT_H_
#define TRAVERSE_CLIENT_INPUT_INPUT_FORMAT_H_

namespace traverse {

// The formats that the client reads.
enum class InputFormat {
  kDamat,
  kGcode,
  kJson,   // OptimizeBatchRequest in protobuf's JSON mapping
  kProto,  // OptimizeBatchRequest in wire format
  kGtsp,   // GTSPLIB
};

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_INPUT_INPUT_FORMAT_H_

// Reads a request piece by piece.
//
// A whole job in one message can be tens of MB, and parsing it in one go takes as long as solving
// thousands of layers. OptimizeBatchRequest and OptimizeRequest have the same fields. This class
// finds the layers in the bytes, parses a few at a time, and frees the bytes as it goes on.

#ifndef TRAVERSE_SERVER_RPC_REQUEST_READER_H_
#define TRAVERSE_SERVER_RPC_REQUEST_READER_H_

#include <google/protobuf/io/coded_stream.h>
#include <grpcpp/support/byte_buffer.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "server/rpc/slice_stream.h"
#include "traverse/v1/options.pb.h"
#include "traverse/v1/plan.pb.h"

namespace traverse {

// How much a message may contain.
struct RequestLimits {
  int64_t parts_of_layer = INT64_MAX;   // islands, paths, nodes, pairs
  int64_t footprint_bytes = INT64_MAX;  // of all layers, once they are read

  // With more layers than this, reading stops: layers() is then one more than this, and nothing may
  // be read from the message.
  int64_t layers = INT64_MAX - 1;
};

// One message. Not thread-safe.
class RequestReader {
 public:
  // Takes the bytes out of `message` and finds its contents. Errors: InvalidArgument if it is not a
  // `type_name`; Unimplemented if it has a field that only a later version knows; ResourceExhausted
  // if it contains more than `limits` allow.
  //
  // `goes_on`, if not null, is called after every few thousand bytes, by Read too. It may yield to
  // others. Once it returns false, the message counts as invalid.
  absl::Status Open(const char* type_name, grpc::ByteBuffer& message,
                    const RequestLimits& limits = {}, SliceStream::GoesOn goes_on = nullptr);

  // About the open message.
  bool has_options() const { return has_options_; }
  const v1::JobOptions& options() const { return options_; }
  int64_t layers() const { return layers_; }

  // The memory that the layers need once they are read, in bytes. Counted before anything is
  // parsed: two bytes may stand for an island.
  int64_t footprint_bytes() const { return footprint_bytes_; }

  // The same for the layer that was read last.
  int64_t layer_footprint_bytes() const {
    return layer_bytes_[static_cast<size_t>(layers_ - left_)];
  }

  // Number of layers not read yet.
  int64_t left() const { return left_; }

  // Parses the next layers, about `bytes` of them and at least one, and gives each to `take`, until
  // that returns an error. Errors: that one; InvalidArgument if the message is not valid.
  absl::Status Read(int64_t bytes, const std::function<absl::Status(const v1::Layer&)>& take);

 private:
  using CodedInputStream = google::protobuf::io::CodedInputStream;

  absl::Status NotValid() const;

  // The steps of Open, for the field with `tag`.
  absl::Status LookAtField(uint32_t tag, const RequestLimits& limits, CodedInputStream& in);
  absl::Status CountLayer(const RequestLimits& limits, CodedInputStream& in);
  absl::Status ReadOptions(CodedInputStream& in);

  std::string type_name_;
  int64_t bytes_ = 0;
  SliceStream stream_;
  bool has_options_ = false;
  v1::JobOptions options_;
  int64_t options_bytes_ = 0;
  int64_t layers_ = 0;
  int64_t left_ = 0;
  int64_t footprint_bytes_ = 0;
  std::vector<int64_t> layer_bytes_;  // [layer] its part of footprint_bytes_
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_RPC_REQUEST_READER_H_

// Reads a request piece by piece.
//
// A whole job in one message is tens of MB, and to parse it at one go takes as long as thousands of
// layers take to be solved. OptimizeBatchRequest and OptimizeRequest have the same fields; this
// finds the layers in the bytes, parses a few at a time, and lets go of the bytes as it goes on.

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

// How much there may be in a message.
struct RequestLimits {
  int64_t parts_of_layer = INT64_MAX;   // islands, paths, nodes, pairs
  int64_t footprint_bytes = INT64_MAX;  // of all layers, once they are read

  // With more layers the message is looked at no further: layers() is then one more than this, and
  // nothing may be read of it.
  int64_t layers = INT64_MAX - 1;
};

// One message. Not thread-safe.
class RequestReader {
 public:
  // Takes the bytes out of `message` and finds what is in them. Errors: InvalidArgument if it is no
  // `type_name`; Unimplemented if it has a field that only a later version knows; ResourceExhausted
  // if there is more in it than `limits` allow.
  //
  // `goes_on`, if there is one, is asked after every some thousand bytes, by Read too: it may let
  // others have their turns; once it says false the message counts as not valid.
  absl::Status Open(const char* type_name, grpc::ByteBuffer& message,
                    const RequestLimits& limits = {}, SliceStream::GoesOn goes_on = nullptr);

  // Of the message that is open.
  bool has_options() const { return has_options_; }
  const v1::JobOptions& options() const { return options_; }
  int64_t layers() const { return layers_; }

  // What the layers come to in memory once they are read, in bytes. Counted before anything is
  // parsed: two bytes may stand for an island.
  int64_t footprint_bytes() const { return footprint_bytes_; }

  // The same of the layer that was read last.
  int64_t layer_footprint_bytes() const {
    return layer_bytes_[static_cast<size_t>(layers_ - left_)];
  }

  // Layers not read yet.
  int64_t left() const { return left_; }

  // Parses the next layers, those of about `bytes` and one at least, and gives each to `take`,
  // until that returns an error. Errors: that one; InvalidArgument if the message is not valid.
  absl::Status Read(int64_t bytes, const std::function<absl::Status(const v1::Layer&)>& take);

 private:
  using CodedInputStream = google::protobuf::io::CodedInputStream;

  absl::Status NotValid() const;

  // The steps of Open, for the field behind `tag`.
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
  std::vector<int64_t> layer_bytes_;  // [layer] of footprint_bytes_
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_RPC_REQUEST_READER_H_

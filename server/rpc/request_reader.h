// Reads a request piece by piece.
//
// A whole job in one message is tens of MB, and to parse it at one go takes as long as thousands of
// layers take to be solved. OptimizeBatchRequest and OptimizeRequest have the same fields; this
// finds the layers in the bytes, parses a few at a time, and lets go of the bytes as it goes on.

#ifndef TRAVERSE_SERVER_RPC_REQUEST_READER_H_
#define TRAVERSE_SERVER_RPC_REQUEST_READER_H_

#include <google/protobuf/io/zero_copy_stream.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/slice.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "traverse/v1/options.pb.h"
#include "traverse/v1/plan.pb.h"

namespace traverse {

// The bytes of a message, in the slices that gRPC received.
class SliceStream : public google::protobuf::io::ZeroCopyInputStream {
 public:
  // Begins with the first byte of `slices`.
  void Open(std::vector<grpc::Slice> slices);

  // Begins anew; from now on slices that were read are let go.
  void RewindAndLetGo();

  bool Next(const void** data, int* size) override;
  void BackUp(int count) override;
  bool Skip(int count) override;
  int64_t ByteCount() const override { return count_; }

 private:
  std::vector<grpc::Slice> slices_;
  size_t next_ = 0;    // the slice that comes next, or of which a part is left
  size_t offset_ = 0;  // what was read of it
  int64_t count_ = 0;
  bool let_go_ = false;
};

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
  absl::Status Open(const char* type_name, grpc::ByteBuffer& message,
                    const RequestLimits& limits = {});

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
  absl::Status NotValid() const;

  std::string type_name_;
  int64_t bytes_ = 0;
  SliceStream stream_;
  bool has_options_ = false;
  v1::JobOptions options_;
  int64_t layers_ = 0;
  int64_t left_ = 0;
  int64_t footprint_bytes_ = 0;
  std::vector<int64_t> layer_bytes_;  // [layer] of footprint_bytes_
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_RPC_REQUEST_READER_H_

// The bytes of a message as protobuf reads them.

#ifndef TRAVERSE_SERVER_RPC_SLICE_STREAM_H_
#define TRAVERSE_SERVER_RPC_SLICE_STREAM_H_

#include <google/protobuf/io/zero_copy_stream.h>
#include <grpcpp/support/slice.h>

#include <cstdint>
#include <vector>

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

}  // namespace traverse

#endif  // TRAVERSE_SERVER_RPC_SLICE_STREAM_H_

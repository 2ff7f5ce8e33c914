// The bytes of a message, in the form in which protobuf reads them.

#ifndef TRAVERSE_SERVER_RPC_SLICE_STREAM_H_
#define TRAVERSE_SERVER_RPC_SLICE_STREAM_H_

#include <google/protobuf/io/zero_copy_stream.h>
#include <grpcpp/support/slice.h>

#include <cstdint>
#include <functional>
#include <vector>

namespace traverse {

// The bytes of a message, in the slices that gRPC received.
class SliceStream : public google::protobuf::io::ZeroCopyInputStream {
 public:
  // Called before each piece is read; false ends the stream.
  using GoesOn = std::function<bool()>;

  // Begins with the first byte of `slices`.
  void Open(std::vector<grpc::Slice> slices, GoesOn goes_on = nullptr);

  // Begins again; from now on frees slices that were read.
  void RewindAndLetGo();

  // Whether it was ended early, so that not all of it was read.
  bool stopped() const { return stopped_; }

  bool Next(const void** data, int* size) override;
  void BackUp(int count) override;
  bool Skip(int count) override;
  int64_t ByteCount() const override { return count_; }

 private:
  // About a millisecond's work, if every two bytes are an island.
  static constexpr size_t kPiece = 16 << 10;

  std::vector<grpc::Slice> slices_;
  GoesOn goes_on_;
  size_t slice_ = 0;   // the slice being read
  size_t offset_ = 0;  // how much of it was read
  int64_t count_ = 0;
  bool let_go_ = false;
  bool stopped_ = false;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_RPC_SLICE_STREAM_H_

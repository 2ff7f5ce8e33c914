#include "server/rpc/slice_stream.h"

#include <utility>

namespace traverse {

void SliceStream::Open(std::vector<grpc::Slice> slices) {
  slices_ = std::move(slices);
  next_ = 0;
  offset_ = 0;
  count_ = 0;
  let_go_ = false;
}

void SliceStream::RewindAndLetGo() {
  next_ = 0;
  offset_ = 0;
  count_ = 0;
  let_go_ = true;
}

bool SliceStream::Next(const void** data, int* size) {
  // The one before was read to its end, and nobody backs up into it any more.
  if (let_go_ && offset_ == 0 && next_ > 0) slices_[next_ - 1] = grpc::Slice();
  while (next_ < slices_.size() && slices_[next_].size() == 0) ++next_;
  if (next_ == slices_.size()) return false;
  const grpc::Slice& slice = slices_[next_];
  *data = slice.begin() + offset_;
  *size = static_cast<int>(slice.size() - offset_);
  count_ += *size;
  ++next_;
  offset_ = 0;
  return true;
}

void SliceStream::BackUp(int count) {
  if (count == 0) return;
  --next_;
  offset_ = slices_[next_].size() - static_cast<size_t>(count);
  count_ -= count;
}

bool SliceStream::Skip(int count) {
  const void* data = nullptr;
  int size = 0;
  while (count > 0) {
    if (!Next(&data, &size)) return false;
    if (size > count) BackUp(size - count);
    count -= size;
  }
  return true;
}

}  // namespace traverse

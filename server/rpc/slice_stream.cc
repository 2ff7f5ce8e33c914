#include "server/rpc/slice_stream.h"

#include <algorithm>
#include <utility>

namespace traverse {

void SliceStream::Open(std::vector<grpc::Slice> slices, GoesOn goes_on) {
  slices_ = std::move(slices);
  goes_on_ = std::move(goes_on);
  slice_ = 0;
  offset_ = 0;
  count_ = 0;
  let_go_ = false;
  stopped_ = false;
}

void SliceStream::RewindAndLetGo() {
  slice_ = 0;
  offset_ = 0;
  count_ = 0;
  let_go_ = true;
}

bool SliceStream::Next(const void** data, int* size) {
  stopped_ = stopped_ || (goes_on_ && !goes_on_());
  if (stopped_) return false;
  while (slice_ < slices_.size() && offset_ == slices_[slice_].size()) {
    // It was read to its end, and nobody will back up into it.
    if (let_go_) slices_[slice_] = grpc::Slice();
    ++slice_;
    offset_ = 0;
  }
  if (slice_ == slices_.size()) return false;
  const grpc::Slice& slice = slices_[slice_];
  const size_t count = std::min(kPiece, slice.size() - offset_);
  *data = slice.begin() + offset_;
  *size = static_cast<int>(count);
  offset_ += count;
  count_ += *size;
  return true;
}

void SliceStream::BackUp(int count) {
  offset_ -= static_cast<size_t>(count);
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

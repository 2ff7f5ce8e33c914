#include "server/request_reader.h"

#include <google/protobuf/arena.h>
#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/wire_format_lite.h>

#include <climits>
#include <utility>

#include "absl/strings/str_cat.h"
#include "traverse/v1/route_optimizer_service.pb.h"

namespace traverse {
namespace {

using google::protobuf::internal::WireFormatLite;
using google::protobuf::io::CodedInputStream;

using Batch = v1::OptimizeBatchRequest;
static_assert(int{Batch::kOptionsFieldNumber} == int{v1::OptimizeRequest::kOptionsFieldNumber});
static_assert(int{Batch::kLayersFieldNumber} == int{v1::OptimizeRequest::kLayersFieldNumber});

constexpr uint32_t Tag(int field) {
  return static_cast<uint32_t>(field) << 3 | WireFormatLite::WIRETYPE_LENGTH_DELIMITED;
}
constexpr uint32_t kOptionsTag = Tag(Batch::kOptionsFieldNumber);
constexpr uint32_t kLayersTag = Tag(Batch::kLayersFieldNumber);

// What a layer counts as, beside its bytes: an empty one takes time too.
constexpr int64_t kLayerBytes = 64;

bool ReadLength(CodedInputStream& in, int& length) {
  uint32_t value = 0;
  if (!in.ReadVarint32(&value) || value > INT_MAX) return false;
  length = static_cast<int>(value);
  return true;
}

google::protobuf::ArenaOptions LargeBlocks() {
  google::protobuf::ArenaOptions options;
  options.start_block_size = 32 << 10;
  options.max_block_size = 256 << 10;
  return options;
}

}  // namespace

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

absl::Status RequestReader::NotValid() const {
  return absl::InvalidArgumentError(
      absl::StrCat("the message of ", bytes_, " bytes is not a valid ", type_name_));
}

absl::Status RequestReader::Open(const char* type_name, grpc::ByteBuffer& message) {
  type_name_ = type_name;
  bytes_ = static_cast<int64_t>(message.Length());
  has_options_ = false;
  options_.Clear();
  layers_ = left_ = 0;
  std::vector<grpc::Slice> slices;
  if (bytes_ > 0 && !message.Dump(&slices).ok()) return NotValid();
  message.Clear();
  stream_.Open(std::move(slices));
  {
    CodedInputStream in(&stream_);
    uint32_t tag = 0;
    while ((tag = in.ReadTag()) != 0) {
      int length = 0;
      if (tag == kLayersTag) {
        if (!ReadLength(in, length) || !in.Skip(length)) return NotValid();
        ++layers_;
      } else if (tag == kOptionsTag) {
        std::string bytes;
        if (!ReadLength(in, length) || !in.ReadString(&bytes, length)) return NotValid();
        if (!options_.MergeFromString(bytes)) return NotValid();
        has_options_ = true;
      } else {
        if (!WireFormatLite::SkipField(&in, tag)) return NotValid();
        return absl::UnimplementedError(
            absl::StrCat("field number ", WireFormatLite::GetTagFieldNumber(tag),
                         " of the message is not known to this version of the server"));
      }
    }
    if (!in.ConsumedEntireMessage()) return NotValid();
  }
  left_ = layers_;
  stream_.RewindAndLetGo();
  return absl::OkStatus();
}

absl::Status RequestReader::Read(int64_t bytes,
                                 const std::function<absl::Status(const v1::Layer&)>& take) {
  google::protobuf::Arena arena(LargeBlocks());
  for (int64_t read = 0; left_ > 0 && read < bytes;) {
    bool is_layer = false;
    int length = 0;
    {
      CodedInputStream in(&stream_);
      is_layer = in.ReadTag() == kLayersTag;
      if (!ReadLength(in, length)) return NotValid();
      if (!is_layer && !in.Skip(length)) return NotValid();  // options, which are known by now
    }
    if (!is_layer) continue;
    auto* layer = google::protobuf::Arena::CreateMessage<v1::Layer>(&arena);
    if (!layer->ParseFromBoundedZeroCopyStream(&stream_, length)) return NotValid();
    if (absl::Status status = take(*layer); !status.ok()) return status;
    read += length + kLayerBytes;
    --left_;
  }
  if (left_ == 0) stream_.Open({});
  return absl::OkStatus();
}

}  // namespace traverse

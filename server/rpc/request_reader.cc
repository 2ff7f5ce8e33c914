#include "server/rpc/request_reader.h"

#include <google/protobuf/arena.h>
#include <google/protobuf/wire_format_lite.h>

#include <algorithm>
#include <climits>
#include <utility>

#include "absl/strings/str_cat.h"
#include "traverse/v1/route_optimizer_service.pb.h"

namespace traverse {
namespace {

using google::protobuf::Descriptor;
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

// The weight of a layer in addition to its bytes: an empty one takes time too.
constexpr int64_t kLayerBytes = 64;

bool ReadLength(CodedInputStream& in, int& length) {
  uint32_t value = 0;
  if (!in.ReadVarint32(&value) || value > INT_MAX) return false;
  length = static_cast<int>(value);
  return true;
}

// The contents of a message: messages within it, and bytes of numbers and text.
struct Content {
  int64_t parts = 0;
  int64_t bytes = 0;
};

// The memory of a part as a message and then in the engine; a point of two doubles is in both.
// Measured with contours of one point and with empty islands.
constexpr int64_t kBytesOfPart = 320;
constexpr int64_t kBytesOfByte = 3;

// A packed number of one byte takes four in memory, or eight where its array grew.
constexpr int64_t kBytesOfPacked = 4;

// A field that this version does not know is kept until it is refused, and may have two bytes.
constexpr int64_t kBytesOfUnknown = 2;

// No options that mean anything have more bytes, or parts. They are parsed at once, before anything
// of the message is held.
constexpr int64_t kMostOptionsBytes = 1 << 20;
constexpr int64_t kMostOptionsParts = 4096;

bool IsPacked(const google::protobuf::FieldDescriptor& field) {
  return field.is_packed() && field.cpp_type() != google::protobuf::FieldDescriptor::CPPTYPE_DOUBLE;
}

// Counts the contents of a message of `type`, up to the limit that `in` has. Recurses as deep as
// the types. Stops at `most` parts, because counting on would take long.
bool CountContent(CodedInputStream& in, const Descriptor& type, int64_t most, Content& content) {
  uint32_t tag = 0;
  while (content.parts <= most && (tag = in.ReadTag()) != 0) {
    if (WireFormatLite::GetTagWireType(tag) != WireFormatLite::WIRETYPE_LENGTH_DELIMITED) {
      content.bytes += static_cast<int64_t>(sizeof(double));
      const int before = in.CurrentPosition();
      if (!WireFormatLite::SkipField(&in, tag)) return false;
      // A group, which no version has, may be as long as the message.
      if (WireFormatLite::GetTagWireType(tag) == WireFormatLite::WIRETYPE_START_GROUP) {
        content.parts += 1 + (in.CurrentPosition() - before) / kBytesOfUnknown;
      }
      continue;
    }
    int length = 0;
    if (!ReadLength(in, length)) return false;
    const google::protobuf::FieldDescriptor* const field =
        type.FindFieldByNumber(WireFormatLite::GetTagFieldNumber(tag));
    if (field == nullptr || field->message_type() == nullptr) {
      if (field == nullptr) ++content.parts;
      content.bytes += field != nullptr && IsPacked(*field) ? kBytesOfPacked * length : length;
      if (!in.Skip(length)) return false;
      continue;
    }
    ++content.parts;
    const CodedInputStream::Limit limit = in.PushLimit(length);
    if (!CountContent(in, *field->message_type(), most, content)) return false;
    if (content.parts > most) return true;
    if (in.BytesUntilLimit() != 0) return false;
    in.PopLimit(limit);
  }
  return content.parts > most || in.ConsumedEntireMessage();
}

bool HasFewParts(const std::string& options) {
  CodedInputStream in(reinterpret_cast<const uint8_t*>(options.data()),
                      static_cast<int>(options.size()));
  Content content;
  const bool valid = CountContent(in, *v1::JobOptions::descriptor(), kMostOptionsParts, content);
  return !valid || content.parts <= kMostOptionsParts;
}

google::protobuf::ArenaOptions LargeBlocks() {
  google::protobuf::ArenaOptions options;
  options.start_block_size = 32 << 10;
  options.max_block_size = 256 << 10;
  return options;
}

}  // namespace

absl::Status RequestReader::NotValid() const {
  return absl::InvalidArgumentError(
      absl::StrCat("the message of ", bytes_, " bytes is not a valid ", type_name_));
}

absl::Status RequestReader::Open(const char* type_name, grpc::ByteBuffer& message,
                                 const RequestLimits& limits, SliceStream::GoesOn goes_on) {
  type_name_ = type_name;
  bytes_ = static_cast<int64_t>(message.Length());
  has_options_ = false;
  options_.Clear();
  options_bytes_ = layers_ = left_ = footprint_bytes_ = 0;
  layer_bytes_.clear();
  std::vector<grpc::Slice> slices;
  if (bytes_ > 0 && !message.Dump(&slices).ok()) return NotValid();
  message.Clear();
  stream_.Open(std::move(slices), std::move(goes_on));
  {
    CodedInputStream in(&stream_);
    uint32_t tag = 0;
    while ((tag = in.ReadTag()) != 0) {
      if (absl::Status status = LookAtField(tag, limits, in); !status.ok()) return status;
      if (layers_ > limits.layers) return absl::OkStatus();
    }
    if (!in.ConsumedEntireMessage() || stream_.stopped()) return NotValid();
  }
  left_ = layers_;
  stream_.RewindAndLetGo();
  return absl::OkStatus();
}

absl::Status RequestReader::LookAtField(uint32_t tag, const RequestLimits& limits,
                                        CodedInputStream& in) {
  if (tag == kLayersTag) return CountLayer(limits, in);
  if (tag == kOptionsTag) return ReadOptions(in);
  if (!WireFormatLite::SkipField(&in, tag)) return NotValid();
  return absl::UnimplementedError(
      absl::StrCat("field number ", WireFormatLite::GetTagFieldNumber(tag),
                   " of the message is unknown to this version of the server"));
}

absl::Status RequestReader::CountLayer(const RequestLimits& limits, CodedInputStream& in) {
  int length = 0;
  if (!ReadLength(in, length)) return NotValid();
  const CodedInputStream::Limit limit = in.PushLimit(length);
  Content content;
  const Descriptor& layer = *v1::Layer::descriptor();
  if (!CountContent(in, layer, limits.parts_of_layer, content)) return NotValid();
  if (content.parts > limits.parts_of_layer) {
    return absl::ResourceExhaustedError(
        absl::StrCat("layers[", layers_, "]: more islands, paths, nodes and pairs than this ",
                     "server's limit of ", limits.parts_of_layer));
  }
  in.PopLimit(limit);
  if (++layers_ > limits.layers) return absl::OkStatus();
  layer_bytes_.push_back((content.parts + 1) * kBytesOfPart + content.bytes * kBytesOfByte);
  footprint_bytes_ += layer_bytes_.back();
  if (footprint_bytes_ > limits.footprint_bytes) {
    return absl::ResourceExhaustedError(
        absl::StrCat("layers[", layers_ - 1, "]: up to here the message needs more than ",
                     limits.footprint_bytes >> 20, " MiB, which is all the memory for jobs"));
  }
  return absl::OkStatus();
}

absl::Status RequestReader::ReadOptions(CodedInputStream& in) {
  int length = 0;
  std::string bytes;
  if (!ReadLength(in, length)) return NotValid();
  options_bytes_ += length;
  if (options_bytes_ > kMostOptionsBytes) {
    return absl::ResourceExhaustedError(
        absl::StrCat("options: more than ", kMostOptionsBytes, " bytes"));
  }
  if (!in.ReadString(&bytes, length)) return NotValid();
  if (!HasFewParts(bytes)) {
    return absl::ResourceExhaustedError(
        absl::StrCat("options: more than ", kMostOptionsParts, " parts"));
  }
  if (!options_.MergeFromString(bytes)) return NotValid();
  has_options_ = true;
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

#include "client/containers/bgcode/bgcode_container.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/str_format.h"
#include "client/containers/bgcode/block.h"
#include "client/containers/bgcode/meatpack.h"
#include "client/containers/bgcode/metadata.h"
#include "client/containers/bgcode/payload.h"
#include "client/containers/limits.h"
#include "client/files/read_file.h"
#include "client/gcode/parallel.h"

namespace traverse::containers {
namespace {

using gcode::TimeScale;

// Limit for all metadata entries together: a slicer's settings are some ten thousand bytes. An
// entry of three bytes takes twenty times as much memory once it is read.
constexpr size_t kMaxMetadataBytes = size_t{4} << 20;

bool HasMetadata(BlockKind kind) {
  return kind == BlockKind::kFileMetadata || kind == BlockKind::kSlicerMetadata ||
         kind == BlockKind::kPrinterMetadata || kind == BlockKind::kPrintMetadata;
}

// Where the entries of a block of `kind` belong.
Metadata& EntriesOf(BlockKind kind, BgcodeMetadata& metadata) {
  switch (kind) {
    case BlockKind::kFileMetadata:
      return metadata.file;
    case BlockKind::kSlicerMetadata:
      return metadata.slicer;
    case BlockKind::kPrinterMetadata:
      return metadata.printer;
    default:
      return metadata.print;
  }
}

// Block `index`, whose entries state print times, with new times; empty if it states none.
absl::StatusOr<std::string> RestatedBlock(const BgcodeBlocks& file, const Block& block,
                                          const TimeScale& scale) {
  const absl::StatusOr<std::string> text = DecompressBlock(block);
  if (!text.ok()) return text.status();
  std::string restated;
  bool any = false;
  for (size_t at = 0; at < text->size();) {
    const size_t end = std::min(text->find('\n', at), text->size());
    const std::string_view line = std::string_view(*text).substr(at, end - at);
    at = end + 1;
    const size_t is = std::min(line.find('='), line.size());
    const auto value = is == line.size()
                           ? std::nullopt
                           : gcode::RestateEntry(line.substr(0, is), line.substr(is + 1), scale);
    any = any || value;
    restated += value ? std::string(line.substr(0, is + 1)) + *value : std::string(line);
    if (end < text->size()) restated += '\n';
  }
  std::string out;
  if (!any) return out;
  const absl::StatusOr<std::string> data = CompressBytes(restated, block.compression);
  if (!data.ok()) return data.status();
  AppendBlock(block.kind, block.compression, {block.parameters[0]},
              static_cast<uint32_t>(restated.size()), *data, file.checksum, out);
  return out;
}

class BgcodeContainer : public Container {
 public:
  BgcodeContainer(std::string bytes, std::string name, const ContainerOptions& options)
      : bytes_(std::move(bytes)), name_(std::move(name)), options_(options), parts_(1) {}

  // REQUIRES: called once, before all other functions.
  absl::Status Open() {
    absl::StatusOr<BgcodeBlocks> file = ParseBlocks(bytes_);
    if (!file.ok()) return Fault(file.status());
    file_ = *std::move(file);
    size_t left = std::min(kMaxMetadataBytes, options_.max_text_bytes);
    bool any = false;
    for (size_t i = 0; i < file_.blocks.size(); ++i) {
      const Block& block = file_.blocks[i];
      any = any || block.is_gcode();
      absl::Status status;
      if (HasMetadata(block.kind)) status = ReadMetadata(block, left);
      if (block.kind == BlockKind::kThumbnail) ReadThumbnail(block);
      if (!status.ok()) {
        return Fault(absl::Status(
            status.code(), absl::StrFormat("%s (%s): %s", BlockPlace(file_, i),
                                           BlockName(block.kind), std::string(status.message()))));
      }
    }
    if (!any) return Fault(absl::InvalidArgumentError("it has no block of G-code"));
    head_ = HeadText(metadata_);
    tail_ = TailText(metadata_);
    return absl::OkStatus();
  }

  ContainerKind kind() const override { return ContainerKind::kBgcode; }
  const std::vector<GcodePart>& parts() const override { return parts_; }

  absl::StatusOr<std::string> Text(size_t) const override {
    absl::StatusOr<std::string> body = Body();
    if (!body.ok()) return Fault(body.status());
    body->reserve(head_.size() + body->size() + 1 + tail_.size());
    body->insert(0, head_);
    if (!body->ends_with('\n')) *body += '\n';
    *body += tail_;
    return body;
  }

  size_t StatedBytes() const override {
    size_t sum = head_.size() + 1 + tail_.size();
    for (const Block& block : file_.blocks) sum += block.is_gcode() ? block.size : 0;
    return sum;
  }

  absl::Status VisitTexts(const TextSink& sink) const override {
    sink(0, head_);
    const absl::Status status =
        VisitGcode(file_, MaxTextBytes(bytes_.size(), options_.max_text_bytes),
                   [&](std::string_view piece) { sink(0, piece); });
    if (!status.ok()) return Fault(status);
    sink(0, "\n");
    sink(0, tail_);
    return status;
  }

  absl::StatusOr<std::string> WithParts(const std::map<size_t, NewPart>& parts) const override;
  std::vector<std::pair<std::string, std::string>> Facts() const override;

  CommentsKept comments_kept() const override {
    switch (static_cast<GcodeEncoding>(FirstGcode().parameters[0])) {
      case GcodeEncoding::kMeatPack:
        return CommentsKept::kNone;
      case GcodeEncoding::kMeatPackComments:
        return CommentsKept::kLines;
      default:
        return CommentsKept::kAll;
    }
  }

 private:
  absl::Status Fault(const absl::Status& status) const {
    return absl::Status(status.code(), absl::StrFormat("%s: %s", DisplayName(name_),
                                                       std::string(status.message())));
  }

  absl::StatusOr<std::string> Body() const {
    return GcodeText(file_, MaxTextBytes(bytes_.size(), options_.max_text_bytes),
                     gcode::ThreadsFor(bytes_.size()));
  }

  absl::Status ReadMetadata(const Block& block, size_t& left) {
    if (block.size > left) {
      return absl::ResourceExhaustedError(absl::StrFormat(
          "it states %d bytes, but only %d are left for metadata", block.size, left));
    }
    left -= block.size;
    absl::StatusOr<std::string> text = DecompressBlock(block);
    if (!text.ok()) return text.status();
    constexpr uint16_t kIni = 0;
    if (block.parameters[0] != kIni) return absl::OkStatus();  // kept, but not parsed
    Metadata& entries = EntriesOf(block.kind, metadata_);
    for (auto& entry : ParseMetadata(*text)) entries.push_back(std::move(entry));
    return absl::OkStatus();
  }

  // Thumbnails are normally not compressed; a compressed one is kept as it is.
  void ReadThumbnail(const Block& block) {
    if (block.compression != BlockCompression::kNone) return;
    metadata_.thumbnails.push_back(
        {block.parameters[0], block.parameters[1], block.parameters[2], std::string(block.data)});
  }

  const Block& FirstGcode() const {
    return *std::find_if(file_.blocks.begin(), file_.blocks.end(),
                         [](const Block& block) { return block.is_gcode(); });
  }

  // The G-code in `part`: its text without head and tail.
  absl::StatusOr<std::string> BodyOf(const NewPart& part) const;

  std::string bytes_;
  std::string name_;
  ContainerOptions options_;
  std::vector<GcodePart> parts_;
  BgcodeBlocks file_;
  BgcodeMetadata metadata_;
  std::string head_;
  std::string tail_;
};

absl::StatusOr<std::string> BgcodeContainer::BodyOf(const NewPart& part) const {
  std::string head = head_;
  std::string tail = tail_;
  if (part.times) {
    head = gcode::RestateTimes(head, *part.times);
    tail = gcode::RestateTimes(tail, *part.times);
  }
  // The line that Traverse adds after the head's comments may come before our own comments: then it
  // goes into the G-code.
  std::string body = part.text;
  const size_t mark = gcode::FindMark(body);
  std::string line;
  if (mark < head.size()) {
    const size_t end = body.find('\n', mark);
    line = body.substr(mark, end == std::string::npos ? end : end + 1 - mark);
    body.erase(mark, line.size());
  }
  if (body.size() < head.size() + tail.size() || !body.starts_with(head) || !body.ends_with(tail)) {
    return Fault(absl::FailedPreconditionError("the new G-code is not framed by its metadata"));
  }
  body.resize(body.size() - tail.size());
  return body.replace(0, head.size(), line);
}

absl::StatusOr<std::string> BgcodeContainer::WithParts(
    const std::map<size_t, NewPart>& parts) const {
  if (parts.empty()) return bytes_;
  const NewPart& part = parts.begin()->second;
  const absl::StatusOr<std::string> body = BodyOf(part);
  if (!body.ok()) return body.status();
  const Block& first = FirstGcode();
  const GcodeForm form = {first.compression, static_cast<GcodeEncoding>(first.parameters[0]),
                          file_.checksum};
  const int threads = gcode::ThreadsFor(body->size());
  std::string out = BgcodeHeader(file_.checksum);
  for (const Block& block : file_.blocks) {
    if (block.is_gcode()) {
      if (&block != &first) continue;
      const absl::Status status = AppendGcodeBlocks(*body, form, threads, out);
      if (!status.ok()) return Fault(status);
      continue;
    }
    std::string restated;
    if (part.times && HasMetadata(block.kind)) {
      absl::StatusOr<std::string> made = RestatedBlock(file_, block, *part.times);
      if (!made.ok()) return Fault(made.status());
      restated = *std::move(made);
    }
    out += restated.empty() ? block.whole : std::string_view(restated);
  }
  // Reads back what was written: this checks the codecs on every file.
  const absl::StatusOr<BgcodeBlocks> again = ParseBlocks(out);
  if (!again.ok()) return Fault(again.status());
  const absl::StatusOr<std::string> text = GcodeText(*again, options_.max_text_bytes, threads);
  if (!text.ok()) return Fault(text.status());
  if (!EqualToAPrinter(*text, *body)) {
    return Fault(absl::FailedPreconditionError("the new blocks do not hold the new G-code"));
  }
  return out;
}

std::vector<std::pair<std::string, std::string>> BgcodeContainer::Facts() const {
  std::vector<std::pair<std::string, std::string>> facts;
  facts.emplace_back(
      "container",
      absl::StrFormat("binary G-code, version %d, %s, %d blocks, %d bytes", kBgcodeVersion,
                      file_.checksum == BgcodeChecksum::kCrc32 ? "CRC32" : "no checksum",
                      file_.blocks.size(), bytes_.size()));
  for (size_t i = 0; i < file_.blocks.size();) {
    const Block& block = file_.blocks[i];
    size_t end = i + 1;
    size_t stored = block.data.size();
    size_t size = block.size;
    // Lists consecutive G-code blocks of one kind on one line.
    while (block.is_gcode() && end < file_.blocks.size() && file_.blocks[end].is_gcode() &&
           file_.blocks[end].compression == block.compression &&
           file_.blocks[end].parameters == block.parameters) {
      stored += file_.blocks[end].data.size();
      size += file_.blocks[end++].size;
    }
    std::string text = BlockName(block.kind);
    if (block.kind == BlockKind::kThumbnail) {
      absl::StrAppendFormat(&text, ", %s %dx%d", ThumbnailFormatName(block.parameters[0]),
                            block.parameters[1], block.parameters[2]);
    }
    if (block.is_gcode()) {
      constexpr const char* kEncodings[] = {"as text", "MeatPack", "MeatPack with comments"};
      absl::StrAppendFormat(&text, ", %s",
                            block.parameters[0] < 3 ? kEncodings[block.parameters[0]] : "unknown");
    }
    absl::StrAppendFormat(&text, ", %s, %d bytes", CompressionName(block.compression), stored);
    if (stored != size) absl::StrAppendFormat(&text, " for %d", size);
    facts.emplace_back(end == i + 1 ? absl::StrFormat("block %d", i + 1)
                                    : absl::StrFormat("blocks %d to %d", i + 1, end),
                       std::move(text));
    i = end;
  }
  for (const auto& [key, value] : metadata_.file) facts.emplace_back(key, value);
  for (const auto& [key, value] : metadata_.printer) facts.emplace_back(key, value);
  for (const auto& [key, value] : metadata_.print) {
    if (Find(metadata_.printer, key) != value) facts.emplace_back(key, value);
  }
  return facts;
}

absl::Status AppendMetadataBlock(BlockKind kind, BlockCompression compression,
                                 const Metadata& entries, std::string& out) {
  const std::string text = WriteMetadata(entries);
  if (text.size() >= UINT32_MAX) return absl::ResourceExhaustedError("4 GiB of metadata");
  const absl::StatusOr<std::string> data = CompressBytes(text, compression);
  if (!data.ok()) return data.status();
  AppendBlock(kind, compression, {0}, static_cast<uint32_t>(text.size()), *data,
              BgcodeChecksum::kCrc32, out);
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<std::unique_ptr<Container>> OpenBgcode(std::string bytes, const std::string& name,
                                                      const ContainerOptions& options) {
  auto container = std::make_unique<BgcodeContainer>(std::move(bytes), name, options);
  if (absl::Status status = container->Open(); !status.ok()) return status;
  return std::unique_ptr<Container>(std::move(container));
}

absl::StatusOr<std::string> MakeBgcode(const std::string& text) {
  const SplitText split = SplitMetadata(text);
  const BgcodeMetadata& metadata = split.metadata;
  std::string out = BgcodeHeader(BgcodeChecksum::kCrc32);
  absl::Status status;
  if (!metadata.file.empty()) {
    status =
        AppendMetadataBlock(BlockKind::kFileMetadata, BlockCompression::kNone, metadata.file, out);
  }
  if (status.ok()) {
    status = AppendMetadataBlock(BlockKind::kPrinterMetadata, BlockCompression::kNone,
                                 metadata.printer, out);
  }
  for (const Thumbnail& thumbnail : metadata.thumbnails) {
    AppendBlock(BlockKind::kThumbnail, BlockCompression::kNone,
                {thumbnail.format, thumbnail.width, thumbnail.height},
                static_cast<uint32_t>(thumbnail.data.size()), thumbnail.data,
                BgcodeChecksum::kCrc32, out);
  }
  if (status.ok()) {
    status = AppendMetadataBlock(BlockKind::kPrintMetadata, BlockCompression::kDeflate,
                                 metadata.print, out);
  }
  if (status.ok()) {
    status = AppendMetadataBlock(BlockKind::kSlicerMetadata, BlockCompression::kDeflate,
                                 metadata.slicer, out);
  }
  const int threads = gcode::ThreadsFor(split.body.size());
  if (status.ok()) status = AppendGcodeBlocks(split.body, GcodeForm(), threads, out);
  if (!status.ok()) return status;
  const absl::StatusOr<BgcodeBlocks> again = ParseBlocks(out);
  if (!again.ok()) return again.status();
  const absl::StatusOr<std::string> body = GcodeText(*again, std::string::npos, threads);
  if (!body.ok()) return body.status();
  if (!EqualToAPrinter(*body, split.body)) {
    return absl::InternalError("the blocks do not hold the G-code");
  }
  return out;
}

}  // namespace traverse::containers

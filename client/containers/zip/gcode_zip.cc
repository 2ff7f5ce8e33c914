#include "client/containers/zip/gcode_zip.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/escaping.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_format.h"
#include "client/containers/limits.h"
#include "client/containers/zip/archive.h"
#include "client/containers/zip/slice_info.h"
#include "client/files/md5.h"
#include "client/files/read_file.h"
#include "client/gcode/parallel.h"

namespace traverse::containers {
namespace {

constexpr std::string_view kPlateBegin = "Metadata/plate_";
constexpr std::string_view kGcodeEnd = ".gcode";
constexpr std::string_view kSliceInfo = "Metadata/slice_info.config";
constexpr std::string_view kUfpModel = "3D/model.gcode";

// Limit for the entries read besides G-code: digests and slice_info.
constexpr size_t kMaxSmallBytes = size_t{4} << 20;

// Plates of one archive: slicers write a few dozen at most.
constexpr size_t kMaxPlates = 1000;

std::string_view WithoutSlash(std::string_view name) {
  return name.starts_with('/') ? name.substr(1) : name;
}

// N of `Metadata/plate_N.gcode`, or 0.
uint32_t PlateOf(std::string_view name) {
  if (!name.starts_with(kPlateBegin) || !name.ends_with(kGcodeEnd)) return 0;
  name.remove_prefix(kPlateBegin.size());
  name.remove_suffix(std::min(name.size(), kGcodeEnd.size()));
  uint32_t plate = 0;
  const bool digits = !name.empty() && name[0] != '0' &&
                      name.find_first_not_of("0123456789") == std::string_view::npos;
  return digits && absl::SimpleAtoi(absl::string_view(name.data(), name.size()), &plate) ? plate
                                                                                         : 0;
}

class GcodeZip : public Container {
 public:
  GcodeZip(std::string bytes, std::string name, const ContainerOptions& options)
      : bytes_(std::move(bytes)), name_(std::move(name)), options_(options) {}

  // REQUIRES: called once, before all other functions.
  absl::Status Open() {
    absl::StatusOr<ZipArchive> archive = ParseZip(bytes_);
    if (!archive.ok()) return Fault(archive.status());
    archive_ = *std::move(archive);
    absl::Status status = FindParts();
    if (status.ok()) status = CheckNames();
    if (status.ok()) status = CheckSizes();
    if (status.ok()) status = ReadSliceInfo();
    return status.ok() ? status : Fault(status);
  }

  ContainerKind kind() const override { return kind_; }
  const std::vector<GcodePart>& parts() const override { return parts_; }

  absl::StatusOr<std::string> Text(size_t index) const override {
    const ZipEntry& entry = archive_.entries[entries_[index]];
    absl::StatusOr<std::string> text =
        ReadEntry(archive_, entry, MaxTextBytes(bytes_.size(), options_.max_text_bytes));
    if (!text.ok()) return Fault(text.status());
    const absl::Status status = CheckDigest(entry, *text);
    if (!status.ok()) return Fault(status);
    return text;
  }

  size_t StatedBytes() const override {
    size_t sum = 0;
    for (const size_t i : entries_) sum += archive_.entries[i].size;
    return sum;
  }

  absl::Status VisitTexts(const TextSink& sink) const override {
    for (size_t index = 0; index < entries_.size(); ++index) {
      const absl::Status status = VisitEntry(archive_, archive_.entries[entries_[index]],
                                             [&](std::string_view piece) { sink(index, piece); });
      if (!status.ok()) return Fault(status);
    }
    return absl::OkStatus();
  }

  absl::StatusOr<std::string> WithParts(const std::map<size_t, NewPart>& parts) const override;
  std::vector<std::pair<std::string, std::string>> Facts() const override;

 private:
  absl::Status Fault(const absl::Status& status) const {
    return absl::Status(status.code(), absl::StrFormat("%s: %s", DisplayName(name_),
                                                       std::string(status.message())));
  }

  absl::Status FindParts() {
    for (size_t i = 0; i < archive_.entries.size(); ++i) {
      const std::string_view name = archive_.entries[i].name;
      if (const uint32_t plate = PlateOf(name); plate > 0) {
        if (parts_.size() == kMaxPlates) {
          return absl::ResourceExhaustedError(
              absl::StrFormat("entry %s: more than %d plates", std::string(name), kMaxPlates));
        }
        parts_.push_back({std::string(name), plate});
        entries_.push_back(i);
      }
    }
    if (parts_.empty()) return FindUfpModel();
    // Archives list both in any order.
    std::vector<std::pair<GcodePart, size_t>> both;
    for (size_t i = 0; i < parts_.size(); ++i) both.emplace_back(parts_[i], entries_[i]);
    std::sort(both.begin(), both.end(),
              [](const auto& a, const auto& b) { return a.first.plate < b.first.plate; });
    for (size_t i = 0; i < both.size(); ++i) std::tie(parts_[i], entries_[i]) = both[i];
    return absl::OkStatus();
  }

  absl::Status FindUfpModel() {
    for (size_t i = 0; i < archive_.entries.size(); ++i) {
      const std::string_view name = archive_.entries[i].name;
      if (WithoutSlash(name) != kUfpModel) continue;
      if (!parts_.empty()) {
        return absl::InvalidArgumentError("entry 3D/model.gcode: there are two with that name");
      }
      kind_ = ContainerKind::kUfp;
      parts_.push_back({std::string(name), 1});
      entries_.push_back(i);
    }
    if (!parts_.empty()) return absl::OkStatus();
    return absl::InvalidArgumentError(
        "a zip archive without G-code: it has neither Metadata/plate_N.gcode nor 3D/model.gcode; "
        "was the project sliced before it was saved?");
  }

  // UltiMaker's packages begin their names with a slash, as the Open Packaging Conventions do.
  absl::Status CheckNames() const {
    const bool slashes = kind_ == ContainerKind::kUfp && parts_[0].name.starts_with('/');
    for (const ZipEntry& entry : archive_.entries) {
      if (slashes || !entry.name.starts_with('/')) continue;
      return absl::InvalidArgumentError(absl::StrFormat("entry %s: its name is absolute",
                                                        absl::CHexEscape(std::string(entry.name))));
    }
    return absl::OkStatus();
  }

  // All plates may be in memory at the same time.
  absl::Status CheckSizes() const {
    const size_t most = MaxTextBytes(bytes_.size(), options_.max_text_bytes);
    size_t sum = 0;
    for (const size_t i : entries_) {
      const ZipEntry& entry = archive_.entries[i];
      sum += entry.size;
      if (sum <= most) continue;
      return absl::ResourceExhaustedError(absl::StrFormat(
          "entry %s: it states %d MiB, which makes %d MiB of G-code, but only %d are allowed",
          std::string(entry.name), entry.size >> 20, sum >> 20, most >> 20));
    }
    return absl::OkStatus();
  }

  absl::Status ReadSliceInfo() {
    const ZipEntry* entry = archive_.Find(kSliceInfo);
    if (entry == nullptr || kind_ != ContainerKind::kGcode3mf) return absl::OkStatus();
    absl::StatusOr<std::string> text = ReadEntry(archive_, *entry, kMaxSmallBytes);
    if (!text.ok()) return text.status();
    slice_info_ = *std::move(text);
    return absl::OkStatus();
  }

  const ZipEntry* DigestEntry(const ZipEntry& entry) const {
    return archive_.Find(std::string(entry.name) + ".md5");
  }

  // OK if the digest next to `entry` matches `text`, is missing, or is not checked.
  absl::Status CheckDigest(const ZipEntry& entry, std::string_view text) const {
    const ZipEntry* digest = DigestEntry(entry);
    if (digest == nullptr || options_.ignore_md5) return absl::OkStatus();
    const absl::StatusOr<std::string> stated = ReadEntry(archive_, *digest, kMaxSmallBytes);
    if (!stated.ok()) return stated.status();
    const auto refuse = [&](const std::string& why) {
      return absl::InvalidArgumentError(
          absl::StrFormat("entry %s: %s; --ignore_md5 accepts the G-code anyway",
                          absl::CHexEscape(std::string(digest->name)), why));
    };
    const std::optional<std::string> found = FindMd5(*stated);
    if (!found) return refuse("it is not an MD5");
    const std::string is = Md5Hex(text);
    if (*found != is) {
      return refuse(absl::StrFormat("the MD5 of the G-code should be %s, but is %s", *found, is));
    }
    return absl::OkStatus();
  }

  size_t IndexOf(const ZipEntry& entry) const {
    return static_cast<size_t>(&entry - archive_.entries.data());
  }

  std::string bytes_;
  std::string name_;
  ContainerOptions options_;
  ContainerKind kind_ = ContainerKind::kGcode3mf;
  ZipArchive archive_;
  std::vector<GcodePart> parts_;
  std::vector<size_t> entries_;  // index in the archive, for each part
  std::string slice_info_;       // empty if there is none
};

absl::StatusOr<std::string> GcodeZip::WithParts(const std::map<size_t, NewPart>& parts) const {
  if (parts.empty()) return bytes_;
  std::map<size_t, std::string> replaced;
  std::string slice_info = slice_info_;
  for (const auto& [index, part] : parts) {
    const ZipEntry& entry = archive_.entries[entries_[index]];
    replaced[entries_[index]] = part.text;
    if (const ZipEntry* digest = DigestEntry(entry); digest != nullptr) {
      const absl::StatusOr<std::string> stated = ReadEntry(archive_, *digest, kMaxSmallBytes);
      if (!stated.ok()) return Fault(stated.status());
      const std::string is = Md5Hex(part.text);
      if (is.empty())
        return Fault(absl::UnavailableError("OpenSSL on this machine does not offer MD5"));
      replaced[IndexOf(*digest)] = FindMd5(*stated) ? WithMd5(*stated, is) : is;
    }
    if (part.times) slice_info = RestatePlate(slice_info, parts_[index].plate, *part.times);
  }
  if (slice_info != slice_info_) replaced[IndexOf(*archive_.Find(kSliceInfo))] = slice_info;
  absl::StatusOr<std::string> out = WriteZip(archive_, replaced, gcode::ThreadsFor(bytes_.size()));
  if (!out.ok()) return Fault(out.status());
  // Reads back what was written.
  const absl::StatusOr<ZipArchive> again = ParseZip(*out);
  if (!again.ok()) return Fault(again.status());
  for (const auto& [index, content] : replaced) {
    const auto read = ReadEntry(*again, again->entries[index], content.size());
    if (!read.ok()) return Fault(read.status());
    if (*read != content) {
      return Fault(absl::InternalError("the new archive does not hold the new G-code"));
    }
  }
  return out;
}

std::vector<std::pair<std::string, std::string>> GcodeZip::Facts() const {
  std::vector<std::pair<std::string, std::string>> facts;
  facts.emplace_back("container", absl::StrFormat("%s, %d entries, %d bytes", ContainerName(kind_),
                                                  archive_.entries.size(), bytes_.size()));
  for (size_t i = 0; i < parts_.size(); ++i) {
    const ZipEntry& entry = archive_.entries[entries_[i]];
    std::string text = absl::StrFormat("%s, %s, %d bytes for %d", parts_[i].name,
                                       entry.method == ZipMethod::kStored ? "stored" : "deflate",
                                       entry.compressed_size, entry.size);
    if (DigestEntry(entry) != nullptr) text += ", MD5 beside it";
    for (const char* key : {"prediction", "weight"}) {
      const std::string value = PlateValue(slice_info_, parts_[i].plate, key);
      if (!value.empty()) absl::StrAppendFormat(&text, ", %s %s", key, value);
    }
    facts.emplace_back(absl::StrFormat("plate %d", parts_[i].plate), std::move(text));
  }
  for (const ZipEntry& entry : archive_.entries) {
    if (!entry.name.ends_with(".png") && !entry.name.ends_with(".jpg")) continue;
    facts.emplace_back(
        "thumbnail",
        absl::StrFormat("%s, %d bytes", absl::CHexEscape(std::string(entry.name)), entry.size));
  }
  return facts;
}

}  // namespace

absl::StatusOr<std::unique_ptr<Container>> OpenGcodeZip(std::string bytes, const std::string& name,
                                                        const ContainerOptions& options) {
  auto container = std::make_unique<GcodeZip>(std::move(bytes), name, options);
  if (absl::Status status = container->Open(); !status.ok()) return status;
  return std::unique_ptr<Container>(std::move(container));
}

}  // namespace traverse::containers

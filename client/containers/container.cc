#include "client/containers/container.h"

#include <algorithm>

#include "absl/status/status.h"
#include "absl/strings/ascii.h"
#include "absl/strings/str_format.h"
#include "client/containers/bgcode/bgcode_container.h"
#include "client/containers/bgcode/block.h"
#include "client/containers/zip/gcode_zip.h"
#include "client/files/read_file.h"

namespace traverse {
namespace {

// G-code without a container.
class PlainText : public Container {
 public:
  explicit PlainText(std::string text) : text_(std::move(text)), parts_(1) {}

  ContainerKind kind() const override { return ContainerKind::kText; }
  const std::vector<GcodePart>& parts() const override { return parts_; }
  absl::StatusOr<std::string> Text(size_t) const override { return text_; }
  size_t StatedBytes() const override { return text_.size(); }
  absl::Status VisitTexts(const TextSink& sink) const override {
    sink(0, text_);
    return absl::OkStatus();
  }
  absl::StatusOr<std::string> WithParts(const std::map<size_t, NewPart>& parts) const override {
    return parts.empty() ? text_ : parts.begin()->second.text;
  }
  std::vector<std::pair<std::string, std::string>> Facts() const override { return {}; }

 private:
  std::string text_;
  std::vector<GcodePart> parts_;
};

}  // namespace

const char* ContainerName(ContainerKind kind) {
  switch (kind) {
    case ContainerKind::kText:
      return "G-code";
    case ContainerKind::kBgcode:
      return "binary G-code";
    case ContainerKind::kGcode3mf:
      return ".gcode.3mf";
    case ContainerKind::kUfp:
      return ".ufp";
  }
  return "unknown";
}

ContainerKind DetectContainer(std::string_view bytes) {
  using namespace std::string_view_literals;
  if (bytes.starts_with(containers::kBgcodeMagic)) return ContainerKind::kBgcode;
  // The first entry, or the end of an archive without entries.
  const bool zip = bytes.starts_with("PK\x03\x04"sv) || bytes.starts_with("PK\x05\x06"sv);
  return zip ? ContainerKind::kGcode3mf : ContainerKind::kText;
}

std::optional<ContainerKind> ContainerByExtension(std::string_view name) {
  std::string lower(name);
  absl::AsciiStrToLower(&lower);
  for (const char* end : {".gcode", ".gco", ".g", ".nc"}) {
    if (lower.ends_with(end)) return ContainerKind::kText;
  }
  if (lower.ends_with(".bgcode") || lower.ends_with(".bgc")) return ContainerKind::kBgcode;
  if (lower.ends_with(".3mf")) return ContainerKind::kGcode3mf;
  if (lower.ends_with(".ufp")) return ContainerKind::kUfp;
  return std::nullopt;
}

absl::StatusOr<std::unique_ptr<Container>> OpenContainer(std::string bytes, const std::string& name,
                                                         const ContainerOptions& options) {
  switch (DetectContainer(bytes)) {
    case ContainerKind::kBgcode:
      return containers::OpenBgcode(std::move(bytes), name, options);
    case ContainerKind::kGcode3mf:
    case ContainerKind::kUfp:
      return containers::OpenGcodeZip(std::move(bytes), name, options);
    case ContainerKind::kText:
      break;
  }
  return std::unique_ptr<Container>(std::make_unique<PlainText>(std::move(bytes)));
}

absl::StatusOr<std::string> PackText(const std::string& text, ContainerKind kind) {
  switch (kind) {
    case ContainerKind::kText:
      return text;
    case ContainerKind::kBgcode:
      return containers::MakeBgcode(text);
    default:
      return absl::InvalidArgumentError(
          absl::StrFormat("cannot make a %s from G-code alone", ContainerName(kind)));
  }
}

absl::StatusOr<size_t> FindPlate(const Container& container, uint32_t plate,
                                 const std::string& name) {
  std::string known;
  for (size_t i = 0; i < container.parts().size(); ++i) {
    const GcodePart& part = container.parts()[i];
    if (part.plate == plate) return i;
    absl::StrAppendFormat(&known, "%s%d", known.empty() ? "" : ", ", part.plate);
  }
  return absl::InvalidArgumentError(
      absl::StrFormat("%s: it has no plate %d, only %s", DisplayName(name), plate, known));
}

}  // namespace traverse

#include "client/formats/detect.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "client/containers/container.h"
#include "client/files/utf8_mark.h"

namespace traverse {
namespace {

constexpr size_t kBytesAsked = size_t{1} << 16;
constexpr int kLinesAsked = 1000;

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

// `F1,` `I2,` `C3,` `R4,` `M,` `nF,`
bool LooksLikeDamat(std::string_view line) {
  if (line.starts_with("M,") || line.starts_with("nF,")) return true;
  const std::string_view records = "FICR";
  if (line.size() < 3 || records.find(line[0]) == std::string_view::npos) return false;
  const size_t end = std::min(line.find_first_not_of("0123456789", 1), line.size());
  return end > 1 && end < line.size() && line[end] == ',';
}

// A comment, a command word such as G1, M104, T0 or N12, or a macro such as START_PRINT.
bool LooksLikeGcode(std::string_view line) {
  if (line[0] == ';') return true;
  const std::string_view words = "GMTN";
  if (words.find(line[0]) != std::string_view::npos && line.size() > 1 && IsDigit(line[1])) {
    const size_t end = std::min(line.find_first_not_of("0123456789.", 1), line.size());
    return end == line.size() || line[end] != ',';
  }
  const size_t word = line.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ_");
  return word != 0 && std::min(word, line.size()) > 2 &&
         line.substr(0, word).find('_') != std::string_view::npos;
}

// A line of GTSPLIB's, or TSPLIB's, head.
bool LooksLikeGtsp(std::string_view line) {
  for (const std::string_view key :
       {"DIMENSION", "EDGE_WEIGHT_TYPE", "GTSP_SETS", "NODE_COORD_SECTION", "GTSP_SET_SECTION"}) {
    if (!line.starts_with(key)) continue;
    const size_t next = line.find_first_not_of(" \t\r", key.size());
    return next == std::string_view::npos || line[next] == ':';
  }
  return false;
}

// True if `bytes` contain a control character that no text has.
bool IsBinary(std::string_view bytes) {
  return std::any_of(bytes.begin(), bytes.end(), [](char c) {
    return (c >= '\0' && c < '\t') || (c > '\r' && c < ' ' && c != '\x1b') || c == '\x7f';
  });
}

std::optional<InputFormat> DetectText(std::string_view text) {
  int damat = 0;
  int gcode = 0;
  int gtsp = 0;
  for (int lines = 0; !text.empty() && lines < kLinesAsked; ++lines) {
    const size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    line.remove_prefix(std::min(line.find_first_not_of(" \t\r"), line.size()));
    if (line.empty()) continue;
    if (lines == 0 && line[0] == '{') return InputFormat::kJson;
    damat += LooksLikeDamat(line);
    gcode += LooksLikeGcode(line);
    gtsp += LooksLikeGtsp(line);
  }
  // GTSPLIB's keys look like macros, but no file of macros has two of them.
  if (gtsp > 1) return InputFormat::kGtsp;
  if (damat == 0 && gcode == 0) return std::nullopt;
  return damat >= gcode ? InputFormat::kDamat : InputFormat::kGcode;
}

}  // namespace

std::optional<InputFormat> DetectByContent(std::string_view bytes) {
  if (DetectContainer(bytes) != ContainerKind::kText) return InputFormat::kGcode;
  bytes = WithoutUtf8Mark(bytes);
  const std::string_view head = bytes.substr(0, kBytesAsked);
  if (IsBinary(head)) {
    // Tags of OptimizeBatchRequest.options and .layers.
    constexpr char kOptionsTag = 0x0a;
    constexpr char kLayersTag = 0x12;
    const bool ours = head[0] == kOptionsTag || head[0] == kLayersTag;
    return ours ? std::optional(InputFormat::kProto) : std::nullopt;
  }
  const size_t first = head.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return std::nullopt;
  return DetectText(head.substr(first));
}

std::optional<InputFormat> DetectByExtension(const std::string& name) {
  std::string lower = name;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  std::filesystem::path path = lower;
  if (path.extension() == ".gz" || path.extension() == ".xz") path = path.stem();
  const std::string extension = path.extension().string();
  if (extension == ".damat" || extension == ".txt") return InputFormat::kDamat;
  if (ContainerByExtension(path.string())) return InputFormat::kGcode;
  if (extension == ".json") return InputFormat::kJson;
  if (extension == ".pb") return InputFormat::kProto;
  if (extension == ".gtsp") return InputFormat::kGtsp;
  return std::nullopt;
}

const char* FormatName(InputFormat format) {
  switch (format) {
    case InputFormat::kDamat:
      return "DAMAT";
    case InputFormat::kGcode:
      return "G-code";
    case InputFormat::kJson:
      return "JSON";
    case InputFormat::kProto:
      return "protobuf";
    case InputFormat::kGtsp:
      return "GTSPLIB";
  }
  return "unknown";
}

}  // namespace traverse

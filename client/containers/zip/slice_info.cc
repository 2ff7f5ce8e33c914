#include "client/containers/zip/slice_info.h"

#include <algorithm>
#include <optional>

#include "absl/strings/str_format.h"

namespace traverse::containers {
namespace {

constexpr std::string_view kPlate = "<plate";
constexpr std::string_view kPlateEnd = "</plate>";

// The value of attribute `name` of the tag `tag`, with its escapes.
std::optional<std::string_view> Attribute(std::string_view tag, std::string_view name) {
  const std::string begin = absl::StrFormat(" %s=", std::string(name));
  size_t at = tag.find(begin);
  if (at == std::string_view::npos) return std::nullopt;
  at += begin.size();
  if (at >= tag.size() || (tag[at] != '"' && tag[at] != '\'')) return std::nullopt;
  const size_t end = tag.find(tag[at], at + 1);
  if (end == std::string_view::npos) return std::nullopt;
  return tag.substr(at + 1, end - at - 1);
}

// The value of the metadata `key` in `text`, which covers one plate.
std::optional<std::string_view> Value(std::string_view text, std::string_view key) {
  constexpr std::string_view kMetadata = "<metadata";
  for (size_t at = text.find(kMetadata); at != std::string_view::npos;) {
    const size_t end = text.find('>', at);
    if (end == std::string_view::npos) break;
    const std::string_view tag = text.substr(at, end - at);
    if (Attribute(tag, "key") == key) return Attribute(tag, "value");
    at = text.find(kMetadata, end);
  }
  return std::nullopt;
}

// The part of `text` that describes plate `plate`; empty if there is none.
std::string_view PlatePart(std::string_view text, uint32_t plate) {
  const std::string index = absl::StrFormat("%d", plate);
  for (size_t at = text.find(kPlate); at != std::string_view::npos;) {
    const size_t end = std::min(text.find(kPlateEnd, at), text.size());
    const std::string_view part = text.substr(at, end - at);
    if (Value(part, "index") == index) return part;
    at = text.find(kPlate, end + 1);
  }
  return {};
}

}  // namespace

std::string PlateValue(std::string_view slice_info, uint32_t plate, std::string_view key) {
  return std::string(Value(PlatePart(slice_info, plate), key).value_or(""));
}

std::string RestatePlate(std::string slice_info, uint32_t plate, const gcode::TimeScale& scale) {
  const auto restate = [&](std::string_view key, double factor) {
    const auto value = Value(PlatePart(slice_info, plate), key);
    const auto scaled = value ? gcode::ScaleDuration(*value, factor) : std::nullopt;
    if (!scaled) return;
    slice_info.replace(static_cast<size_t>(value->data() - slice_info.data()), value->size(),
                       *scaled);
  };
  restate("prediction", scale.total);
  restate("first_layer_time", scale.first_layer);
  return slice_info;
}

}  // namespace traverse::containers

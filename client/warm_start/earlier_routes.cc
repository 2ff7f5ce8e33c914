#include "client/warm_start/earlier_routes.h"

#include <cstddef>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_format.h"
#include "client/files/read_file.h"

namespace traverse {
namespace {

using Json = nlohmann::json;

constexpr uint64_t kAnyLabel = std::numeric_limits<uint64_t>::max();

// Reads the fields of one object, and notes the first that is not what `optimize` writes.
class Fields {
 public:
  explicit Fields(const Json& object) : object_(object) {}

  bool Has(const char* name) const { return object_.is_object() && object_.contains(name); }

  uint64_t Number(const char* name, uint64_t most) {
    const Json& value = Of(name);
    if (value.is_number_unsigned() && value.get<uint64_t>() <= most) return value.get<uint64_t>();
    Note(absl::StrFormat("\"%s\" is not a whole number up to %d", name, most));
    return 0;
  }

  bool Bool(const char* name) {
    const Json& value = Of(name);
    if (value.is_boolean()) return value.get<bool>();
    Note(absl::StrFormat("\"%s\" is neither true nor false", name));
    return false;
  }

  // Unset if there is no such field.
  std::optional<PlacedPoint> Place(const char* name) {
    if (!Has(name)) return std::nullopt;
    const Json& value = Of(name);
    const bool is_point =
        value.is_array() && value.size() == 2 && value[0].is_number() && value[1].is_number();
    if (is_point) return PlacedPoint{value[0].get<double>(), value[1].get<double>()};
    Note(absl::StrFormat("\"%s\" is not [x, y]", name));
    return std::nullopt;
  }

  const Json& List(const char* name) {
    static const Json& empty = *new Json(Json::array());
    const Json& value = Of(name);
    if (value.is_array()) return value;
    Note(absl::StrFormat("\"%s\" is not a list", name));
    return empty;
  }

  // Null if there is no such field.
  const Json& Of(const char* name) {
    static const Json& null = *new Json();
    if (Has(name)) return object_[name];
    Note(absl::StrFormat("no \"%s\"", name));
    return null;
  }

  void Note(const std::string& fault) {
    if (fault_.empty()) fault_ = fault;
  }

  const std::string& fault() const { return fault_; }  // empty: none

 private:
  const Json& object_;
  std::string fault_;
};

EarlierVisit VisitOf(Fields& fields) {
  EarlierVisit visit;
  const Json& kind = fields.Of("kind");
  if (kind != "contour" && kind != "raster") fields.Note("\"kind\" is neither contour nor raster");
  visit.contour = kind == "contour";
  visit.id = fields.Number("id", kAnyLabel);
  if (fields.Has("island")) visit.island = fields.Number("island", kAnyLabel);
  if (visit.contour) {
    visit.entry =
        static_cast<uint32_t>(fields.Number("entry", std::numeric_limits<uint32_t>::max()));
    visit.from = visit.to = fields.Place("at");
  } else {
    visit.entry = fields.Bool("reversed") ? 1 : 0;
    visit.from = fields.Place("from");
    visit.to = fields.Place("to");
  }
  return visit;
}

// Takes the layers out of a document while it is read: as one tree of values it would need many
// times its text's memory.
class LayerTaker {
 public:
  bool operator()(int depth, Json::parse_event_t event, Json& value) {
    using Event = Json::parse_event_t;
    if (depth == 1 && event == Event::key) in_layers_ = value == "layers";
    const bool is_whole =
        event == Event::object_end || event == Event::array_end || event == Event::value;
    if (!in_layers_ || depth != 2 || !is_whole) return true;
    if (fault_.empty()) TakeLayer(value);
    return false;
  }

  std::vector<EarlierLayer>& layers() { return layers_; }
  const std::string& fault() const { return fault_; }  // empty: none

 private:
  void TakeLayer(const Json& value) {
    Fields fields(value);
    EarlierLayer layer;
    layer.id = fields.Number("id", kAnyLabel);
    const Json& route = fields.List("route");
    NoteFault(fields, "");
    layer.route.reserve(route.size());
    for (size_t i = 0; i < route.size() && fault_.empty(); ++i) {
      Fields visit(route[i]);
      layer.route.push_back(VisitOf(visit));
      NoteFault(visit, absl::StrFormat(".route[%d]", i));
    }
    layers_.push_back(std::move(layer));
  }

  void NoteFault(const Fields& fields, const std::string& place) {
    if (fields.fault().empty() || !fault_.empty()) return;
    fault_ = absl::StrFormat("layers[%d]%s: %s", layers_.size(), place, fields.fault());
  }

  bool in_layers_ = false;
  std::vector<EarlierLayer> layers_;
  std::string fault_;
};

}  // namespace

absl::StatusOr<std::vector<EarlierLayer>> ReadEarlierRoutes(const std::string& text,
                                                            const std::string& name) {
  LayerTaker taker;
  const Json document = Json::parse(text, std::ref(taker), /*allow_exceptions=*/false);
  std::string fault = taker.fault();
  if (document.is_discarded()) {
    fault = "it is not JSON, or is cut short";
  } else if (fault.empty()) {
    Fields fields(document);
    for (const char* field : {"input", "strategy", "total"}) fields.Of(field);
    fields.List("layers");
    fault = fields.fault();
  }
  if (fault.empty()) return std::move(taker.layers());
  return absl::InvalidArgumentError(absl::StrFormat(
      "%s: not what `traverse optimize --json` writes: %s", DisplayName(name), fault));
}

}  // namespace traverse

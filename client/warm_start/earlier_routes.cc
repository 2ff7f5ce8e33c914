#include "client/warm_start/earlier_routes.h"

#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_format.h"
#include "client/files/json.h"
#include "client/files/read_file.h"

namespace traverse {
namespace {

constexpr uint64_t kAnyLabel = std::numeric_limits<uint64_t>::max();

// Reads the fields of one object, and notes the first that is not what `optimize` writes.
class Fields {
 public:
  explicit Fields(const Json& object) : object_(object) {}

  bool Has(const char* name) const { return object_.Find(name) != nullptr; }

  uint64_t Number(const char* name, uint64_t most) {
    const uint64_t* const number = Of(name).Unsigned();
    if (number != nullptr && *number <= most) return *number;
    Note(absl::StrFormat("\"%s\" is not a whole number up to %d", name, most));
    return 0;
  }

  bool Bool(const char* name) {
    if (const bool* const value = Of(name).Bool()) return *value;
    Note(absl::StrFormat("\"%s\" is neither true nor false", name));
    return false;
  }

  // Unset if there is no such field.
  std::optional<PlacedPoint> Place(const char* name) {
    const Json* const value = object_.Find(name);
    if (value == nullptr) return std::nullopt;
    if (value->is_array() && value->items().size() == 2) {
      const std::optional<double> x = value->items()[0].Number();
      const std::optional<double> y = value->items()[1].Number();
      if (x && y) return PlacedPoint{*x, *y};
    }
    Note(absl::StrFormat("\"%s\" is not [x, y]", name));
    return std::nullopt;
  }

  const JsonArray& List(const char* name) {
    static const JsonArray& empty = *new JsonArray();
    const Json& value = Of(name);
    if (value.is_array()) return value.items();
    Note(absl::StrFormat("\"%s\" is not a list", name));
    return empty;
  }

  // Null if there is no such field.
  const Json& Of(const char* name) {
    static const Json& null = *new Json();
    if (const Json* const value = object_.Find(name)) return *value;
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
  const std::string* const kind = fields.Of("kind").Text();
  visit.contour = kind != nullptr && *kind == "contour";
  if (!visit.contour && (kind == nullptr || *kind != "raster")) {
    fields.Note("\"kind\" is neither contour nor raster");
  }
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

// Takes the layers of a document while it is read.
class LayerTaker {
 public:
  void Take(const Json& value) {
    if (!fault_.empty()) return;
    Fields fields(value);
    EarlierLayer layer;
    layer.id = fields.Number("id", kAnyLabel);
    const JsonArray& route = fields.List("route");
    NoteFault(fields, "");
    layer.route.reserve(route.size());
    for (size_t i = 0; i < route.size() && fault_.empty(); ++i) {
      Fields visit(route[i]);
      layer.route.push_back(VisitOf(visit));
      NoteFault(visit, absl::StrFormat(".route[%d]", i));
    }
    layers_.push_back(std::move(layer));
  }

  std::vector<EarlierLayer>& layers() { return layers_; }
  const std::string& fault() const { return fault_; }  // empty: none

 private:
  void NoteFault(const Fields& fields, const std::string& place) {
    if (fields.fault().empty() || !fault_.empty()) return;
    fault_ = absl::StrFormat("layers[%d]%s: %s", layers_.size(), place, fields.fault());
  }

  std::vector<EarlierLayer> layers_;
  std::string fault_;
};

}  // namespace

absl::StatusOr<std::vector<EarlierLayer>> ReadEarlierRoutes(const std::string& text,
                                                            const std::string& name) {
  LayerTaker taker;
  const std::optional<Json> document =
      ParseJson(text, "layers", [&](const Json& layer) { taker.Take(layer); });
  std::string fault = taker.fault();
  if (!document) {
    fault = "it is not JSON, or is cut short";
  } else if (fault.empty()) {
    Fields fields(*document);
    for (const char* field : {"input", "strategy", "total"}) fields.Of(field);
    fields.List("layers");
    fault = fields.fault();
  }
  if (fault.empty()) return std::move(taker.layers());
  return absl::InvalidArgumentError(absl::StrFormat(
      "%s: not what `traverse optimize --json` writes: %s", DisplayName(name), fault));
}

}  // namespace traverse

#include "server/translate/translate_links.h"

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "engine/base/rest.h"
#include "engine/model/links.h"
#include "engine/model/path.h"
#include "server/translate/fault_list.h"
#include "server/translate/field_ranges.h"
#include "server/translate/translate_check.h"

namespace traverse {
namespace {

bool IsIn(const FieldRange& range, double value) {  // NaN is in no range
  return value >= range.least && value <= range.greatest;
}

// Of a Departure or an Arrival; `open` and `retracted`: the ranges of its fields.
template <typename Message>
absl::StatusOr<LinkSeconds> SecondsOf(const Message& message, const FieldRange& open,
                                      const FieldRange& retracted, const FieldPath& place) {
  TRAVERSE_RETURN_IF_ERROR(CheckKnownAt(message, place));
  LinkSeconds seconds{message.open_seconds(), message.open_seconds()};
  if (message.has_retracted_seconds()) seconds.retracted = message.retracted_seconds();
  if (!IsIn(open, seconds.open)) {
    return CheckRange(open, seconds.open, place.text() + ".open_seconds");
  }
  const bool is_less = seconds.retracted < seconds.open;
  if (!is_less && IsIn(retracted, seconds.retracted)) return seconds;
  const std::string field = place.text() + ".retracted_seconds";
  TRAVERSE_RETURN_IF_ERROR(CheckRange(retracted, seconds.retracted, field));
  return Fault(field,
               absl::StrCat(seconds.retracted, " is less than open_seconds, ", seconds.open));
}

absl::StatusOr<Departure> FromProto(const v1::Departure& message, const FieldPath& place) {
  static const FieldRange& open = RangeOf("Departure.open_seconds");
  static const FieldRange& retracted = RangeOf("Departure.retracted_seconds");
  absl::StatusOr<LinkSeconds> seconds = SecondsOf(message, open, retracted, place);
  if (!seconds.ok()) return seconds.status();
  Departure departure{{}, *seconds};
  if (!message.has_from()) return departure;
  absl::StatusOr<Point> from = PointFromProto(message.from(), place.text() + ".from");
  if (!from.ok()) return from.status();
  departure.from = *from;
  return departure;
}

absl::StatusOr<LinkSeconds> FromProto(const v1::Arrival& message, const FieldPath& place) {
  static const FieldRange& open = RangeOf("Arrival.open_seconds");
  static const FieldRange& retracted = RangeOf("Arrival.retracted_seconds");
  return SecondsOf(message, open, retracted, place);
}

// Appends the elements of one list of a path's links.
template <typename Messages, typename Element>
absl::Status Append(const Messages& messages, const char* field, const Path& path,
                    const FieldPath& place, Rest& rest, std::vector<Element>& elements) {
  const int count = messages.size();
  if (count > 1 && static_cast<size_t>(count) != path.points.size()) {
    const char* ends = path.kind == Path::Kind::kOpen ? " ends" : " vertices";
    return Fault(absl::StrCat(place.text(), ".", field),
                 absl::StrCat(count, " for a path of ", path.points.size(), ends));
  }
  elements.reserve(static_cast<size_t>(count));
  for (int i = 0; i < count; ++i) {
    rest(kStepsOfMessage);
    absl::StatusOr<Element> element =
        FromProto(messages[i], FieldPath(&place, field, static_cast<uint64_t>(i)));
    if (!element.ok()) return element.status();
    elements.push_back(*element);
  }
  return absl::OkStatus();
}

absl::StatusOr<PathLinks> FromProto(const v1::PathLinks& message, const Path& path,
                                    const FieldPath& place, Rest& rest) {
  TRAVERSE_RETURN_IF_ERROR(CheckKnown(message, place.text() + ".links"));
  PathLinks links;
  TRAVERSE_RETURN_IF_ERROR(
      Append(message.departures(), "links.departures", path, place, rest, links.departures));
  TRAVERSE_RETURN_IF_ERROR(
      Append(message.arrivals(), "links.arrivals", path, place, rest, links.arrivals));
  if (links.departures.size() == 1 && links.departures[0].from && ExitCount(path) > 1) {
    return Fault(place.text() + ".links.departures[0].from",
                 "one place for all exits of a path that may be left at several");
  }
  return links;
}

// Goes through the paths of a layer in the order of Plan::paths.
class Reader {
 public:
  Reader(JobLayer& layer, Budget* budget) : layer_(layer), rest_(budget) {}

  // `message`: the next path, a v1::Contour or v1::OpenPath.
  template <typename Message>
  void Read(const Message& message, const FieldPath& place) {
    const size_t path = next_++;
    rest_(8);
    if (!message.has_links() || faults_.full()) return;
    assert(path < layer_.plan.paths.size());
    absl::StatusOr<PathLinks> links =
        FromProto(message.links(), layer_.plan.paths[path], place, rest_);
    faults_.Add(links.status());
    if (!links.ok()) return;
    layer_.links.resize(layer_.plan.paths.size());
    layer_.links[path] = *std::move(links);
  }

  template <typename Messages>
  void ReadAll(const Messages& messages, const char* field, const FieldPath& parent) {
    for (int i = 0; i < messages.size(); ++i) {
      Read(messages[i], FieldPath(&parent, field, static_cast<uint64_t>(i)));
    }
  }

  absl::Status status() const { return faults_.status(); }

 private:
  JobLayer& layer_;
  Rest rest_;
  FaultList faults_;
  size_t next_ = 0;
};

}  // namespace

absl::Status SetLinks(const v1::Layer& message, const FieldPath& place, Budget* budget,
                      JobLayer& layer) {
  Reader reader(layer, budget);
  for (int i = 0; i < message.islands_size(); ++i) {
    const FieldPath island(&place, "islands", static_cast<uint64_t>(i));
    reader.ReadAll(message.islands(i).contours(), "contours", island);
    reader.ReadAll(message.islands(i).rasters(), "rasters", island);
  }
  const std::string field = message.plan().paths().empty() ? "" : place.text() + ".plan.paths";
  for (int p = 0; p < message.plan().paths_size(); ++p) {
    const FieldPath at(nullptr, field.c_str(), static_cast<uint64_t>(p));
    const v1::PlanPath& path = message.plan().paths(p);
    if (path.has_contour()) {
      reader.Read(path.contour(), at);
    } else {
      reader.Read(path.open_path(), at);
    }
  }
  if (absl::Status status = reader.status(); !status.ok()) return status;
  assert(LinksFit(layer.links, layer.plan));
  return absl::OkStatus();
}

}  // namespace traverse

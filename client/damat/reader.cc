#include "client/damat/reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <system_error>
#include <vector>

#include "absl/container/flat_hash_set.h"
#include "absl/status/status.h"
#include "absl/strings/str_format.h"
#include "client/damat/fields.h"
#include "client/damat/format.h"
#include "client/damat/outer_contour.h"
#include "client/files/read_file.h"
#include "client/files/utf8_mark.h"

namespace traverse {
namespace {

using damat::Fields;
using Points = google::protobuf::RepeatedField<double>;

// A record that announces how many others follow: nF, F or I.
struct Announcement {
  int line = 0;
  uint64_t announced = 0;
  uint64_t found = 0;
};

class Reader {
 public:
  explicit Reader(const std::string& name) { job_.name = name; }

  absl::StatusOr<InputJob> Read(std::string_view text);

 private:
  absl::Status ReadRecord(std::string_view record);
  absl::Status ReadEnvelope(Fields fields);
  absl::Status ReadThickness(Fields fields);
  absl::Status TakeThickness(std::string_view field);
  absl::Status ReadLayerCount(Fields fields);
  absl::Status BeginLayer(uint64_t id, Fields fields);
  absl::Status BeginIsland(uint64_t id, Fields fields);
  absl::Status ReadContour(uint64_t id, Fields fields);
  absl::Status ReadRaster(uint64_t id, Fields fields);

  // The contour that the last record was part of is complete.
  void EndContour();
  absl::Status NoteSpelling(bool goes_on, bool is_long);
  absl::Status PlaceOuterContour();

  // Reads the fields `X<x>,Y<y>` of one point after another to the end of the record, packed.
  absl::Status ReadPoints(Fields& fields, google::protobuf::RepeatedField<double>& points) const;

  // Closes the open island and checks its counts.
  absl::Status EndIsland();
  absl::Status EndLayer();
  absl::Status EndFile();

  // An error on the current line, or on `line`.
  absl::Status Fault(const std::string& what) const { return FaultAt(line_, what); }
  absl::Status FaultAt(int line, const std::string& what) const {
    return absl::InvalidArgumentError(
        absl::StrFormat("%s:%d: %s", DisplayName(job_.name), line, what));
  }
  absl::Status CheckCount(const Announcement& a, const std::string& who, const char* what) const;

  InputJob job_;
  int line_ = 0;
  std::optional<Announcement> layers_;
  v1::Layer* layer_ = nullptr;
  Announcement islands_;
  v1::Island* island_ = nullptr;
  Announcement contours_;
  Announcement rasters_;
  std::optional<double> thickness_mm_;

  // The contour of the last record, if that was one, and the first line of each contour of the
  // island; the first line where a contour continues, and the first with several vertices.
  v1::Contour* contour_ = nullptr;
  std::vector<int> contour_lines_;
  bool goes_on_ = false;
  int first_going_on_ = 0;
  int first_long_ = 0;
  absl::flat_hash_set<uint64_t> layer_ids_, island_ids_, contour_ids_, raster_ids_;
};

absl::StatusOr<InputJob> Reader::Read(std::string_view text) {
  job_.format = InputFormat::kDamat;
  text = WithoutUtf8Mark(text);
  while (!text.empty()) {
    ++line_;
    const size_t end = text.find('\n');
    std::string_view record = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (const size_t at = record.find(damat::kComment); at != std::string_view::npos) {
      record = record.substr(0, at);
    }
    record = damat::Trimmed(record);
    if (record.empty()) continue;
    if (absl::Status status = ReadRecord(record); !status.ok()) return status;
  }
  if (absl::Status status = EndFile(); !status.ok()) return status;
  return std::move(job_);
}

absl::Status Reader::ReadRecord(std::string_view record) {
  Fields fields(record);
  const std::string_view word = fields.Next();
  if (word == damat::kEnvelope) return ReadEnvelope(fields);
  if (word == damat::kThickness) return ReadThickness(fields);
  if (word == damat::kLayerCount) return ReadLayerCount(fields);

  const char kind = word.empty() ? '\0' : word.front();
  const std::optional<uint64_t> id = damat::ParseCount(word.substr(word.empty() ? 0 : 1));
  if (!id) return Fault(absl::StrFormat("not a DAMAT record: %s", damat::Quoted(record)));
  switch (kind) {
    case damat::kLayer:
      return BeginLayer(*id, fields);
    case damat::kIsland:
      return BeginIsland(*id, fields);
    case damat::kContour:
      return ReadContour(*id, fields);
    case damat::kRaster:
      return ReadRaster(*id, fields);
    default:
      return Fault(absl::StrFormat("not a DAMAT record: %s", damat::Quoted(record)));
  }
}

absl::Status Reader::ReadEnvelope(Fields fields) {
  if (layers_) return Fault("M comes after nF");
  if (job_.envelope) return Fault("second M");
  const std::optional<double> x = damat::ParseCoordinate(fields.Next());
  const std::optional<double> y = damat::ParseCoordinate(fields.Next());
  if (!x || !y || !fields.done()) return Fault("M needs two coordinates within +-1e6 mm");
  job_.envelope.emplace();
  job_.envelope->set_x_mm(*x);
  job_.envelope->set_y_mm(*y);
  return absl::OkStatus();
}

absl::Status Reader::ReadThickness(Fields fields) {
  if (layers_) return Fault("E comes after nF");
  if (absl::Status status = TakeThickness(fields.Next()); !status.ok()) return status;
  return fields.done() ? absl::OkStatus() : Fault("E has one number, the thickness of a layer");
}

absl::Status Reader::TakeThickness(std::string_view field) {
  if (thickness_mm_) return Fault("second thickness of a layer");
  thickness_mm_ = damat::ParseCoordinate(field);
  if (thickness_mm_ && *thickness_mm_ > 0) return absl::OkStatus();
  return Fault(absl::StrFormat("%s is not a layer thickness in mm, above 0 and up to 1e6",
                               damat::Quoted(field)));
}

absl::Status Reader::ReadLayerCount(Fields fields) {
  if (layers_) return Fault("second nF");
  const std::optional<uint64_t> count = damat::ParseCount(fields.Next());
  if (!count) return Fault("nF needs the number of layers");
  if (!fields.done()) {
    if (absl::Status status = TakeThickness(fields.Next()); !status.ok()) return status;
  }
  if (!fields.done()) return Fault("nF has two numbers at most: layers, and their thickness");
  layers_ = Announcement{line_, *count, 0};
  return absl::OkStatus();
}

absl::Status Reader::BeginLayer(uint64_t id, Fields fields) {
  if (absl::Status status = EndLayer(); !status.ok()) return status;
  if (!layers_) return Fault("a layer before nF, the number of layers");
  const std::optional<uint64_t> count = damat::ParseCount(fields.Next());
  if (!count || !fields.done()) return Fault("F needs an id and the number of islands");
  if (!layer_ids_.insert(id).second) {
    return Fault(absl::StrFormat("second layer with id %d", id));
  }
  ++layers_->found;
  layer_ = &job_.layers.emplace_back();
  layer_->set_id(id);
  if (thickness_mm_) layer_->set_z_mm(*thickness_mm_ * static_cast<double>(layers_->found));
  islands_ = {line_, *count, 0};
  island_ids_.clear();
  return absl::OkStatus();
}

absl::Status Reader::BeginIsland(uint64_t id, Fields fields) {
  if (absl::Status status = EndIsland(); !status.ok()) return status;
  if (layer_ == nullptr) return Fault("an island before the first layer");
  const std::optional<uint64_t> contours = damat::ParseCount(fields.Next());
  const std::optional<uint64_t> rasters = damat::ParseCount(fields.Next());
  if (!contours || !rasters || !fields.done()) {
    return Fault("I needs an id, the number of contours and the number of rasters");
  }
  if (!island_ids_.insert(id).second) {
    return Fault(absl::StrFormat("second island with id %d in layer %d", id, layer_->id()));
  }
  ++islands_.found;
  island_ = layer_->add_islands();
  island_->set_id(id);
  contours_ = {line_, *contours, 0};
  rasters_ = {line_, *rasters, 0};
  contour_ids_.clear();
  raster_ids_.clear();
  contour_lines_.clear();
  return absl::OkStatus();
}

absl::Status Reader::ReadContour(uint64_t id, Fields fields) {
  if (island_ == nullptr) return Fault("a contour outside an island");
  Points points;
  if (absl::Status status = ReadPoints(fields, points); !status.ok()) return status;
  if (points.empty()) return Fault("a contour without points");
  const bool is_long = points.size() > 2;
  const bool goes_on = contour_ != nullptr && contour_->id() == id &&
                       (!is_long || contour_->points_size() == 2 || goes_on_);
  if (absl::Status status = NoteSpelling(goes_on, is_long); !status.ok()) return status;
  if (goes_on) {
    contour_->mutable_points()->MergeFrom(points);
    goes_on_ = true;
    return absl::OkStatus();
  }
  EndContour();
  if (!contour_ids_.insert(id).second) {
    return Fault(absl::StrFormat("second contour with id %d in island %d", id, island_->id()));
  }
  ++contours_.found;
  contour_lines_.push_back(line_);
  contour_ = island_->add_contours();
  contour_->set_id(id);
  contour_->mutable_points()->Swap(&points);
  return absl::OkStatus();
}

// A file either continues contours over several lines or has each on one line, never both.
absl::Status Reader::NoteSpelling(bool goes_on, bool is_long) {
  if (goes_on && first_going_on_ == 0) first_going_on_ = line_;
  if (is_long && first_long_ == 0) first_long_ = line_;
  if (first_going_on_ == 0 || first_long_ == 0) return absl::OkStatus();
  return Fault(
      absl::StrFormat("two spellings in one file: line %d continues a contour, one vertex a line, "
                      "but line %d has all vertices of one",
                      first_going_on_, first_long_));
}

// Drops the repeated closing vertex.
void Reader::EndContour() {
  if (contour_ == nullptr) return;
  Points& points = *contour_->mutable_points();
  const int n = points.size();
  if (n > 2 && points[0] == points[n - 2] && points[1] == points[n - 1]) points.Truncate(n - 2);
  contour_ = nullptr;
  goes_on_ = false;
}

// Moves the outer contour to the front, where the API expects it.
absl::Status Reader::PlaceOuterContour() {
  if (island_->contours_size() < 2) return absl::OkStatus();
  const damat::OuterContour outer = damat::FindOuterContour(*island_);
  const auto name = [&](int index) {
    return absl::StrFormat("C%d", island_->contours(index).id());
  };
  const auto line = [&](int index) { return contour_lines_[static_cast<size_t>(index)]; };
  if (!outer.outside.empty()) {
    const int bad = outer.outside.front();
    const bool all = static_cast<int>(outer.outside.size()) + 1 == island_->contours_size();
    const int later = std::max(bad, outer.index);
    const int earlier = std::min(bad, outer.index);
    if (all) {
      return FaultAt(line(later),
                     absl::StrFormat("%s and %s (line %d) are two outer contours of I%d: neither "
                                     "lies within the other",
                                     name(later), name(earlier), line(earlier), island_->id()));
    }
    return FaultAt(line(bad),
                   absl::StrFormat("%s lies outside %s (line %d), the outer contour of "
                                   "I%d",
                                   name(bad), name(outer.index), line(outer.index), island_->id()));
  }
  auto& contours = *island_->mutable_contours();
  for (int i = outer.index; i > 0; --i) contours.SwapElements(i, i - 1);
  return absl::OkStatus();
}

absl::Status Reader::ReadRaster(uint64_t id, Fields fields) {
  if (island_ == nullptr) return Fault("a raster outside an island");
  EndContour();
  if (!raster_ids_.insert(id).second) {
    return Fault(absl::StrFormat("second raster with id %d in island %d", id, island_->id()));
  }
  ++rasters_.found;
  v1::OpenPath& raster = *island_->add_rasters();
  raster.set_id(id);
  if (absl::Status status = ReadPoints(fields, *raster.mutable_points()); !status.ok()) {
    return status;
  }
  if (raster.points_size() != 4) {
    return Fault(absl::StrFormat("a raster has two ends, not %d", raster.points_size() / 2));
  }
  return absl::OkStatus();
}

absl::Status Reader::ReadPoints(Fields& fields,
                                google::protobuf::RepeatedField<double>& points) const {
  while (!fields.done()) {
    const bool is_x = points.size() % 2 == 0;
    const std::string_view field = fields.Next();
    if (!field.starts_with(is_x ? 'X' : 'Y')) {
      return Fault(absl::StrFormat("%s found, but %s expected", damat::Quoted(field),
                                   is_x ? "X of a point" : "Y of a point"));
    }
    const std::optional<double> value = damat::ParseCoordinate(field.substr(1));
    if (!value) {
      return Fault(absl::StrFormat("%s is not a coordinate within +-1e6 mm", damat::Quoted(field)));
    }
    points.Add(*value);
  }
  if (points.size() % 2 != 0) return Fault("the last X has no Y: is the file cut short?");
  return absl::OkStatus();
}

absl::Status Reader::EndIsland() {
  if (island_ == nullptr) return absl::OkStatus();
  EndContour();
  const std::string who = absl::StrFormat("I%d", island_->id());
  absl::Status status = CheckCount(contours_, who, "contours");
  if (status.ok()) status = CheckCount(rasters_, who, "rasters");
  if (status.ok()) status = PlaceOuterContour();
  island_ = nullptr;
  return status;
}

absl::Status Reader::EndLayer() {
  if (absl::Status status = EndIsland(); !status.ok()) return status;
  if (layer_ == nullptr) return absl::OkStatus();
  const std::string who = absl::StrFormat("F%d", layer_->id());
  layer_ = nullptr;
  return CheckCount(islands_, who, "islands");
}

absl::Status Reader::EndFile() {
  if (absl::Status status = EndLayer(); !status.ok()) return status;
  if (!layers_) return Fault("the file ends without nF, the number of layers");
  return CheckCount(*layers_, "nF", "layers");
}

absl::Status Reader::CheckCount(const Announcement& a, const std::string& who,
                                const char* what) const {
  if (a.announced == a.found) return absl::OkStatus();
  return FaultAt(a.line, absl::StrFormat("%s states %d %s, but the file has %d", who, a.announced,
                                         what, a.found));
}

}  // namespace

absl::StatusOr<InputJob> ReadDamat(std::string_view text, const std::string& name) {
  return Reader(name).Read(text);
}

}  // namespace traverse

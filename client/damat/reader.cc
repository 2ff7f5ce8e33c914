#include "client/damat/reader.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <system_error>

#include "absl/container/flat_hash_set.h"
#include "absl/status/status.h"
#include "absl/strings/str_format.h"
#include "client/damat/fields.h"
#include "client/damat/format.h"
#include "client/files/read_file.h"

namespace traverse {
namespace {

using damat::Fields;

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
  absl::Status ReadLayerCount(Fields fields);
  absl::Status BeginLayer(uint64_t id, Fields fields);
  absl::Status BeginIsland(uint64_t id, Fields fields);
  absl::Status ReadContour(uint64_t id, Fields fields);
  absl::Status ReadRaster(uint64_t id, Fields fields);

  // Reads the fields `X<x>,Y<y>` of one point after another to the end of the record, packed.
  absl::Status ReadPoints(Fields& fields, google::protobuf::RepeatedField<double>& points) const;

  // Ends what is open, checking its counts.
  absl::Status EndIsland();
  absl::Status EndLayer();
  absl::Status EndFile();

  // A fault on the present line, or on `line`.
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
  absl::flat_hash_set<uint64_t> layer_ids_, island_ids_, contour_ids_, raster_ids_;
};

absl::StatusOr<InputJob> Reader::Read(std::string_view text) {
  job_.format = InputFormat::kDamat;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
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

absl::Status Reader::ReadLayerCount(Fields fields) {
  if (layers_) return Fault("second nF");
  const std::optional<uint64_t> count = damat::ParseCount(fields.Next());
  if (!count || !fields.done()) return Fault("nF needs the number of layers");
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
  return absl::OkStatus();
}

absl::Status Reader::ReadContour(uint64_t id, Fields fields) {
  if (island_ == nullptr) return Fault("a contour outside an island");
  if (!contour_ids_.insert(id).second) {
    return Fault(absl::StrFormat("second contour with id %d in island %d", id, island_->id()));
  }
  ++contours_.found;
  v1::Contour& contour = *island_->add_contours();
  contour.set_id(id);
  auto& points = *contour.mutable_points();
  if (absl::Status status = ReadPoints(fields, points); !status.ok()) return status;
  if (points.empty()) return Fault("a contour without points");
  const int n = points.size();
  if (n > 2 && points[0] == points[n - 2] && points[1] == points[n - 1]) points.Truncate(n - 2);
  return absl::OkStatus();
}

absl::Status Reader::ReadRaster(uint64_t id, Fields fields) {
  if (island_ == nullptr) return Fault("a raster outside an island");
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
      return Fault(absl::StrFormat("%s where %s is due", damat::Quoted(field),
                                   is_x ? "X of a point" : "Y of a point"));
    }
    const std::optional<double> value = damat::ParseCoordinate(field.substr(1));
    if (!value) {
      return Fault(absl::StrFormat("%s is no coordinate within +-1e6 mm", damat::Quoted(field)));
    }
    points.Add(*value);
  }
  if (points.size() % 2 != 0) return Fault("the last X has no Y: is the file cut short?");
  return absl::OkStatus();
}

absl::Status Reader::EndIsland() {
  if (island_ == nullptr) return absl::OkStatus();
  const std::string who = absl::StrFormat("I%d", island_->id());
  island_ = nullptr;
  absl::Status status = CheckCount(contours_, who, "contours");
  if (status.ok()) status = CheckCount(rasters_, who, "rasters");
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
  return FaultAt(a.line, absl::StrFormat("%s announces %d %s, the file has %d", who, a.announced,
                                         what, a.found));
}

}  // namespace

absl::StatusOr<InputJob> ReadDamat(std::string_view text, const std::string& name) {
  return Reader(name).Read(text);
}

}  // namespace traverse

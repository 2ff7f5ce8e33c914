#include "client/gcode/plan/joints.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "absl/container/flat_hash_map.h"
#include "client/gcode/machine/machine_profile.h"
#include "client/gcode/machine/motion_planner.h"

namespace traverse::gcode {
namespace {

// The first points of a path seen from one of its ends.
using Points = std::array<Vertex, 3>;

Points PointsFrom(const Outline& outline, uint32_t entry, bool from_end) {
  const std::vector<Vertex>& points = outline.points;
  const size_t n = points.size();
  const bool backwards = outline.closed ? from_end : from_end == (entry == 0);
  Points seen;
  for (size_t k = 0; k < seen.size(); ++k) {
    if (outline.closed && entry > 0) {
      // The last point is the first one, or nearly so.
      const size_t sides = n - 1;
      seen[k] = points[(entry + (backwards ? 2 * sides - k : k)) % sides];
    } else {
      const size_t place = std::min(k, n - 1);
      seen[k] = points[backwards ? n - 1 - place : place];
    }
  }
  return seen;
}

}  // namespace

double StopSeconds(const Joint& joint) {
  return joint.speed_mm_s > 0 ? joint.speed_mm_s / (2 * joint.accel_mm_s2) : 0;
}

LayerJoints::LayerJoints(const GcodeFile& file, const Layer& layer,
                         const std::vector<Outline>& outlines)
    : outlines_(outlines) {
  absl::flat_hash_map<uint32_t, Dynamics> known;
  const auto pace = [&](const Block& block, uint32_t state, Decimal feed) {
    auto found = known.find(state);
    if (found == known.end()) {
      const Dynamics dynamics = DynamicsOf(file.profile, file.states[state], file.setters);
      found = known.emplace(state, dynamics).first;
    }
    const Dynamics& dynamics = found->second;
    const double speed = ToDouble(feed) / 60 * file.modes[block.mode].UnitMm();
    return Pace{std::min(speed, dynamics.max_speed()), dynamics.print_accel(),
                dynamics.corner_speed()};
  };
  paces_.reserve(outlines.size());
  for (uint32_t b = layer.first_block; b < layer.end_block; ++b) {
    const Block& block = file.blocks[b];
    paces_.push_back(
        {pace(block, block.state_in, block.feed_in), pace(block, block.state_out, block.feed_out)});
  }
  stops_.resize(outlines.size());
  for (size_t path = 0; path < outlines.size(); ++path) {
    if (HasStops(path)) stops_[path] = LoopStops(outlines[path].points, paces_[path].first);
  }
}

// Whether stops can be told apart.
bool LayerJoints::HasStops(size_t path) const {
  const Pace& pace = paces_[path].first;
  return outlines_[path].closed && pace.speed_mm_s > 0 && pace.accel_mm_s2 > 0;
}

double LayerJoints::RestartSeconds(size_t path, uint32_t entry) const {
  if (entry == 0 || !HasStops(path)) return 0;
  return StopBesideJoints(path, entry) - StopBesideJoints(path, 0);
}

double LayerJoints::StopBesideJoints(size_t path, uint32_t entry) const {
  return stops_[path].Seconds(outlines_[path].points, paces_[path].first, entry) -
         StopSeconds(EndOf(path, entry)) - StopSeconds(BeginOf(path, entry));
}

// Seen from inside the path, which leads away from that end. A short segment behind a sharp corner
// is too short to get going.
Joint LayerJoints::JointAt(size_t path, uint32_t entry, bool at_end) const {
  const Outline& outline = outlines_[path];
  const bool reversed = !outline.closed && entry > 0;
  const Pace& pace = reversed != at_end ? paces_[path].last : paces_[path].first;
  if (!(pace.speed_mm_s > 0) || !(pace.accel_mm_s2 > 0)) return {};
  const Points points = PointsFrom(outline, entry, at_end);
  const Vertex away = Direction(points[0], points[1]);
  if (away == Vertex{}) return {};
  const Vertex before = Direction(points[1], points[2]);
  const double cosine = away.x * before.x + away.y * before.y;
  const double reached2 = CornerSpeed2(cosine, pace.corner_speed) +
                          2 * pace.accel_mm_s2 * Distance(points[0], points[1]);
  return {away, std::min(pace.speed_mm_s, std::sqrt(reached2)), pace.accel_mm_s2};
}

Joint LayerJoints::BeginOf(size_t path, uint32_t entry) const {
  return JointAt(path, entry, false);
}

Joint LayerJoints::EndOf(size_t path, uint32_t entry) const {
  Joint joint = JointAt(path, entry, true);
  joint.along = {-joint.along.x, -joint.along.y};
  return joint;
}

}  // namespace traverse::gcode

#include "client/gcode/link/layer_departures.h"

#include <utility>

#include "client/gcode/link/link.h"
#include "client/gcode/link/turned_departure.h"

namespace traverse::gcode {

LayerDepartures::LayerDepartures(const GcodeFile& file, const Layer& layer,
                                 const LinkDonors& donors, const std::vector<Outline>& outlines,
                                 const VisibleWalls& walls)
    : file_(file),
      donors_(donors),
      first_block_(layer.first_block),
      outlines_(outlines),
      walls_(walls) {
  for (uint32_t b = layer.first_block; b < layer.end_block; ++b) {
    Note(b);
    if (outlines_[b - first_block_].closed) {
      LoopGap gap = LoopGapOf(file, b);
      if (!gap.moves.empty()) gaps_[b] = std::move(gap);
    }
    if ((file.blocks[b].link & kLinkFixedFrom) == 0) continue;
    const Link link = ReadLink(file, b);
    if (link.fixed == 0) continue;
    const MachineState& machine = link.behind_fixed.machine;
    behind_fixed_[b] = machine.InMm(machine.at);
  }
}

void LayerDepartures::Note(uint32_t block) {
  if (block + 1 >= file_.blocks.size()) return;
  const bool wipes = file_.WipedBehind(block);
  if (!wipes && !MayDepart(file_, block + 1)) return;
  const MachineState& mode = file_.modes[file_.blocks[block].mode];
  const Link link = ReadLink(file_, block + 1);
  if (const LinkStep* step = GoingOnAlong(file_.blocks[block], link)) {
    departures_[block].mm = step->travel_mm * mode.UnitMm();
    departures_[block].as_given = mode.InMm(step->to);
    return;
  }
  Departure noted;
  const LinkStep* aside = DepartureOf(link);
  const bool pulls_behind = aside != nullptr && PullsBackBehind(link, *aside);
  if (aside != nullptr) noted.departs_to = mode.InMm(aside->to);
  if (!wipes) {
    if (aside == nullptr || !(pulls_behind || donors_.MayFollow(block + 1))) return;
    noted.mm = aside->travel_mm * mode.UnitMm();
    noted.as_given = *noted.departs_to;
    noted.turns = pulls_behind || !link.retracts();
    noted.departs = true;
    noted.retracts = link.retracts();
    departures_[block] = noted;
    return;
  }
  noted.wipes = true;
  noted.turns = pulls_behind;
  for (const LinkStep& step : link.steps) {
    if (step.kind != StepKind::kWipe) continue;
    noted.mm += step.travel_mm * mode.UnitMm();
    noted.as_given = mode.InMm(step.to);
  }
  if (noted.mm > 0) departures_[block] = noted;
}

Point LayerDepartures::Begin(const Placement& path) const {
  const Block& block = file_.blocks[path.block];
  if (path.as_given()) return file_.modes[block.mode].InMm(block.first);
  const std::vector<Point>& points = outlines_[path.block - first_block_].points;
  return path.closed ? points[path.entry] : points.back();
}

Point LayerDepartures::End(const Placement& path) const {
  const Block& block = file_.blocks[path.block];
  if (path.as_given()) return file_.modes[block.mode].InMm(block.last);
  const std::vector<Point>& points = outlines_[path.block - first_block_].points;
  if (!path.closed) return points.front();
  const Point end = points[path.entry];
  const auto gap = gaps_.find(path.block);
  if (gap == gaps_.end() || !gap->second.moves[path.entry]) return end;
  const Point before = points[path.entry - 1];
  const double share = gap->second.mm / Distance(end, before);
  return {end.x + (before.x - end.x) * share, end.y + (before.y - end.y) * share};
}

const Departure* LayerDepartures::Of(const Placement& from, bool wipes) const {
  const auto found = departures_.find(from.block);
  if (found == departures_.end() || (found->second.wipes && !wipes)) return nullptr;
  return found->second.departs && !ShortMove(from) ? nullptr : &found->second;
}

std::optional<Point> LayerDepartures::ShortMove(const Placement& from) const {
  const auto found = departures_.find(from.block);
  if (found == departures_.end() || !found->second.departs_to) return std::nullopt;
  if (from.as_given()) return found->second.departs_to;
  const std::vector<Point>& points = outlines_[from.block - first_block_].points;
  if (!from.closed || !found->second.turns) return std::nullopt;
  const auto to = TurnedDeparture(points, from.entry, *found->second.departs_to);
  // Another wall may be as near on that side.
  return to && walls_.Crossed(End(from), *to) ? std::nullopt : to;
}

Point LayerDepartures::Behind(const Placement& from, const Departure& departure) const {
  if (from.as_given()) return departure.as_given;
  return departure.departs ? *ShortMove(from) : BackOver(from, departure.mm);
}

Point LayerDepartures::Open(const Placement& from) const {
  const Departure* departure = Of(from, /*wipes=*/false);
  return departure == nullptr || departure->departs ? End(from) : Behind(from, *departure);
}

std::optional<Point> LayerDepartures::BehindFixed(uint32_t block) const {
  const auto found = behind_fixed_.find(block);
  return found != behind_fixed_.end() ? std::optional<Point>(found->second) : std::nullopt;
}

Point LayerDepartures::BackOver(const Placement& from, double mm) const {
  const std::vector<Point>& points = outlines_[from.block - first_block_].points;
  const size_t n = points.size();
  Point at = End(from);
  const auto go_to = [&](Point next) {
    const double length = Distance(at, next);
    const double share = length > mm ? mm / length : 1;
    at = {at.x + (next.x - at.x) * share, at.y + (next.y - at.y) * share};
    mm -= length;
  };
  if (from.closed) {
    // The last point is the first one, or so near to it that the loop has a gap there.
    go_to(points[from.entry]);
    for (size_t i = 1; i < n && mm > 0; ++i) go_to(points[(from.entry + i) % (n - 1)]);
  } else {
    for (size_t i = 0; i < n && mm > 0; ++i) go_to(points[i]);
  }
  return at;
}

}  // namespace traverse::gcode

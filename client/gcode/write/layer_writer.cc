#include "client/gcode/write/layer_writer.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "client/gcode/link/composer.h"
#include "client/gcode/link/label_lines.h"
#include "client/gcode/link/link.h"
#include "client/gcode/link/turned_departure.h"
#include "client/gcode/machine/motion_planner.h"
#include "client/gcode/model/loops.h"
#include "client/gcode/model/outline.h"
#include "client/gcode/write/link_writer.h"
#include "client/gcode/write/path_writer.h"
#include "client/gcode/write/progress_lines.h"

namespace traverse::gcode {

PartStart StartOfPaths(const GcodeFile& file, const Placement& first) {
  const PlacedPath path(file, first);
  PartStart start{StateAt(file, path.block()), path.state()};
  start.machine.at = path.first();
  // Unknown where the path states it itself.
  start.machine.feed = path.states_feed() ? -1 : path.feed();
  return start;
}

LayerWriter::LayerWriter(const GcodeFile& file, const Layer& layer, const RetractionHabit& habit,
                         const LinkDonors& donors, const Room* room, bool hides,
                         const TravelModel* travel)
    : file_(file),
      layer_(layer),
      donors_(donors),
      room_(room),
      lift_mm_(room != nullptr ? LeastLiftMm() : 0),
      outlines_(OutlinesOf(file, layer)),
      walls_(outlines_),
      rules_(file, layer, habit, outlines_, walls_),
      joints_(file, layer, outlines_),
      spares_walls_(habit.retracts && habit.spares_walls),
      drops_wipes_(habit.drops_wipes),
      hides_(hides && habit.hidden != nullptr),
      travel_(travel) {
  for (uint32_t b = layer.first_block; b < layer.end_block; ++b) {
    NoteLeaving(b);
    if (outlines_[b - layer.first_block].closed) {
      LoopGap gap = LoopGapOf(file, b);
      if (!gap.moves.empty()) gaps_[b] = std::move(gap);
    }
    if (b == 0 || (file.blocks[b].link & kLinkFixedFrom) == 0) continue;
    const Link link = ReadLink(file, b);
    if (link.fixed == 0) continue;
    const MachineState& machine = link.behind_fixed.machine;
    behind_fixed_[b] = machine.InMm(machine.at);
  }
}

std::optional<Vertex> LayerWriter::BehindFixed(uint32_t block) const {
  const auto found = behind_fixed_.find(block);
  return found != behind_fixed_.end() ? std::optional<Vertex>(found->second) : std::nullopt;
}

LayerOrder LayerWriter::GivenOrder() const {
  LayerOrder order;
  order.reserve(outlines_.size());
  for (size_t i = 0; i < outlines_.size(); ++i) {
    order.push_back({static_cast<uint32_t>(layer_.first_block + i), 0, outlines_[i].closed});
  }
  return order;
}

std::vector<uint32_t> LayerWriter::PlacesOf(const LayerOrder& order) const {
  const auto object_of = [this](const Placement& path) { return file_.blocks[path.block].object; };
  std::vector<uint32_t> begins;  // [object of the file's layer] its first place
  for (uint32_t b = layer_.first_block; b < layer_.end_block; ++b) {
    const bool goes_on =
        b > layer_.first_block && file_.blocks[b].object == file_.blocks[b - 1].object;
    if (!goes_on) begins.push_back(b - layer_.first_block);
  }
  std::vector<uint32_t> places;
  size_t objects = 0;
  uint32_t begin = 0;  // in the file, of the object that is here
  size_t here = 0;     // where it begins
  for (size_t i = 0; i < order.size(); ++i) {
    const bool goes_on = i > 0 && object_of(order[i]) == object_of(order[i - 1]);
    if (!goes_on) {
      const uint32_t first = ObjectBegin(file_, order[i].block);
      begin = std::max(first, layer_.first_block) - layer_.first_block;
      places.push_back(objects < begins.size() ? begins[objects] : static_cast<uint32_t>(i));
      here = i;
      ++objects;
    } else {
      places.push_back(begin + static_cast<uint32_t>(i - here));
    }
  }
  return places;
}

PartStart LayerWriter::WriteTravel(const Placement& before, const Placement& first,
                                   const PartStart& start, std::string& text) const {
  GcodeOut out(file_, start, text);
  WriteLink(PlacedPath(file_, before), PlacedPath(file_, first), layer_.first_block, true, false,
            out);
  out.Flush();
  return out.at;
}

PartStart LayerWriter::WritePaths(const LayerOrder& order, const PartStart& start,
                                  std::string& text, std::vector<size_t>* ends,
                                  bool as_sliced) const {
  if (StaysAsText(order, start, as_sliced)) {
    return WriteBarePaths(order, start, text, nullptr, as_sliced);
  }
  std::string bare;
  std::vector<size_t> marks;
  const PartStart behind = WriteBarePaths(order, start, bare, &marks, as_sliced);
  const std::vector<uint32_t> places = PlacesOf(order);
  const bool moved = !std::is_sorted(places.begin(), places.end());
  ProgressLines(file_, layer_, moved).Insert(bare, start, marks, text);
  for (size_t i = 1; ends != nullptr && i < marks.size(); i += 2) ends->push_back(marks[i]);
  return behind;
}

bool LayerWriter::StaysAsText(const LayerOrder& order, const PartStart& start,
                              bool as_sliced) const {
  const bool same_e =
      start.machine.RelativeE() || start.machine.e == file_.blocks[layer_.first_block].e_in;
  return same_e && IsGiven(order) && (as_sliced || !ChangesGiven());
}

PartStart LayerWriter::WriteBarePaths(const LayerOrder& order, const PartStart& start,
                                      std::string& text, std::vector<size_t>* marks,
                                      bool as_sliced) const {
  as_sliced = IsGiven(order) && (as_sliced || !ChangesGiven());
  if (StaysAsText(order, start, as_sliced)) {
    const Block& last = file_.blocks[layer_.end_block - 1];
    const Offset begin = file_.blocks[layer_.first_block].begin;
    for (const size_t mark : marks != nullptr ? PathMarks(file_, layer_) : std::vector<size_t>{}) {
      marks->push_back(text.size() + mark);
    }
    text.append(file_.text, begin, last.end - begin);
    return StartBehind(file_, last);
  }
  // About as much as in the file.
  const size_t bytes =
      file_.blocks[layer_.end_block - 1].end - file_.blocks[layer_.first_block].begin;
  text.reserve(text.size() + bytes + bytes / 16);
  GcodeOut out(file_, start, text);
  PlacedPath from(file_, order.front());
  const std::vector<uint32_t> places = PlacesOf(order);
  const bool moved = !std::is_sorted(places.begin(), places.end());
  for (size_t i = 0; i < order.size(); ++i) {
    if (i > 0) {
      PlacedPath to(file_, order[i]);
      WriteLink(from, to, layer_.first_block + places[i], as_sliced, moved, out);
      from = std::move(to);
    }
    if (marks != nullptr) marks->push_back(text.size());
    WritePath(from, out);
    if (marks != nullptr) marks->push_back(text.size());
  }
  out.Flush();
  return out.at;
}

bool LayerWriter::IsGiven(const LayerOrder& order) const {
  for (size_t i = 0; i < order.size(); ++i) {
    if (order[i].block != layer_.first_block + i || !order[i].as_given()) return false;
  }
  return true;
}

bool LayerWriter::ChangesGiven() const {
  if (!hides_) return false;
  const LayerOrder given = GivenOrder();
  for (size_t i = 1; i < given.size(); ++i) {
    const int link = file_.blocks[given[i].block].link;
    const bool boundary = (link & (kLinkSplits | kLinkFixed)) != 0;
    if ((link & kLinkRetracts) != 0 && HiddenBends(given[i - 1], given[i], boundary)) return true;
  }
  return false;
}

// `place` is the block that stands here in the file. `moved`: objects of the layer have changed
// places, so that lines of progress stand by the time, between objects too.
void LayerWriter::WriteLink(const PlacedPath& from, const PlacedPath& to, uint32_t place,
                            bool as_sliced, bool moved, GcodeOut& out) const {
  // Two objects that still follow each other keep what stands between them, if it is of no other
  // use there than what stands in this place.
  const uint32_t own = to.placement().block;
  const bool neighbors = from.placement().block + 1 == own && from.as_given() && to.as_given();
  if (own != place && neighbors && SaysLabelsOnly(file_, own) && SaysLabelsOnly(file_, place)) {
    place = own;
  }
  const bool boundary = (file_.blocks[place].link & (kLinkSplits | kLinkFixed)) != 0;
  LinkForm form;
  if (boundary) form.boundary = place;
  form.without_progress = !boundary || moved;
  const Vertex at = file_.modes[to.block().mode].InMm(to.first());
  const Feature feature = outlines_[to.placement().block - layer_.first_block].feature;
  form.wipes = Wipes(from.placement(), at, feature, boundary);
  form.retracts = form.wipes || Retracts(from, to);
  form.departs = Departs(from.placement(), at, feature);
  if (form.departs && !from.as_given()) form.turned_departure = DepartsTo(from.placement());
  form.detours = rules_.detours();
  const bool given =
      from.placement().block + 1 == to.placement().block && from.as_given() && to.as_given();
  const bool retracts = given ? (to.block().link & kLinkRetracts) != 0 : form.retracts;
  auto bends = retracts && !as_sliced ? HiddenBends(from.placement(), to.placement(), boundary)
                                      : std::nullopt;
  if (bends) {
    form.hidden = true;
    form.hidden_bends = *std::move(bends);
    form.wipes = form.retracts = form.departs = false;
    form.detours = nullptr;
    form.turned_departure.reset();
  }
  PrintLink(LinkComposer(file_, donors_, from, to, form, out.at.machine).Compose(), out);
}

Vertex LayerWriter::Begin(const Placement& placement) const {
  const Block& block = file_.blocks[placement.block];
  if (placement.as_given()) return file_.modes[block.mode].InMm(block.first);
  const std::vector<Vertex>& points = outlines_[placement.block - layer_.first_block].points;
  return placement.closed ? points[placement.entry] : points.back();
}

Vertex LayerWriter::End(const Placement& placement) const {
  const Block& block = file_.blocks[placement.block];
  if (placement.as_given()) return file_.modes[block.mode].InMm(block.last);
  const std::vector<Vertex>& points = outlines_[placement.block - layer_.first_block].points;
  if (!placement.closed) return points.front();
  const Vertex end = points[placement.entry];
  const auto gap = gaps_.find(placement.block);
  if (gap == gaps_.end() || !gap->second.moves[placement.entry]) return end;
  const Vertex before = points[placement.entry - 1];
  const double share = gap->second.mm / Distance(end, before);
  return {end.x + (before.x - end.x) * share, end.y + (before.y - end.y) * share};
}

void LayerWriter::NoteLeaving(uint32_t block) {
  const MachineState& mode = file_.modes[file_.blocks[block].mode];
  if (const std::optional<LinkStep> step = ReadGoingOn(file_, block)) {
    leaving_[block].mm = step->travel_mm * mode.UnitMm();
    leaving_[block].as_given = mode.InMm(step->to);
    return;
  }
  Leaving leaving;
  if (!file_.WipedBehind(block)) {
    if (block + 1 >= file_.blocks.size() || !MayDepart(file_, block + 1)) return;
    const Link link = ReadLink(file_, block + 1);
    const LinkStep* departure = DepartureOf(link);
    if (departure == nullptr) return;
    if (!donors_.MayFollow(block + 1) && !PullsBackBehind(link, *departure)) return;
    leaving_[block] = {.mm = departure->travel_mm * mode.UnitMm(),
                       .as_given = mode.InMm(departure->to),
                       .departs_to = mode.InMm(departure->to),
                       .turns = !link.retracts() || PullsBackBehind(link, *departure),
                       .departs = true,
                       .retracts = link.retracts()};
    return;
  }
  leaving.wipes = true;
  const Link link = ReadLink(file_, block + 1);
  if (const LinkStep* departure = DepartureOf(link)) {
    leaving.departs_to = mode.InMm(departure->to);
    leaving.turns = PullsBackBehind(link, *departure);
  }
  for (const LinkStep& step : link.steps) {
    if (step.kind == StepKind::kFilament && leaving.mm == 0) leaving.stands = true;
    if (step.kind != StepKind::kWipe) continue;
    leaving.mm += step.travel_mm * mode.UnitMm();
    leaving.as_given = mode.InMm(step.to);
  }
  if (leaving.mm > 0) leaving_[block] = leaving;
}

const LayerWriter::Leaving* LayerWriter::LeavingOf(const Placement& from, bool wipes) const {
  const auto found = leaving_.find(from.block);
  if (found == leaving_.end() || (found->second.wipes && !wipes)) return nullptr;
  return found->second.departs && !DepartsTo(from) ? nullptr : &found->second;
}

std::optional<Vertex> LayerWriter::DepartsTo(const Placement& from) const {
  const auto found = leaving_.find(from.block);
  if (found == leaving_.end() || !found->second.departs_to) return std::nullopt;
  if (from.as_given()) return found->second.departs_to;
  const std::vector<Vertex>& points = outlines_[from.block - layer_.first_block].points;
  if (!from.closed || !found->second.turns) return std::nullopt;
  const auto to = TurnedDeparture(points, from.entry, *found->second.departs_to);
  // Another wall may be as near on that side.
  return to && walls_.Crossed(End(from), *to) ? std::nullopt : to;
}

Vertex LayerWriter::Behind(const Placement& from, const Leaving& leaving) const {
  if (from.as_given()) return leaving.as_given;
  return leaving.departs ? *DepartsTo(from) : BackOver(from, leaving.mm);
}

Vertex LayerWriter::BackOver(const Placement& from, double mm) const {
  const std::vector<Vertex>& points = outlines_[from.block - layer_.first_block].points;
  const size_t n = points.size();
  Vertex at = End(from);
  const auto go_to = [&](Vertex next) {
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
    for (size_t i = 0; i < n && mm > 0; ++i) go_to(points[from.as_given() ? n - 1 - i : i]);
  }
  return at;
}

bool LayerWriter::GoesOnAcross(const Placement& from, Vertex to, Feature feature) const {
  const Leaving* leaving = LeavingOf(from);
  if (!spares_walls_ || leaving == nullptr || leaving->wipes || leaving->departs) return false;
  return rules_.TravelOf(Behind(from, *leaving), to, feature).crosses;
}

bool LayerWriter::Departs(const Placement& from, Vertex to, Feature feature) const {
  const Leaving* leaving = LeavingOf(from);
  // What goes on along a path, or comes before its wipe, stays with the path.
  if (leaving == nullptr || !leaving->departs) return leaving != nullptr;
  const PlannedTravel travel = rules_.TravelOf(End(from), to, feature);
  if (travel.retracts != leaving->retracts) return false;
  // Behind a loop as sliced it hides the retraction, whatever it crosses.
  if (travel.retracts && from.as_given()) return true;
  const Vertex at = Behind(from, *leaving);
  const PlannedTravel behind = rules_.TravelOf(at, to, feature);
  std::vector<Vertex> bent = {End(from), at};
  bent.insert(bent.end(), behind.via.begin(), behind.via.end());
  bent.push_back(to);
  return travel.crosses || !(behind.crosses || walls_.CrossedByTravel(bent));
}

// Paths that the slicer wipes stay wiped, so that all travel moves from them are retracted.
bool LayerWriter::Wipes(const Placement& from, Vertex to, Feature feature, bool boundary) const {
  if (!file_.WipedBehind(from.block)) return false;
  return !drops_wipes_ || boundary || rules_.Retracts(End(from), to, feature);
}

bool LayerWriter::Retracts(const PlacedPath& from, const PlacedPath& to) const {
  const MachineState& mode = file_.modes[to.block().mode];
  const Feature feature = outlines_[to.placement().block - layer_.first_block].feature;
  return rules_.Retracts(mode.InMm(from.last()), mode.InMm(to.first()), feature) ||
         GoesOnAcross(from.placement(), mode.InMm(to.first()), feature);
}

}  // namespace traverse::gcode

#include "client/gcode/choose/object_orders.h"

#include <algorithm>
#include <cassert>
#include <functional>
#include <queue>
#include <utility>

#include "absl/container/flat_hash_set.h"
#include "absl/types/span.h"
#include "client/gcode/choose/round_trip.h"
#include "client/gcode/link/label_lines.h"
#include "client/gcode/link/link.h"

namespace traverse::gcode {
namespace {

// The objects of a layer as the file has them, and what is of none between them.
std::vector<LayerObject> ObjectsIn(const GcodeFile& file, const Layer& layer) {
  std::vector<LayerObject> objects;
  for (uint32_t b = layer.first_block; b < layer.end_block; ++b) {
    const uint32_t path = b - layer.first_block;
    const uint32_t object = file.blocks[b].object;
    if (objects.empty() || objects.back().object != object) {
      objects.push_back({path, path, object});
    }
    objects.back().end = path + 1;
  }
  return objects;
}

// In prints object by object the head goes down again to begin an object, when one that is higher
// is finished.
bool PrintsOneByOne(const GcodeFile& file) {
  absl::flat_hash_map<uint32_t, size_t> last;  // [object] its last block
  for (size_t i = 0; i < file.blocks.size(); ++i) last[file.blocks[i].object] = i;
  absl::flat_hash_map<uint32_t, bool> begun;
  Decimal highest = 0;
  uint32_t of = 0;  // the object that is so high
  for (size_t i = 0; i < file.blocks.size(); ++i) {
    const Block& block = file.blocks[i];
    if (block.object == 0) continue;
    const bool begins = begun.try_emplace(block.object, true).second;
    if (begins && block.first.z < highest && last[of] < i) return true;
    if (block.first.z < highest) continue;
    highest = block.first.z;
    of = block.object;
  }
  return false;
}

// Objects of a file, in the order in which they are first printed, and the middle of their paths.
struct Middles {
  std::vector<uint32_t> objects;
  std::vector<Point> points;
};

Middles MiddlesOf(const GcodeFile& file) {
  Middles middles;
  absl::flat_hash_map<uint32_t, std::pair<size_t, double>> known;  // place, paths
  for (const Block& block : file.blocks) {
    if (block.object == 0) continue;
    const auto [found, added] = known.try_emplace(block.object, middles.objects.size(), 0);
    if (added) {
      middles.objects.push_back(block.object);
      middles.points.push_back({});
    }
    auto& [place, paths] = found->second;
    Point& middle = middles.points[place];
    const Point at = file.modes[block.mode].InMm(block.first);
    middle = {(middle.x * paths + at.x) / (paths + 1), (middle.y * paths + at.y) / (paths + 1)};
    paths += 1;
  }
  return middles;
}

// The places of `trip`, round, in the order in which it comes to them behind `last`.
std::vector<uint32_t> EndedWith(std::vector<uint32_t> trip, uint32_t last) {
  std::rotate(trip.begin(), std::find(trip.begin(), trip.end(), last) + 1, trip.end());
  return trip;
}

// Numbers of `places`: round trips through all, from the first to the last one of a layer.
//
// The first object of the print cannot move in the first layer, and the last one not in the last
// layer: scripts stand beside them. A short trip ends with the last one, and comes soon to the
// first. If islands would rest too short where orders change to it, one that also begins with the
// first one is left. `last` is the number of the last one.
std::vector<std::vector<uint32_t>> TripsThrough(std::vector<Point> places, uint32_t last) {
  std::vector<uint32_t> trip = EndedWith(RoundTrip(places), last);
  const auto first = std::find(trip.begin(), trip.end(), 0);
  if (2 * (first - trip.begin()) >= std::ssize(trip)) {
    std::reverse(trip.begin(), trip.end());
    trip = EndedWith(std::move(trip), last);
  }
  if (last == 0 || trip.front() == 0) return {trip};
  const Point at_last = places[last];
  places.erase(places.begin() + last);
  std::vector<uint32_t> from_first = RoundTrip(places);
  const auto added = [&](uint32_t end) {
    return Distance(places[end], at_last) - Distance(places[end], places[0]);
  };
  if (from_first.size() > 2 && added(from_first[1]) < added(from_first.back())) {
    std::reverse(from_first.begin() + 1, from_first.end());
  }
  for (uint32_t& number : from_first) number += number >= last ? 1 : 0;
  from_first.push_back(last);
  return {trip, from_first};
}

// Finds the runs of a layer.
class RunFinder {
 public:
  RunFinder(const GcodeFile& file, const Layer& layer, const LayerFreedom& freedom)
      : file_(file), layer_(layer), freedom_(freedom) {}

  LayerObjects Find() {
    for (const LayerObject& object : ObjectsIn(file_, layer_)) {
      if (!MayStandElsewhere(object)) {
        EndRun();
        continue;
      }
      const uint32_t begin = layer_.first_block + object.begin;
      if ((file_.blocks[begin].link & kLinkHeats) != 0 || SetsFirst(begin)) EndRun();
      if (!run_.empty() && !LabelledAlike(run_.front(), object)) {
        Bar("their labels are not written alike");
        EndRun();
      }
      run_.push_back(object);
    }
    EndRun();
    return std::move(found_);
  }

 private:
  bool MayStandElsewhere(const LayerObject& object) {
    if (object.object == 0) return false;
    const uint32_t first = layer_.first_block;
    if ((object.begin == 0 && GoesOn(first)) ||
        (first + object.end == layer_.end_block && GoesOn(layer_.end_block))) {
      Bar("one of them goes on in another layer");
      return false;
    }
    for (uint32_t path = object.begin; path < object.end; ++path) {
      const uint32_t block = layer_.first_block + path;
      const bool amid = path > object.begin;
      const bool heats = amid && (file_.blocks[block].link & kLinkHeats) != 0;
      const bool sets = amid && SetsFirst(block);
      if (!freedom_.rules[path].pinned && !heats && !sets) continue;
      Bar(heats  ? "a temperature changes amid one of them"
          : sets ? "something is set for the first time amid one of them"
                 : "paths of one of them stay as sliced, beside commands that are not known, "
                   "a tower or a script");
      return false;
    }
    return true;
  }

  // `block` is of the object before it, under the same label.
  bool GoesOn(uint32_t block) const {
    if (block == 0 || block >= file_.blocks.size() ||
        file_.blocks[block].object != file_.blocks[block - 1].object) {
      return false;
    }
    const std::vector<LinkStep> steps = ReadLink(file_, block).steps;
    return std::none_of(steps.begin(), steps.end(),
                        [](const LinkStep& step) { return step.kind == StepKind::kLabel; });
  }

  // Something is set between `block` and the one before that never was before: nothing could undo
  // it for paths that come to stand behind it.
  bool SetsFirst(uint32_t block) const {
    if (block == 0 || file_.blocks[block].state_in == file_.blocks[block - 1].state_in)
      return false;
    const PrintState& before = file_.states[file_.blocks[block - 1].state_in];
    const PrintState& behind = file_.states[file_.blocks[block].state_in];
    for (size_t slot = 0; slot < kSlotCount; ++slot) {
      if (before[slot] == 0 && behind[slot] != 0) return true;
    }
    return false;
  }

  bool LabelledAlike(const LayerObject& a, const LayerObject& b) const {
    const uint32_t first = layer_.first_block;
    return BeginsAlike(file_, first + a.begin, first + b.begin) &&
           EndsAlike(file_, first + a.end, first + b.end);
  }

  // Objects of one region touch, or what lies between them does.
  void NoteContacts(std::vector<LayerObject>& objects) const {
    absl::flat_hash_map<uint32_t, uint32_t> last;  // [island] its last object so far
    for (uint32_t i = 0; i < objects.size(); ++i) {
      for (uint32_t path = objects[i].begin; path < objects[i].end; ++path) {
        const auto [found, added] = last.try_emplace(freedom_.island[path], i);
        const uint32_t before = std::exchange(found->second, i);
        if (before != i) objects[i].behind.push_back(before);
      }
    }
  }

  void EndRun() {
    std::vector<LayerObject> run = std::exchange(run_, {});
    if (run.size() < 2) return;
    absl::flat_hash_set<uint32_t> different;
    for (const LayerObject& object : run) different.insert(object.object);
    if (different.size() < run.size()) return Bar("one of them is printed twice in a layer");
    NoteContacts(run);
    found_.runs.push_back(std::move(run));
  }

  void Bar(std::string_view barrier) {
    if (found_.barrier.empty()) found_.barrier = barrier;
  }

  const GcodeFile& file_;
  const Layer& layer_;
  const LayerFreedom& freedom_;
  std::vector<LayerObject> run_;
  LayerObjects found_;
};

// The numbers of the objects of `run` along the round trip with `ranks`; of those that touch, the
// later one stays the later one.
std::vector<uint32_t> Sorted(const std::vector<LayerObject>& run,
                             const absl::flat_hash_map<uint32_t, uint32_t>& ranks, bool backwards) {
  using Ranked = std::pair<uint32_t, uint32_t>;  // rank, number
  std::priority_queue<Ranked, std::vector<Ranked>, std::greater<>> free;
  const auto release = [&](uint32_t i) {
    const uint32_t rank = ranks.at(run[i].object);
    free.emplace(backwards ? UINT32_MAX - rank : rank, i);
  };
  std::vector<size_t> waits(run.size());  // for so many others
  std::vector<std::vector<uint32_t>> ahead_of(run.size());
  for (uint32_t i = 0; i < run.size(); ++i) {
    waits[i] = run[i].behind.size();
    if (waits[i] == 0) release(i);
    for (const uint32_t before : run[i].behind) ahead_of[before].push_back(i);
  }
  std::vector<uint32_t> sorted;
  while (!free.empty()) {
    const uint32_t next = free.top().second;
    free.pop();
    sorted.push_back(next);
    for (const uint32_t behind : ahead_of[next]) {
      if (--waits[behind] == 0) release(behind);
    }
  }
  return sorted;
}

}  // namespace

ObjectOrders::ObjectOrders(const GcodeFile& file) : file_(file) {
  const Middles middles = MiddlesOf(file);
  if (middles.objects.size() < 2) return;
  if (PrintsOneByOne(file)) {
    barrier_ = "the print goes object by object";
    return;
  }
  const auto last = std::find_if(file.blocks.rbegin(), file.blocks.rend(),
                                 [](const Block& block) { return block.object != 0; });
  const auto at = std::find(middles.objects.begin(), middles.objects.end(), last->object);
  const auto number = static_cast<uint32_t>(at - middles.objects.begin());
  for (const std::vector<uint32_t>& trip : TripsThrough(middles.points, number)) {
    Ranks& ranks = trips_.emplace_back();
    for (const uint32_t place : trip) ranks.try_emplace(middles.objects[place], ranks.size());
  }
}

LayerObjects ObjectOrders::ObjectsOf(const Layer& layer, const LayerFreedom& freedom) const {
  return any() ? RunFinder(file_, layer, freedom).Find() : LayerObjects{};
}

std::vector<LayerOrder> ObjectOrders::Moved(const Layer& layer, const LayerObjects& objects,
                                            const LayerOrder& order, bool backwards) const {
  // Whole objects only: what search and file agree about.
  const auto blocks = absl::MakeConstSpan(file_.blocks)
                          .subspan(layer.first_block, layer.end_block - layer.first_block);
  const auto object_of = [this](const Placement& path) { return file_.blocks[path.block].object; };
  if (!std::ranges::equal(order, blocks, {}, object_of, &Block::object)) return {};
  std::vector<LayerOrder> moved;
  const auto add = [&](const Ranks& ranks, bool turned) {
    LayerOrder other = order;
    for (const std::vector<LayerObject>& run : objects.runs) {
      auto to = other.begin() + run.front().begin;
      for (const uint32_t object : Sorted(run, ranks, turned)) {
        const auto from = order.begin();
        to = std::copy(from + run[object].begin, from + run[object].end, to);
      }
    }
    const bool known = std::find(moved.begin(), moved.end(), other) != moved.end();
    if (other != order && !known) moved.push_back(std::move(other));
  };
  for (const Ranks& ranks : trips_) add(ranks, false);
  if (backwards) add(trips_.front(), true);
  return moved;
}

void ObjectOrders::AddTo(size_t layer, const MergeRules& rules, const ColumnFiller& filler,
                         LayerColumn& column) const {
  assert(any());
  const Layer& of_file = file_.layers[layer];
  const LayerObjects objects = ObjectsOf(of_file, *rules.freedom);
  if (objects.runs.empty()) return;
  std::vector<LayerOrder> moved;
  for (const LayerOrder& base : FastestOrders(column)) {
    for (LayerOrder& order : Moved(of_file, objects, base, IsFree(rules.policy))) {
      moved.push_back(std::move(order));
    }
  }
  if (rules.polish) {
    LayerMerge merge(column.travels(), rules);
    for (LayerOrder& order : moved) order = merge.Improve(order, LayerMerge::Effort::kSettle);
  }
  for (const LayerOrder& order : moved) filler.Add(order, layer, column);
}

}  // namespace traverse::gcode

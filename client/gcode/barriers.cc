#include "client/gcode/barriers.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string_view>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/substitute.h"
#include "client/gcode/choose/object_orders.h"
#include "client/gcode/dialects/label.h"
#include "client/gcode/model/block_feature.h"
#include "client/gcode/parallel.h"
#include "client/gcode/plan/layer_plan.h"
#include "client/gcode/read/custom_gcode.h"
#include "client/gcode/read/least_layer_time.h"
#include "client/gcode/text/text.h"

namespace traverse {
namespace gcode {
namespace {

enum Cause : uint8_t {
  kUnknownLine,
  kToolChange,
  kTower,
  kScript,
  kPrintedOddly,
  kObjectLabel,
  kKnownLine,
  kFanChange,
  kWallOrder,
  kInfillOrder,
  kSurfaceOrder,
  kSupportOrder,
  kAlone,
  kCauses,
};

struct Tally {
  int64_t paths = 0;
  int64_t layers = 0;
  Offset at = UINT32_MAX;  // of the first line that does it, if it is a line

  void Add(const Tally& other) {
    paths += other.paths;
    layers += other.layers;
    at = std::min(at, other.at);
  }
};

struct Tallies {
  std::array<Tally, kCauses> of;
  std::string_view objects;  // why whole objects stay; empty if they do not
};

// The line of a link that nothing passes, and what it is.
struct Obstacle {
  Cause cause = kKnownLine;
  Offset at = UINT32_MAX;
};

Obstacle ObstacleIn(const GcodeFile& file, uint32_t block) {
  const Block& before = file.blocks[block - 1];
  const Block& behind = file.blocks[block];
  if (file.modes[before.mode].tool != file.modes[behind.mode].tool)
    return {kToolChange, before.end};
  Interpreter interpreter(std::string_view(file.text).substr(0, behind.begin), before.end,
                          file.modes[before.mode]);
  Obstacle found;
  for (Step step; interpreter.Next(step);) {
    const Offset at = step.line.begin;
    if (step.kind == StepKind::kUnknown) return {kUnknownLine, at};
    if (step.kind == StepKind::kModeChange) {
      return {step.command.letter == 'T' ? kToolChange : kUnknownLine, at};
    }
    // The first label, or else the first line that is known.
    if (step.kind == StepKind::kLabel && found.cause != kObjectLabel) found = {kObjectLabel, at};
    if (step.kind == StepKind::kStay && found.at == UINT32_MAX) found = {kKnownLine, at};
  }
  return found;
}

// What a layer holds in place.
class LayerTally {
 public:
  LayerTally(const GcodeFile& file, const Layer& layer, const LayerPlan& plan, bool fans_are_free)
      : file_(file),
        layer_(layer),
        freedom_(plan.freedom),
        outlines_(plan.outlines),
        fans_are_free_(fans_are_free) {}

  Tallies Take(const ObjectOrders& objects) {
    const auto paths = static_cast<uint32_t>(freedom_.rules.size());
    if (paths < 2) {
      Note(kAlone, paths);
    } else {
      for (uint32_t path = 1; path < paths; ++path) {
        if (freedom_.group[path] == path) NoteBoundary(path);
      }
      NoteOrders();
    }
    for (Tally& tally : tallies_.of) tally.layers = tally.paths > 0 ? 1 : 0;
    if (tallies_.of[kObjectLabel].paths > 0) {
      const LayerObjects of_layer = objects.ObjectsOf(layer_, freedom_);
      if (of_layer.runs.empty()) tallies_.objects = of_layer.barrier;
    }
    return tallies_;
  }

 private:
  void Note(Cause cause, int64_t paths, Offset at = UINT32_MAX) {
    tallies_.of[cause].Add({paths, 0, at});
  }

  // Between `path`, with which a group begins, and the one before it.
  void NoteBoundary(uint32_t path) {
    const uint32_t block = layer_.first_block + path;
    const auto end = std::ranges::upper_bound(freedom_.group, path) - freedom_.group.begin();
    const auto kept = std::min<int64_t>(end - path, path - freedom_.group[path - 1]);
    const auto is = [&](uint32_t of, Feature feature) { return outlines_[of].feature == feature; };
    for (const uint32_t one : {path - 1, path}) {
      const Block& kept_block = file_.blocks[layer_.first_block + one];
      if (is(one, Feature::kTower)) return Note(kTower, kept);
      if (is(one, Feature::kCustom) || (kept_block.flags & kBlockScript) != 0) {
        return Note(kScript, kept, kept_block.begin);
      }
      if ((kept_block.flags & kBlockPinned) != 0) {
        return Note(kPrintedOddly, kept, kept_block.begin);
      }
    }
    const bool by_line =
        (file_.blocks[block].link & (kLinkSplits | kLinkFixed | kLinkFixedFrom)) != 0;
    if (by_line) {
      const Obstacle obstacle = ObstacleIn(file_, block);
      if (obstacle.at != UINT32_MAX) return Note(obstacle.cause, kept, obstacle.at);
    }
    if (!fans_are_free_ && FanChanges(file_, block)) Note(kFanChange, kept);
  }

  static bool IsSupport(Feature feature) {
    return feature == Feature::kSupport || feature == Feature::kSupportInterface;
  }

  static bool IsSurface(Feature feature) {
    return feature == Feature::kTopInfill || feature == Feature::kBottomInfill ||
           feature == Feature::kIroning || feature == Feature::kBridge;
  }

  // Pairs of paths that could change places, but for what the policy keeps.
  void NoteOrders() {
    std::array<std::vector<bool>, kCauses> held;
    for (auto& paths : held) paths.resize(freedom_.rules.size());
    for (const auto& [first, second] : freedom_.ordered) {
      if (freedom_.group[first] != freedom_.group[second]) continue;
      const Feature a = outlines_[first].feature;
      const Feature b = outlines_[second].feature;
      const Cause cause = IsSupport(a) || IsSupport(b)   ? kSupportOrder
                          : IsSurface(a) || IsSurface(b) ? kSurfaceOrder
                          : IsWall(a) && IsWall(b)       ? kWallOrder
                                                         : kInfillOrder;
      held[cause][first] = held[cause][second] = true;
    }
    for (size_t cause = 0; cause < kCauses; ++cause) {
      const auto paths = std::count(held[cause].begin(), held[cause].end(), true);
      if (paths > 0) Note(static_cast<Cause>(cause), paths);
    }
  }

  const GcodeFile& file_;
  const Layer& layer_;
  const LayerFreedom& freedom_;
  const std::vector<Outline>& outlines_;
  const bool fans_are_free_;
  Tallies tallies_;
};

// "`M400`" of the line at `at`.
std::string Quoted(const GcodeFile& file, Offset at) {
  constexpr size_t kMost = 40;
  const std::string_view line = TrimBlanks(LineAt(file.text, at).Text(file.text));
  return absl::StrCat("`", std::string(line.substr(0, kMost)), line.size() > kMost ? "..." : "",
                      "`");
}

// What holds paths, and what would let them move. `$0` is the first line that does it, `$1` its
// place.
struct CauseWords {
  const char* holds;
  const char* frees;  // null for lines that may be of the slicer or of its user (WithoutLine)
  const char* under_free = nullptr;  // instead, where --policy=free is asked for already
};
constexpr std::array<CauseWords, kCauses> kWords = {{
    {"stay beside commands that are not known here, the first of them $0", nullptr},
    {"stay on one side of a change of tool or filament, the first of them in $1",
     "fewer such changes within a layer would hold less"},
    {"stay beside the wipe tower, which nothing passes",
     "without it (\"Prime tower\", \"Wipe tower\" in the slicer) more could move"},
    {"are in or beside what a script prints, such as a purge line (first in $1)",
     "only the slicer's start or custom G-code changes that"},
    {"are printed rising, as spiral vases are, or with the filament retracted, "
     "the first of them in $1",
     "with spiral vase off in the slicer more could move"},
    {"stay within the label of an object, the first of which is $0",
     "with the slicer's labels of objects off (\"Label objects\", \"Exclude objects\"), where it "
     "has such a setting, paths of several could mix"},
    {"stay on one side of a line that nothing passes, the first of them $0", nullptr},
    {"stay on one side of a change of the fan",
     "--allow=fan_order or --policy=free would free more, or the same fan speed for bridges and "
     "overhangs in the slicer"},
    {"are walls that touch and keep their order",
     "--allow=wall_order or --policy=free lets them change places"},
    {"are walls and infill that touch and keep their order",
     "--allow=infill_order lets them change places"},
    {"are lines of surfaces, bridges or ironing and what lies under them, in the order of the "
     "slicer",
     "monotonic lines may mix with --policy=free or with another pattern in the slicer",
     "another pattern of surfaces in the slicer, or no ironing, would hold less"},
    {"are supports and what rests on them, in the order in which the slicer has them",
     "no flag changes that, only another support in the slicer"},
    {"are alone in a layer", "nothing can change places there"},
}};

std::string Counted(int64_t count, const char* what) {
  return absl::StrCat(count, " ", what, count == 1 ? "" : "s");
}

// "is alone" of "are alone", and so on.
std::string OfOne(std::string_view holds) {
  constexpr std::string_view kAre = "are ";
  if (holds.starts_with(kAre)) return absl::StrCat("is ", std::string(holds.substr(kAre.size())));
  const size_t verb = holds.find(' ');
  return absl::StrCat(std::string(holds.substr(0, verb)), "s", std::string(holds.substr(verb)));
}

// Who writes the line at `at`, and may leave it out.
std::string WithoutLine(const GcodeFile& file, Offset at) {
  const std::string_view line = TrimBlanks(LineAt(file.text, at).Text(file.text));
  const auto settings = SettingsThatAdd(file.text, line);
  if (!settings) return "without it, in custom G-code or a script, they would be free";
  if (settings->empty()) {
    return "the slicer's custom G-code has none, so no setting of that frees them";
  }
  std::string names;
  for (const std::string_view setting : *settings) {
    absl::StrAppend(&names, names.empty() ? "`" : " or `", std::string(setting), "`");
  }
  return absl::StrCat("without it in the slicer's ", names, " they would be free");
}

std::string TextOf(const GcodeFile& file, Policy policy, Cause cause, const Tallies& tallies) {
  const Tally& tally = tallies.of[cause];
  const bool line = tally.at != UINT32_MAX;
  const std::string place = line ? file.Place(tally.at) : "";
  std::string text =
      absl::StrCat(Counted(tally.paths, "path"), " in ", Counted(tally.layers, "layer"), " ") +
      absl::Substitute(tally.paths == 1 ? OfOne(kWords[cause].holds) : kWords[cause].holds,
                       line ? absl::StrCat(Quoted(file, tally.at), " in ", place) : "", place);
  if (cause == kObjectLabel && !tallies.objects.empty()) {
    absl::StrAppend(&text, ", and whole objects keep their places, because ",
                    std::string(tallies.objects));
  }
  const CauseWords& words = kWords[cause];
  if (words.frees == nullptr) return absl::StrCat(text, "; ", WithoutLine(file, tally.at));
  const bool free = IsFree(policy) && words.under_free != nullptr;
  return absl::StrCat(text, "; ", free ? words.under_free : words.frees);
}

// What holds besides what can be counted by paths; `searched`: though orders were looked for.
std::string Remainder(const GcodeFile& file, Policy policy, bool searched) {
  const double least_seconds = LeastLayerSeconds(file.text);
  if (IsFree(policy) || least_seconds <= 0) {
    return absl::StrCat("the rest may change places",
                        searched ? ", but no other order found is faster" : "",
                        policy == Policy::kSafe ? " with visible walls begun where they are" : "");
  }
  return absl::StrFormat(
      "%s each island rest %.4g s, or as long as in the file, before it is printed on%s; "
      "--policy=free gives that up, and a lower least layer time in the slicer a part of it",
      searched ? "of the rest, no order found is faster that lets"
               : "the rest may change places in orders that let",
      least_seconds, policy == Policy::kSafe ? ", and visible walls begin where they do" : "");
}

}  // namespace
}  // namespace gcode

std::vector<std::string> DescribeBarriers(const GcodeFile& file, gcode::Policy policy,
                                          const gcode::Allowance& allow,
                                          const std::vector<bool>& counted) {
  using gcode::Cause;
  const gcode::ObjectOrders objects(file);
  const bool fans_are_free = gcode::IsFree(policy) || allow.fan_order;
  std::vector<gcode::Tallies> of_layer(file.layers.size());
  const auto take = [&](size_t i) {
    if (!counted.empty() && !counted[i]) return;
    const gcode::Layer& layer = file.layers[i];
    const gcode::LayerPlan plan = gcode::MakeLayerPlan(file, layer, policy, allow);
    of_layer[i] = gcode::LayerTally(file, layer, plan, fans_are_free).Take(objects);
  };
  gcode::ParallelFor(of_layer.size(), gcode::ThreadsFor(file.text.size()), take, file.limit);
  gcode::Tallies all;
  std::map<std::string_view, int64_t> reasons;  // why objects of a layer stay, and in how many
  for (const gcode::Tallies& layer : of_layer) {
    for (size_t cause = 0; cause < all.of.size(); ++cause) all.of[cause].Add(layer.of[cause]);
    if (!layer.objects.empty()) ++reasons[layer.objects];
  }
  const auto usual =
      std::ranges::max_element(reasons, {}, [](const auto& it) { return it.second; });
  all.objects = usual != reasons.end() ? usual->first : objects.barrier();
  std::vector<Cause> causes;
  for (size_t cause = 0; cause < all.of.size(); ++cause) {
    if (all.of[cause].paths > 0) causes.push_back(static_cast<Cause>(cause));
  }
  std::ranges::stable_sort(causes, std::greater(), [&](Cause one) { return all.of[one].paths; });
  std::vector<std::string> lines;
  for (const Cause cause : causes) {
    if (lines.size() < kMostBarriers) lines.push_back(gcode::TextOf(file, policy, cause, all));
  }
  if (lines.size() < kMostBarriers) {
    lines.push_back(gcode::Remainder(file, policy, !counted.empty()));
  }
  return lines;
}

std::vector<std::string> DescribeOddLines(const GcodeFile& file) {
  std::vector<std::string> lines;
  const auto note = [&](const gcode::OddLines& odd, const char* one, const char* more,
                        const char* why) {
    if (odd.count == 0) return;
    const std::string_view words = odd.count == 1 ? one : more;
    lines.push_back(absl::StrCat(odd.count, " ", std::string(words), " (first in ",
                                 file.Place(odd.at), ")", why));
  };
  const auto segments = static_cast<int64_t>(file.ends.size());
  if (file.relative_moves.count > segments) {
    note(file.relative_moves, "move that prints stays in place, being relative (G91)",
         "moves that print stay in place, being relative (G91)",
         "; absolute coordinates (G90) in the slicer would let more move");
  }
  if (file.empty_moves.count > segments) {
    note(file.empty_moves, "move states an E that pushes nothing",
         "moves state an E that pushes nothing",
         "; no path is made of that, so it stays in place; with more flow, or another filament "
         "diameter, in the slicer it would print");
  }
  note(file.unread_moves, "line begins as a move does, but cannot be read",
       "lines begin as moves do, but cannot be read", ", and nothing passes such a line");
  return lines;
}

}  // namespace traverse

// What travel does, step by step: it retracts, rises, moves sideways, goes down and primes. Between
// the same two points as in the original it rises no less; with the same kinds of steps it rises as
// high, along the same spiral, with the same speeds and accelerations. Behind unknown lines it does
// the same steps wherever it leads to.

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "absl/container/flat_hash_map.h"
#include "absl/container/flat_hash_set.h"
#include "absl/strings/str_format.h"
#include "client/gcode/verify/match/travel_ends.h"
#include "client/gcode/verify/rules/rules.h"
#include "client/gcode/verify/text.h"

namespace traverse::gcode {
namespace {

constexpr double kLevelMm = 0.003;
constexpr double kShortestStepMm = 0.05;

// One step, or several alike: all but where it leads to, and how much filament a wipe pulls.
struct TravelStep {
  MoveKind kind = MoveKind::kTravel;
  double z_mm = 0;
  Micro filament = 0;
  Micro feed = 0;
  bool open = false;
  uint64_t acceleration = 0;
  uint32_t line = 0;
  double top_mm = 0;    // of where it begins and ends, the higher one
  uint64_t spiral = 0;  // TraceMove::spiral

  bool Like(const TravelStep& other) const {
    return kind == other.kind && std::abs(z_mm - other.z_mm) <= kLevelMm && open == other.open &&
           feed == other.feed && spiral == other.spiral &&
           std::abs(filament - other.filament) <= VerifyMachine::kSlack;
  }
};

bool IsNothing(const TraceMove& move) {
  return !move.firmware && move.filament == 0 && move.z_from_mm == move.z_to_mm &&
         move.length_mm() < kShortestStepMm;
}

// What the link to `path` does, without its first `skipped` moves.
std::vector<TravelStep> StepsTo(const TraceChunk& chunk, uint32_t path, uint32_t skipped) {
  std::vector<TravelStep> steps;
  const TraceLink& link = chunk.links[path];
  for (uint32_t m = link.first_move + skipped; m < link.end_move; ++m) {
    const TraceMove& move = chunk.moves[m];
    if (IsNothing(move)) continue;
    const bool wipes = move.kind == MoveKind::kWipe;
    const Micro filament = wipes ? 0 : move.filament;
    const TravelStep step{
        move.kind,  move.z_to_mm,      filament,  move.feed,
        move.open,  move.acceleration, move.line, std::max(move.z_from_mm, move.z_to_mm),
        move.spiral};
    // A travel move may have more bends than before.
    const bool goes_on =
        !steps.empty() && steps.back().Like(step) && steps.back().acceleration == step.acceleration;
    if (move.sideways() && goes_on) continue;
    steps.push_back(step);
  }
  return steps;
}

// How much farther the travel behind unknown lines leads than straight to its path.
double ExcessTo(const TraceChunk& chunk, uint32_t path, double& straight_mm) {
  const TraceLink& link = chunk.links[path];
  double length = 0;
  const TraceMove* first = nullptr;
  for (uint32_t m = link.first_move + link.fixed; m < link.end_move; ++m) {
    const TraceMove& move = chunk.moves[m];
    if (!move.sideways()) continue;
    if (first == nullptr) first = &move;
    length += move.length_mm();
  }
  straight_mm = first == nullptr ? 0 : DistanceOf(first->from, chunk.paths[path].start);
  return length - straight_mm;
}

// No farther than twice as far as straight, and as much as it winds there.
bool Winds(const LayerPair& layer, uint32_t path_was, uint32_t path_is) {
  constexpr double kSlackMm = 2;
  double straight = 0;
  const double had = ExcessTo(layer.was(), path_was, straight);
  const double has = ExcessTo(layer.is(), path_is, straight);
  return has > had + straight + kSlackMm;
}

bool IsTravel(const TravelStep& step) { return step.kind == MoveKind::kTravel; }

bool Goes(const std::vector<TravelStep>& steps) {
  return std::any_of(steps.begin(), steps.end(), IsTravel);
}

bool SameKinds(const std::vector<TravelStep>& was, const std::vector<TravelStep>& is) {
  return std::equal(was.begin(), was.end(), is.begin(), is.end(),
                    [](const TravelStep& a, const TravelStep& b) {
                      return a.kind == b.kind && a.open == b.open;
                    });
}

// The first step of `is` that is not as fast as in `was`; nothing if there is none. REQUIRES: they
// are of the same kinds.
const TravelStep* OtherSpeed(const std::vector<TravelStep>& was,
                             const std::vector<TravelStep>& is) {
  const auto [one, other] = std::mismatch(
      was.begin(), was.end(), is.begin(), [](const TravelStep& a, const TravelStep& b) {
        return a.feed == b.feed && a.acceleration == b.acceleration;
      });
  return one == was.end() ? nullptr : &*other;
}

// The same for spiral lifts.
const TravelStep* OtherSpiral(const std::vector<TravelStep>& was,
                              const std::vector<TravelStep>& is) {
  const auto [one, other] =
      std::mismatch(was.begin(), was.end(), is.begin(),
                    [](const TravelStep& a, const TravelStep& b) { return a.spiral == b.spiral; });
  return one == was.end() ? nullptr : &*other;
}

// Where filament moves alone, its acceleration is that of the path or of the travel.
bool AreAlikeBehindScripts(const TravelStep& a, const TravelStep& b) {
  const bool still = a.kind == MoveKind::kPriming || a.kind == MoveKind::kRetraction;
  return a.Like(b) && (still || a.acceleration == b.acceleration);
}

double ApexOf(const std::vector<TravelStep>& steps) {
  double apex = 0;
  for (const TravelStep& step : steps) {
    if (IsTravel(step)) apex = std::max(apex, step.top_mm);
  }
  return apex;
}

}  // namespace

void CheckScriptedTravels(const LayerPair& layer, LayerFindings& findings) {
  for (size_t i = 0; i < layer.section_count(); ++i) {
    if (layer.Ended()) return;
    const uint32_t was = layer.SectionWas(i).first_path;
    const uint32_t is = layer.SectionIs(i).first_path;
    if (!layer.was().links[was].scripted) continue;
    const uint32_t before = layer.was().LineOf(layer.was().paths[was]);
    const uint32_t behind = layer.is().LineOf(layer.is().paths[is]);
    if (Winds(layer, was, is)) {
      findings.breaks.push_back({VerifyRule::kBounds, before, behind, layer.index(),
                                 "the travel behind unknown lines winds to this path"});
    }
    std::vector<TravelStep> had = StepsTo(layer.was(), was, layer.was().links[was].fixed);
    std::vector<TravelStep> has = StepsTo(layer.is(), is, layer.is().links[is].fixed);
    // To a path that begins where the head is, no way leads.
    if (!Goes(had) || !Goes(has)) {
      std::erase_if(had, IsTravel);
      std::erase_if(has, IsTravel);
    }
    const auto [one, other] =
        std::mismatch(had.begin(), had.end(), has.begin(), has.end(), AreAlikeBehindScripts);
    if (one == had.end() && other == has.end()) continue;
    findings.breaks.push_back(
        {VerifyRule::kScripts, one == had.end() ? before : one->line,
         other == has.end() ? behind : other->line, layer.index(),
         absl::StrFormat("a %s behind unknown lines; the original has another %s there",
                         other == has.end() ? "path" : MoveKindName(other->kind),
                         one == had.end() ? "path" : MoveKindName(one->kind))});
  }
}

namespace {

// What travel between two points does in the original, in the links that lead between the same two.
struct SameEnds {
  double lowest_mm = 1e9;              // of their apexes
  double highest_mm = -1;              // of those with the same kinds of steps; -1: there are none
  const TravelStep* speed = nullptr;   // a step that has another speed in all of these
  const TravelStep* spiral = nullptr;  // and one that is another spiral
};

// The original's travel between two points, however often it is the same.
struct TravelsBetween {
  uint32_t first_link = 0;
  std::vector<std::vector<TravelStep>> travels;
};

uint64_t DigestOf(const std::vector<TravelStep>& steps) {
  uint64_t digest = steps.size();
  for (const TravelStep& step : steps) {
    digest = Mix(digest, static_cast<uint64_t>(step.kind) * 2 + (step.open ? 1 : 0));
    digest = Mix(digest, static_cast<uint64_t>(std::llround(step.top_mm * 1e6)));
    digest = Mix(digest, static_cast<uint64_t>(step.feed));
    digest = Mix(digest, step.acceleration);
    digest = Mix(digest, step.spiral);
  }
  return digest;
}

SameEnds CompareWith(const TravelsBetween& was, const std::vector<TravelStep>& has) {
  SameEnds same;
  bool has_speed = false;
  bool has_spiral = false;
  for (const std::vector<TravelStep>& had : was.travels) {
    same.lowest_mm = std::min(same.lowest_mm, ApexOf(had));
    if (!SameKinds(had, has)) continue;
    same.highest_mm = std::max(same.highest_mm, ApexOf(had));
    same.speed = OtherSpeed(had, has);
    same.spiral = OtherSpiral(had, has);
    has_speed |= same.speed == nullptr;
    has_spiral |= same.spiral == nullptr;
  }
  if (has_speed) same.speed = nullptr;
  if (has_spiral) same.spiral = nullptr;
  return same;
}

void CompareSteps(const LayerPair& layer, const TravelsBetween& was, uint32_t link_is,
                  LayerFindings& findings) {
  const std::vector<TravelStep> has = StepsTo(layer.is(), link_is, 0);
  if (has.empty()) return;
  const SameEnds same = CompareWith(was, has);
  const auto report = [&](VerifyRule rule, uint32_t line, std::string what) {
    findings.breaks.push_back({rule, layer.was().LineOf(layer.was().paths[was.first_link]), line,
                               layer.index(), std::move(what)});
  };
  if (same.speed != nullptr) {
    report(VerifyRule::kSpeeds, same.speed->line,
           absl::StrFormat("%s at F%g; between the same two points the original has another speed "
                           "or acceleration",
                           MoveKindName(same.speed->kind),
                           static_cast<double>(same.speed->feed) * 1e-6));
  }
  if (same.spiral != nullptr) {
    report(VerifyRule::kLifts, same.spiral->line,
           "the spiral lift between these two points has another center or direction in the "
           "original");
  }
  const double apex = ApexOf(has);
  if (apex <= 0 || layer.IsHidden(link_is)) return;
  const bool high = same.highest_mm >= 0 && apex > same.highest_mm + kLevelMm;
  if (!high && apex >= same.lowest_mm - kLevelMm) return;
  report(VerifyRule::kLifts, has.front().line,
         absl::StrFormat("travel at a height of %.3f mm; between the same two points the original "
                         "is at %.3f mm",
                         apex, high ? same.highest_mm : same.lowest_mm));
}

}  // namespace

void CheckSameSteps(const LayerPair& layer, LayerFindings& findings) {
  const TraceChunk& was = layer.was();
  const TraceChunk& is = layer.is();
  absl::flat_hash_map<uint64_t, TravelsBetween> by_ends;
  absl::flat_hash_set<uint64_t> seen;
  // The first link of a chunk follows a path of the chunk before.
  for (uint32_t link = std::max(layer.first_path_was(), 1u); link < layer.end_path_was(); ++link) {
    if (layer.Ended()) return;
    const uint64_t ends = EndsOf(was, link);
    std::vector<TravelStep> steps = StepsTo(was, link, 0);
    if (!seen.insert(Mix(ends, DigestOf(steps))).second) continue;
    TravelsBetween& between = by_ends[ends];
    if (between.travels.empty()) between.first_link = link;
    between.travels.push_back(std::move(steps));
  }
  for (uint32_t link = std::max(layer.first_path_is(), 1u); link < layer.end_path_is(); ++link) {
    if (layer.Ended()) return;
    const auto found = by_ends.find(EndsOf(is, link));
    if (found != by_ends.end()) CompareSteps(layer, found->second, link, findings);
  }
}

}  // namespace traverse::gcode

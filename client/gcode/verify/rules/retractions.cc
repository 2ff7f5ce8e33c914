// A retraction and its prime are a pair that the original has; never deeper, tool by tool; and the
// prime comes where the travel ends. At which height they come follows from the order of steps
// (travel/step_order.cc).

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <tuple>

#include "absl/strings/str_format.h"
#include "client/gcode/verify/match/slacks.h"
#include "client/gcode/verify/rules/rules.h"
#include "client/gcode/verify/text.h"

namespace traverse::gcode {
namespace {

constexpr Micro kGrain = 100;       // pairs this near to each other are the same
constexpr double kShareOdd = 0.01;  // if this share of the original's do something, it is usual
constexpr Micro kOnce = 1'000'000;  // what G10 and G11 count for

class CycleReader {
 public:
  CycleReader(const LayerPair& layer, std::vector<RetractionCycle>& cycles)
      : layer_(layer), cycles_(cycles) {}

  void Read(const TraceChunk& chunk, uint32_t link) {
    const TraceLink& traced = chunk.links[link];
    open_ = false;
    travel_mm_ = 0;
    if (traced.first_move == traced.end_move) return;
    const size_t first = cycles_.size();
    for (uint32_t m = traced.first_move; m < traced.end_move; ++m) {
      const TraceMove& move = chunk.moves[m];
      if (!move.in_print) continue;
      if (move.firmware ? move.kind == MoveKind::kRetraction : move.filament < 0) {
        Pull(move);
      } else if (move.firmware || (open_ && move.filament > 0)) {
        if (!open_) Begin(move);
        Push(move);
      } else if (move.kind == MoveKind::kTravel) {
        travel_mm_ += move.length_mm();
        cycle_.idle = false;
        cycle_.in_parts |= open_ && cycle_.pushed > 0 && move.length_mm() > kLeastMoveMm;
        if (open_) cycle_.known &= layer_.IsKnown(move);
        // What came back before this, came back early.
        if (move.open && move.length_mm() > kLeastMoveMm) {
          const auto length = static_cast<float>(move.length_mm());
          for (size_t i = first; i < cycles_.size(); ++i) cycles_[i].early_mm += length;
          if (open_ && cycle_.pushed > 0) cycle_.early_mm += length;
        }
      }
    }
    if (open_) cycles_.push_back(cycle_);
    if (cycles_.size() > first) cycles_.back().last = true;
    // Two paths that meet have no travel between them, and may yet be separated.
    if (travel_mm_ == 0 && cycles_.size() == first + 1) cycles_[first].idle = false;
    if (!traced.scripted) return;
    // Scripts push filament wherever they want to.
    for (size_t i = first; i < cycles_.size(); ++i) {
      RetractionCycle& cycle = cycles_[i];
      cycle.in_parts = cycle.idle = false;
      cycle.late_mm = cycle.early_mm = 0;
      cycle.pulls = cycle.pushes = 0;
    }
  }

 private:
  void Pull(const TraceMove& move) {
    if (open_ && cycle_.pushed > 0) {
      cycles_.push_back(cycle_);
      open_ = false;
    }
    if (!open_) Begin(move);
    open_ = true;
    cycle_.pulled += move.firmware ? kOnce : -move.filament;
    cycle_.late_mm = static_cast<float>(travel_mm_);
    cycle_.idle &= !move.sideways();
    wipes_ |= move.sideways();
    cycle_.pulls = wipes_ ? 0 : cycle_.pulls + 1;
    Note(move);
  }

  void Note(const TraceMove& move) {
    cycle_.known &= layer_.IsKnown(move);
    cycle_.identity = Mix(cycle_.identity, move.identity);
  }

  void Begin(const TraceMove& move) {
    wipes_ = false;
    cycle_ = RetractionCycle{};
    cycle_.tool = move.tool;
    cycle_.firmware = move.firmware;
    cycle_.known = true;
    cycle_.idle = move.kind == MoveKind::kRetraction;
    cycle_.line = move.line;
    cycle_.layer = layer_.index();
  }

  void Push(const TraceMove& move) {
    ++cycle_.pushes;
    cycle_.firmware |= move.firmware;  // not what the extruder pulled
    cycle_.pushed += move.firmware ? kOnce : move.filament;
    Note(move);
    if (!move.firmware && cycle_.pushed < cycle_.pulled - VerifyMachine::kSlack) return;
    cycles_.push_back(cycle_);
    open_ = false;
  }

  const LayerPair& layer_;
  std::vector<RetractionCycle>& cycles_;
  RetractionCycle cycle_;
  bool open_ = false;
  bool wipes_ = false;
  double travel_mm_ = 0;  // gone in this link without filament
};

struct Pair {
  uint32_t line = 0;
  int64_t count = 0;
  uint32_t pulls = 0;  // the most moves that it was done by
  uint32_t pushes = 0;
};

// Pairs of amounts, on a grid of kGrain.
class PairTable {
 public:
  void Add(const RetractionCycle& cycle) {
    Pair& pair = pairs_[Key(cycle, 0, 0)];
    if (pair.count++ == 0) pair.line = cycle.line;
    pair.pulls = std::max(pair.pulls, cycle.pulls);
    pair.pushes = std::max(pair.pushes, cycle.pushes);
    auto& deepest = deepest_[cycle.tool];
    if (cycle.pulled > deepest.first) deepest = {cycle.pulled, cycle.line};
  }

  bool Has(const RetractionCycle& cycle) const { return Like(cycle).count > 0; }

  // All pairs of these amounts.
  Pair Like(const RetractionCycle& cycle) const {
    Pair all;
    for (const Micro a : {-1, 0, 1}) {
      for (const Micro b : {-1, 0, 1}) {
        const auto found = pairs_.find(Key(cycle, a, b));
        if (found == pairs_.end()) continue;
        all.count += found->second.count;
        all.pulls = std::max(all.pulls, found->second.pulls);
        all.pushes = std::max(all.pushes, found->second.pushes);
      }
    }
    return all;
  }

  bool InMoreParts(const RetractionCycle& cycle) const {
    const Pair like = Like(cycle);
    return cycle.pulls > std::max(like.pulls, 1u) || cycle.pushes > std::max(like.pushes, 1u);
  }

  // The deepest retraction of the tool, and its line.
  std::pair<Micro, uint32_t> Deepest(uint64_t tool) const {
    const auto found = deepest_.find(tool);
    return found == deepest_.end() ? std::pair<Micro, uint32_t>() : found->second;
  }

 private:
  using KeyOf = std::tuple<uint64_t, Micro, Micro, bool>;
  static KeyOf Key(const RetractionCycle& cycle, Micro a, Micro b) {
    return {cycle.tool, cycle.pulled / kGrain + a, cycle.pushed / kGrain + b, cycle.firmware};
  }

  std::map<KeyOf, Pair> pairs_;
  std::map<uint64_t, std::pair<Micro, uint32_t>> deepest_;
};

// If a loop ends at the point where it began, retraction and prime are at one point, and still
// there is travel between the two.
void ForgetNewIdle(const std::vector<RetractionCycle>& was, std::vector<RetractionCycle>& is) {
  absl::flat_hash_set<uint64_t> idle;
  for (const RetractionCycle& cycle : was) {
    if (cycle.idle) idle.insert(cycle.identity);
  }
  for (RetractionCycle& cycle : is) cycle.known &= !cycle.idle || idle.contains(cycle.identity);
}

int64_t CountIdle(const std::vector<RetractionCycle>& cycles) {
  return std::count_if(cycles.begin(), cycles.end(),
                       [](const RetractionCycle& cycle) { return cycle.idle; });
}

// Primings that return all but what rounding takes or adds.
constexpr Micro kRounding = 1'000;

// What these prime more than was retracted, all in all.
struct Balance {
  Micro primed = 0;
  int64_t cycles = 0;
};

Micro SurplusOf(const RetractionCycle& cycle) { return cycle.pushed - cycle.pulled; }

bool Returns(const RetractionCycle& cycle) {
  return !cycle.firmware && std::abs(SurplusOf(cycle)) <= kRounding;
}

Balance BalanceOf(const std::vector<RetractionCycle>& cycles) {
  Balance balance;
  for (const RetractionCycle& cycle : cycles) {
    if (!Returns(cycle)) continue;
    balance.primed += SurplusOf(cycle);
    ++balance.cycles;
  }
  return balance;
}

// Differences that are too small for a pair add up.
void CompareBalance(const Observations& was, const Observations& is, std::vector<Finding>& breaks) {
  constexpr Micro kOfEach = 20;
  const Balance had = BalanceOf(was.cycles);
  const Balance has = BalanceOf(is.cycles);
  const Micro off = has.primed - had.primed;
  const Micro slack = kRounding * (1 + std::abs(has.cycles - had.cycles)) + kOfEach * has.cycles;
  if (std::abs(off) <= slack) return;
  const RetractionCycle* odd = nullptr;  // the one that is off by most
  for (const RetractionCycle& cycle : is.cycles) {
    if (!Returns(cycle)) continue;
    const Micro more = odd == nullptr ? 0 : SurplusOf(cycle) - SurplusOf(*odd);
    if (odd == nullptr || (off > 0 ? more > 0 : more < 0)) odd = &cycle;
  }
  breaks.push_back(
      {VerifyRule::kRetractions, 0, odd == nullptr ? 0 : odd->line, -1,
       absl::StrFormat("primes %.4f mm %s than the original, all in all",
                       static_cast<double>(std::abs(off)) * 1e-6, off > 0 ? "more" : "less")});
}

// What the cycles of the original allow those of the other file.
class RetractionHabits {
 public:
  RetractionHabits(const Observations& was, const Observations& is)
      : cycles_(was.cycles),
        may_be_in_parts_(IsUsual(&RetractionCycle::in_parts)),
        may_be_idle_(IsUsual(&RetractionCycle::idle) &&
                     CountIdle(is.cycles) <= CountIdle(was.cycles)) {
    const bool may_be_early = IsUsual(&RetractionCycle::early_mm);
    for (const RetractionCycle& cycle : cycles_) {
      pairs_.Add(cycle);
      whole_.insert(cycle.identity);
      latest_mm_ = std::max(latest_mm_, cycle.late_mm);
      float& earliest_mm = earliest_mm_[cycle.last ? 1 : 0];
      if (may_be_early) earliest_mm = std::max(earliest_mm, cycle.early_mm);
    }
  }

  // Of moves that the original has one may be missing.
  bool Knows(const RetractionCycle& cycle) const {
    return cycle.known && whole_.contains(cycle.identity);
  }

  // The line of the original with the deepest retraction of the tool.
  uint32_t DeepestLine(uint64_t tool) const { return pairs_.Deepest(tool).second; }

  // What is wrong with a cycle that it does not know; empty if nothing is.
  std::string FaultOf(const RetractionCycle& cycle) const;

 private:
  bool IsUsual(auto RetractionCycle::*odd) const {
    const auto count =
        std::count_if(cycles_.begin(), cycles_.end(),
                      [odd](const RetractionCycle& cycle) { return cycle.*odd > 0; });
    return static_cast<double>(count) > kShareOdd * static_cast<double>(cycles_.size());
  }

  const std::vector<RetractionCycle>& cycles_;
  PairTable pairs_;
  absl::flat_hash_set<uint64_t> whole_;
  const bool may_be_in_parts_, may_be_idle_;
  float latest_mm_ = 0;
  // CuraEngine primes where other travel begins, and retracts again for that: [cycle.last].
  std::array<float, 2> earliest_mm_{};
};

std::string RetractionHabits::FaultOf(const RetractionCycle& cycle) const {
  const double pulled_mm = static_cast<double>(cycle.pulled) * 1e-6;
  const Micro deepest = pairs_.Deepest(cycle.tool).first;
  if (!cycle.firmware && cycle.pulled > deepest + kGrain) {
    return absl::StrFormat("retracts %.4f mm; the most for this tool is %.4f mm", pulled_mm,
                           static_cast<double>(deepest) * 1e-6);
  }
  if (!pairs_.Has(cycle)) {
    return absl::StrFormat(
        "retracts %.4f mm and primes %.4f mm, a pair that the original does not have", pulled_mm,
        static_cast<double>(cycle.pushed) * 1e-6);
  }
  if (cycle.late_mm > latest_mm_ + kLateMm) {
    return absl::StrFormat(
        "retracts after %.2f mm of the travel; the most in the original is %.2f mm", cycle.late_mm,
        latest_mm_);
  }
  if (pairs_.InMoreParts(cycle))
    return "retracts or primes in more parts than the original ever does";
  if (cycle.idle && !may_be_idle_) return "retracts without travel";
  if (cycle.in_parts && !may_be_in_parts_) return "primes in several parts during the travel";
  if (const float earliest_mm = earliest_mm_[cycle.last ? 1 : 0];
      cycle.early_mm > earliest_mm + kSamePointMm) {
    return absl::StrFormat(
        "primes %.2f mm before the travel ends; the most in the original is %.2f mm",
        cycle.early_mm, earliest_mm);
  }
  return "";
}

}  // namespace

void ObserveRetractions(const LayerPair& layer, LayerFindings& findings) {
  CycleReader was(layer, findings.was.cycles);
  for (uint32_t link = layer.first_path_was(); link < layer.end_path_was(); ++link) {
    if (layer.Ended()) return;
    was.Read(layer.was(), link);
  }
  CycleReader is(layer, findings.is.cycles);
  for (uint32_t link = layer.first_path_is(); link < layer.end_path_is(); ++link) {
    if (layer.Ended()) return;
    is.Read(layer.is(), link);
  }
  ForgetNewIdle(findings.was.cycles, findings.is.cycles);
}

void ObserveLastRetraction(const LayerPair& layer, LayerFindings& findings) {
  CycleReader(layer, findings.was.cycles)
      .Read(layer.was(), static_cast<uint32_t>(layer.was().paths.size()));
  CycleReader(layer, findings.is.cycles)
      .Read(layer.is(), static_cast<uint32_t>(layer.is().paths.size()));
}

void CompareRetractions(const Observations& was, const Observations& is,
                        std::vector<Finding>& breaks) {
  CompareBalance(was, is, breaks);
  const RetractionHabits habits(was, is);
  for (const RetractionCycle& cycle : is.cycles) {
    if (habits.Knows(cycle)) continue;
    std::string fault = habits.FaultOf(cycle);
    if (fault.empty()) continue;
    breaks.push_back({VerifyRule::kRetractions, habits.DeepestLine(cycle.tool), cycle.line,
                      cycle.layer, std::move(fault)});
  }
}

}  // namespace traverse::gcode

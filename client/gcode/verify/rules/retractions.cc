// Retraction and what undoes it are a pair that the original has; never deeper, tool by tool; and
// filament comes back where the way ends.

#include <algorithm>
#include <cstdlib>
#include <map>
#include <tuple>

#include "absl/strings/str_format.h"
#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {
namespace {

constexpr double kSidewaysMm = 0.05;
constexpr Micro kGrain = 2'000;       // pairs this near to each other are the same
constexpr double kShareEarly = 0.01;  // so many of the original's come back early: it does that

class CycleReader {
 public:
  CycleReader(const LayerPair& layer, std::vector<RetractionCycle>& cycles)
      : layer_(layer), cycles_(cycles) {}

  void Read(const TraceChunk& chunk, uint32_t link) {
    const TraceLink& traced = chunk.links[link];
    open_ = false;
    const size_t first = cycles_.size();
    for (uint32_t m = traced.first_move; m < traced.end_move; ++m) {
      const TraceMove& move = chunk.moves[m];
      if (!move.in_print) continue;
      if (move.firmware ? move.kind == MoveKind::kRetraction : move.filament < 0) {
        Pull(move);
      } else if (open_ && (move.firmware || move.filament > 0)) {
        Push(move);
      } else if (move.kind == MoveKind::kTravel) {
        if (open_) cycle_.known &= layer_.IsKnown(move);
        // What came back before this, came back early.
        if (move.open && move.length_mm() > kSidewaysMm) {
          for (size_t i = first; i < cycles_.size(); ++i) cycles_[i].early = true;
          if (open_ && cycle_.pushed > 0) cycle_.early = true;
        }
      }
    }
    if (open_) cycles_.push_back(cycle_);
    if (!traced.scripted) return;
    // Scripts push filament wherever they want to.
    for (size_t i = first; i < cycles_.size(); ++i) cycles_[i].early = false;
  }

 private:
  void Pull(const TraceMove& move) {
    if (open_ && cycle_.pushed > 0) {
      cycles_.push_back(cycle_);
      open_ = false;
    }
    if (!open_) cycle_ = {move.tool, 0, 0, move.firmware, false, true, move.line, layer_.index()};
    open_ = true;
    cycle_.pulled -= move.filament;
    cycle_.known &= layer_.IsKnown(move);
  }

  void Push(const TraceMove& move) {
    cycle_.pushed += move.filament;
    cycle_.known &= layer_.IsKnown(move);
    if (!move.firmware && cycle_.pushed < cycle_.pulled - VerifyMachine::kSlack) return;
    cycles_.push_back(cycle_);
    open_ = false;
  }

  const LayerPair& layer_;
  std::vector<RetractionCycle>& cycles_;
  RetractionCycle cycle_;
  bool open_ = false;
};

struct Pair {
  uint32_t line = 0;
  int64_t count = 0;
};

// Pairs of amounts, on a grid of kGrain.
class PairTable {
 public:
  void Add(const RetractionCycle& cycle) {
    Pair& pair = pairs_[Key(cycle, 0, 0)];
    if (pair.count++ == 0) pair.line = cycle.line;
    auto& deepest = deepest_[cycle.tool];
    if (cycle.pulled > deepest.first) deepest = {cycle.pulled, cycle.line};
  }

  bool Has(const RetractionCycle& cycle) const {
    for (const Micro a : {-1, 0, 1}) {
      for (const Micro b : {-1, 0, 1}) {
        if (pairs_.contains(Key(cycle, a, b))) return true;
      }
    }
    return false;
  }

  // How far filament of the tool is pulled back at most, and in which line.
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

}  // namespace

void ObserveRetractions(const LayerPair& layer, LayerFindings& findings) {
  CycleReader was(layer, findings.was.cycles);
  for (uint32_t link = layer.first_path_was(); link < layer.end_path_was(); ++link) {
    was.Read(layer.was(), link);
  }
  CycleReader is(layer, findings.is.cycles);
  for (uint32_t link = layer.first_path_is(); link < layer.end_path_is(); ++link) {
    is.Read(layer.is(), link);
  }
}

void CompareRetractions(const Observations& was, const Observations& is,
                        std::vector<Finding>& breaks) {
  PairTable pairs;
  size_t early = 0;
  for (const RetractionCycle& cycle : was.cycles) {
    pairs.Add(cycle);
    if (cycle.early) ++early;
  }
  const bool may_be_early =
      static_cast<double>(early) > kShareEarly * static_cast<double>(was.cycles.size());
  for (const RetractionCycle& cycle : is.cycles) {
    if (cycle.known) continue;
    const auto [deepest, line] = pairs.Deepest(cycle.tool);
    // A copy of its own: C++20 has lambdas take structured bindings, clang 14 has not.
    const auto report = [&, was_line = line](std::string what) {
      breaks.push_back(
          {VerifyRule::kRetractions, was_line, cycle.line, cycle.layer, std::move(what)});
    };
    if (!cycle.firmware && cycle.pulled > deepest + kGrain) {
      report(absl::StrFormat("pulls %.4f mm back; the most for this tool is %.4f mm",
                             static_cast<double>(cycle.pulled) * 1e-6,
                             static_cast<double>(deepest) * 1e-6));
    } else if (!pairs.Has(cycle)) {
      report(absl::StrFormat("pulls %.4f mm back and pushes %.4f mm, a pair that there is not",
                             static_cast<double>(cycle.pulled) * 1e-6,
                             static_cast<double>(cycle.pushed) * 1e-6));
    } else if (cycle.early && !may_be_early) {
      report("filament comes back before the way is done");
    }
  }
}

}  // namespace traverse::gcode

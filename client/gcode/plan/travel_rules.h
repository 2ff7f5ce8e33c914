// Whether the slicer would retract for a travel move, learned from where it did in the file.

#ifndef TRAVERSE_CLIENT_GCODE_PLAN_TRAVEL_RULES_H_
#define TRAVERSE_CLIENT_GCODE_PLAN_TRAVEL_RULES_H_

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "absl/types/span.h"
#include "client/gcode/hidden/hidden_moves.h"
#include "client/gcode/model/outline.h"
#include "client/gcode/model/visible_walls.h"
#include "client/gcode/plan/detour.h"
#include "client/gcode/plan/policy.h"

namespace traverse::gcode {

// How often moves retracted that were long enough for it and crossed no visible wall.
struct RetractionCount {
  int64_t retracted = 0;
  int64_t not_retracted = 0;

  int64_t total() const { return retracted + not_retracted; }

  // An unneeded retraction costs time; a missing one costs quality.
  bool Mostly() const { return retracted * 2 >= not_retracted; }
};

// [feature of the path at the end of the move]
using RetractionCounts = std::array<RetractionCount, static_cast<size_t>(Feature::kCount)>;

// What applies to a whole file.
struct RetractionHabit {
  bool retracts = false;          // the file has retractions at all
  double threshold_mm = 0;        // shorter moves do not retract
  bool crossing_matters = false;  // moves that cross no visible wall often do not retract
  RetractionCounts inside;
  RetractionCount all_inside;  // to inner walls and infill

  // Travel leads around visible walls.
  bool avoids_walls = false;

  // Moves longer than this, and than the threshold, retract whatever they cross: an unretracted one
  // much longer than all in the file would ooze.
  double longest_open_mm = 1e9;

  // Requested, not learned: a new move across a visible wall retracts however short it is, so that
  // no layer has more unretracted crossings than the file.
  bool spares_walls = false;

  // Requested: new moves after a path that the file wipes do without the wipe where they would not
  // retract if there were none.
  bool drops_wipes = false;

  // Requested: moves that it hides do without a retraction, a lift and a wipe. Null: none do.
  std::shared_ptr<const HiddenMoves> hidden;

  // Requested: moves that are not hidden are led around walls where that hides them.
  bool inner_detours = false;
};

// Examines about two dozen layers spread over the file. The threshold is the slicer's setting if
// the file has it. Otherwise it is the shortest move that retracted, but at most the usual 1.5 mm
// if straight moves across visible walls retracted whenever they were longer than that. If no
// travel of the part is open, all travel moves are long enough: nothing shows how to write open
// ones.
RetractionHabit LearnRetraction(const GcodeFile& file);

// LearnRetraction, and what new moves must obey under every policy, or may do by `allow`. `hidden`:
// the file's, if they are known; else they are found where they are needed.
RetractionHabit HabitOfNewTravels(const GcodeFile& file, const Allowance& allow = {},
                                  int threads = 1,
                                  std::shared_ptr<const HiddenMoves> hidden = nullptr);

// A new travel move as it is written.
struct PlannedTravel {
  Point from;
  Point to;
  bool retracts = false;
  bool crosses = false;    // a visible wall, and there is no detour
  double mm = 0;           // including bends
  std::vector<Point> via;  // its bends, around walls; empty: straight
};

// The same for one layer: top and bottom layers often retract where others do not.
class TravelRules {
 public:
  // `outlines` and `walls` belong to `layer`; `habit` and `walls` must outlive the rules.
  TravelRules(const GcodeFile& file, const Layer& layer, const RetractionHabit& habit,
              const std::vector<Outline>& outlines, const VisibleWalls& walls);

  // How to write the move from `a` to `b`, where a path of `feature` begins.
  PlannedTravel TravelOf(Point a, Point b, Feature feature) const;

  // Whether nobody can see the straight move from `a`, where the head really leaves the path
  // before, to `b`, where a path of `feature` begins, and it may do without a retraction for that.
  // None is hidden that leads to a visible wall.
  bool Hides(Point a, Point b, Feature feature) const;

  // The same of a move with bends, by all its points. REQUIRES: there are two at the least.
  bool Hides(absl::Span<const Point> line, Feature feature) const;

  // The bends by which the same move is hidden where the straight one is not; empty if there are
  // none, and where none are to be.
  std::vector<Point> HiddenBends(Point a, Point b, Feature feature) const;

  // Whether moves to paths of `feature` always retract, as far as the file shows.
  // REQUIRES: habit.crossing_matters, as otherwise all of them do, or none.
  bool AlwaysRetracts(Feature feature) const;

 private:
  const RetractionCount& CountOf(Feature feature) const;

  const RetractionHabit& habit_;
  const VisibleWalls& walls_;
  const size_t layer_;
  const std::optional<Detours> detours_;  // if the file makes detours
  const std::optional<Detours> within_;   // of hidden moves, if they may make any
  RetractionCounts inside_;
  RetractionCount all_inside_;  // to inner walls and infill
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_PLAN_TRAVEL_RULES_H_

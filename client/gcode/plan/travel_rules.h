// Whether the slicer would pull filament back for a way, learnt from where it did in the file.

#ifndef TRAVERSE_CLIENT_GCODE_PLAN_TRAVEL_RULES_H_
#define TRAVERSE_CLIENT_GCODE_PLAN_TRAVEL_RULES_H_

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "client/gcode/model/outline.h"
#include "client/gcode/model/visible_walls.h"
#include "client/gcode/plan/detour.h"
#include "client/gcode/plan/policy.h"

namespace traverse::gcode {

// How often ways were retracted that were long enough for it and crossed no visible wall.
struct RetractionCount {
  int64_t retracted = 0;
  int64_t not_retracted = 0;

  int64_t total() const { return retracted + not_retracted; }

  // To retract where the slicer would not costs time; not to where it would costs quality.
  bool Mostly() const { return retracted * 2 >= not_retracted; }
};

// [feature of the path that is gone to]
using RetractionCounts = std::array<RetractionCount, static_cast<size_t>(Feature::kCount)>;

// What holds in a whole file.
struct RetractionHabit {
  bool retracts = false;          // the file has retractions at all
  double threshold_mm = 0;        // shorter ways are not retracted
  bool crossing_matters = false;  // ways that cross no visible wall are often not retracted
  RetractionCounts inside;

  // Travel is led around visible walls.
  bool avoids_walls = false;

  // Longer ways, beyond the threshold, are retracted whatever they cross: an open one that is much
  // longer than all of the file would ooze.
  double longest_open_mm = 1e9;

  // Not learnt but asked for: for a new way across a visible wall filament is pulled back however
  // short the way is, so that no layer has more such ways with an open nozzle than the file.
  bool spares_walls = false;
};

// Looks at some two dozen layers spread over the file. The threshold is the slicer's setting if the
// file holds it; else the shortest way that was retracted, but no more than the usual 1.5 mm if
// straight ways across visible walls were retracted whenever they were longer than that.
RetractionHabit LearnRetraction(const GcodeFile& file);

// LearnRetraction, and what new ways have to keep to under every policy.
RetractionHabit HabitOfNewWays(const GcodeFile& file);

// A new way as it is written.
struct TravelWay {
  Vertex from;
  Vertex to;
  bool retracts = false;
  bool crosses = false;     // a visible wall, and there is no way around
  bool grazes = false;      // a visible wall with one of its bends
  double mm = 0;            // bends included
  std::vector<Vertex> via;  // the bends of the way around visible walls; empty: it is straight
};

// The same for one layer: top and bottom layers are often retracted where others are not.
class TravelRules {
 public:
  // `outlines` and `walls` are those of `layer`; `habit` and `walls` outlive the rules.
  TravelRules(const GcodeFile& file, const Layer& layer, const RetractionHabit& habit,
              const std::vector<Outline>& outlines, const VisibleWalls& walls);

  // Whether to pull back for the way from `a` to `b`, where a path of `feature` begins.
  bool Retracts(Vertex a, Vertex b, Feature feature) const;

  // How the way is written for which it says whether to retract.
  TravelWay WayOf(Vertex a, Vertex b, Feature feature) const;

  // Whether the file shows that ways to paths of `feature` are retracted wherever they lead.
  bool AlwaysRetracts(Feature feature) const;

  // Where new ways are led around visible walls; null if the file's are not.
  const Detours* detours() const { return detours_ ? &*detours_ : nullptr; }

 private:
  const RetractionCount& CountOf(Feature feature) const;

  const RetractionHabit& habit_;
  const VisibleWalls& walls_;
  const std::optional<Detours> detours_;  // if the file has any
  RetractionCounts inside_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_PLAN_TRAVEL_RULES_H_

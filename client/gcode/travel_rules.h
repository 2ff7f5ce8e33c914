// Whether the slicer would pull filament back for a way, learnt from where it did in the file.

#ifndef TRAVERSE_CLIENT_GCODE_TRAVEL_RULES_H_
#define TRAVERSE_CLIENT_GCODE_TRAVEL_RULES_H_

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "client/gcode/outline.h"
#include "client/gcode/segment_grid.h"

namespace traverse::gcode {

// How often ways were retracted that were long enough for it.
struct RetractionCount {
  int64_t retracted = 0;
  int64_t not_retracted = 0;

  // Retracting where the slicer would not costs time, not retracting where it would costs quality.
  bool Mostly() const { return retracted * 4 >= not_retracted; }
};

// What holds in a whole file.
struct RetractionHabit {
  bool retracts = false;          // the file has retractions at all
  double threshold_mm = 0;        // shorter ways are not retracted
  bool crossing_matters = false;  // ways that cross no visible wall are often not retracted

  // [feature of the path that is gone to] ways beyond the threshold that cross no visible wall.
  std::array<RetractionCount, static_cast<size_t>(Feature::kCount)> inside;
};

// The visible walls of one layer.
class VisibleWalls {
 public:
  explicit VisibleWalls(const std::vector<Outline>& outlines);

  // True if the straight way from `a` to `b` crosses one. Ends that lie on a wall do not.
  bool Crossed(Vertex a, Vertex b) const;

 private:
  SegmentGrid grid_;
};

// `threshold_mm` as in TravelModel. Looks at some two dozen layers spread over the file.
RetractionHabit LearnRetraction(const GcodeFile& file, double threshold_mm);

// The same for one layer.
class TravelRules {
 public:
  TravelRules(const RetractionHabit& habit, const std::vector<Outline>& outlines);

  // Whether to pull back for the straight way from `a` to `b`, where a path of `feature` begins.
  bool Retracts(Vertex a, Vertex b, Feature feature) const;

 private:
  const RetractionHabit& habit_;
  std::unique_ptr<const VisibleWalls> walls_;  // null if they do not matter
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_TRAVEL_RULES_H_

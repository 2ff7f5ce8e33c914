// What rounding leaves open, what is too short to tell anything, and what is usual: the same for
// all rules.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_SLACKS_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_SLACKS_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace traverse::gcode {

// Points and heights no farther apart are the same, but for rounding.
inline constexpr double kSamePointMm = 0.02;
inline constexpr double kHeightSlackMm = 0.003;

// The same of heights, and of slopes in 10 mm, in whole micrometres.
inline constexpr int64_t kSlackUm = 2;

// Points whose words are the same numbers, in whatever unit.
inline constexpr double kSameSpotMm = 1e-5;

// What lies so near to a path lies on it.
inline constexpr double kOnPathMm = 0.05;

// Of the moves behind a path so many may go along it: more than slicers write.
inline constexpr size_t kMostAlong = 1000;

// Shorter moves come from rounding; shorter travel tells nothing of what travel does.
inline constexpr double kLeastMoveMm = 0.05;
inline constexpr double kLeastTravelMm = 0.5;

// How far travel goes with an open nozzle to leave a path: the shortest such move, the longest one,
// and by how much it may be longer than the original's before it retracts.
inline constexpr double kLeastDepartureMm = 0.015;
inline constexpr double kLongestDepartureMm = 1.25;
inline constexpr double kLateMm = 0.25;

// Where a new path's place alone makes travel longer, or lead farther.
inline constexpr double kLooseMm = 2;

// What nearly all do; and how many of a layer tell what they do.
inline constexpr double kUsualShare = 0.99;
inline constexpr int kFewestOfLayer = 4;

// The value that kUsualShare of them do not exceed; 0 if there are none.
inline float UsualOf(std::vector<float> values) {
  if (values.empty()) return 0;
  const auto at = values.begin() +
                  static_cast<std::ptrdiff_t>(kUsualShare * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// Whether travel is longer than that of its kind tells anything about. Where slicers go by what
// travel crosses, travel that crosses nothing may become a little longer.
inline bool IsMuchLonger(float mm, float known_mm) {
  constexpr float kFactor = 2;
  constexpr float kMoreMm = 1;
  return mm > known_mm * kFactor + kMoreMm;
}

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_SLACKS_H_

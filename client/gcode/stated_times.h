// The print times that slicers state in G-code: in comments of head and foot, and in M73.

#ifndef TRAVERSE_CLIENT_GCODE_STATED_TIMES_H_
#define TRAVERSE_CLIENT_GCODE_STATED_TIMES_H_

#include <optional>
#include <string>
#include <string_view>

namespace traverse::gcode {

// How print times change: factors, above 0.
struct TimeScale {
  double total = 1;
  double first_layer = 1;

  friend bool operator==(const TimeScale&, const TimeScale&) = default;
};

// Where in `text` the line begins that Traverse added (verify/verifier.h); npos if there is none.
size_t FindMark(std::string_view text);

// `scale` as it is written into the line that is added to a file, "times restated x0.973412, first
// layer x0.991002", and rounded to what is written there.
std::string DescribeScale(const TimeScale& scale);
TimeScale RoundScale(const TimeScale& scale);

// The scale that DescribeScale wrote into the line of `text` that Traverse added; nothing if there
// is none.
std::optional<TimeScale> StatedScale(std::string_view text);

// `seconds` or a duration such as "1h 2m 3s" (also with d) in `value`, scaled, in the same form;
// nothing if it is neither.
std::optional<std::string> ScaleDuration(std::string_view value, double factor);

// `text` with all the times scaled that it states: totals and first layers in comments (of
// PrusaSlicer and its kin, Bambu Studio, CuraEngine, ideaMaker), remaining minutes in M73; the
// percentages of M73 stay. Each line is changed by itself.
std::string RestateTimes(std::string_view text, const TimeScale& scale);

// `text`, which has the line that Traverse adds, with all times restated, which that line says
// then.
std::string RestateOptimised(std::string_view text, const TimeScale& scale);

// The scaled value of the metadata entry `key`, if it is one of a print time.
std::optional<std::string> RestateEntry(std::string_view key, std::string_view value,
                                        const TimeScale& scale);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_STATED_TIMES_H_

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

// Where the line that Traverse added begins in `text` (verify/verifier.h); npos if there is none.
size_t FindMark(std::string_view text);

// `scale` in the form in which the added line states it, "times restated x0.973412, first layer
// x0.991002", and rounded to what that says.
std::string DescribeScale(const TimeScale& scale);
TimeScale RoundScale(const TimeScale& scale);

// The scale that DescribeScale wrote into the added line of `text`; unset if there is
// none.
std::optional<TimeScale> StatedScale(std::string_view text);

// `value` scaled, in the same form: seconds, or a duration such as "1h 2m 3s" (also with d). Unset
// if it is neither.
std::optional<std::string> ScaleDuration(std::string_view value, double factor);

// `text` with all stated times scaled: totals and first layers in comments (of PrusaSlicer and its
// relatives, Bambu Studio, CuraEngine, ideaMaker), remaining minutes in M73, times that messages
// tell; the percentages of M73 stay. Each line is changed by itself.
std::string RestateTimes(std::string_view text, const TimeScale& scale);

// `text`, which has the line that Traverse adds, with all times restated; the line then says
// so.
std::string RestateOptimised(std::string_view text, const TimeScale& scale);

// The scaled value of the metadata entry `key`, if that is a print time.
std::optional<std::string> RestateEntry(std::string_view key, std::string_view value,
                                        const TimeScale& scale);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_STATED_TIMES_H_

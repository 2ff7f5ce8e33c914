// Which path of the original each path of the other file is, from where and in which direction.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_VISITS_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_VISITS_H_

#include <cstdint>
#include <vector>

#include "client/gcode/verify/trace/trace.h"
#include "client/gcode/work_limit.h"

namespace traverse::gcode {

// Of equal segments so many are examined, to find which one was meant.
inline constexpr uint32_t kMostEqual = 16;

// One path of the original, as it is in the other file.
struct Visit {
  uint32_t path = 0;      // of the original
  uint32_t entry = 0;     // the segment with which it begins, from 0 in the path
  uint32_t segments = 0;  // that follow one another
  bool forward = true;
  uint32_t first_path = 0;  // of the other file: where it begins,
  uint32_t last_path = 0;   // and, if it was cut in two, where it ends
  uint32_t first_segment = 0;
  uint32_t last_segment = 0;
};

// A path that ends this close to its start is a closed loop: slicers leave a gap of 0.15 widths of
// the nozzle or of the line. How wide a line is follows from its filament; the thicker kind of
// filament is assumed.
double LoopGapMm(const TraceChunk& chunk, uint32_t path);

bool IsClosed(const TraceChunk& chunk, uint32_t path);

// The visits of the section `was` of `original` in section `is` of `optimised`, in the order of the
// latter. A loop that begins elsewhere is one visit. A path that was cut in two is several, none
// with all its segments. REQUIRES: the sections have the same deposits.
std::vector<Visit> FindVisits(const TraceChunk& original, const TraceSection& was,
                              const TraceChunk& optimised, const TraceSection& is,
                              const WorkLimit& limit = {});

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_VISITS_H_

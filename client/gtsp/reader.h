// Reads GTSPLIB's files: symmetric instances of the generalised travelling salesman problem in the
// plane.
//
//   NAME: 4small10
//   TYPE: GTSP
//   DIMENSION: 10                  points
//   GTSP_SETS: 4
//   EDGE_WEIGHT_TYPE: EUC_2D
//   NODE_COORD_SECTION             a line a point: number, x, y
//   1 37 52
//   GTSP_SET_SECTION:              number of a set, its points, -1; may go on over several lines
//   1 3 10 -1
//   EOF                            may be missing
//
// Source: Fischetti, Salazar and Toth (1997), in the syntax of TSPLIB 95 (Reinelt). One pass,
// linear in the text.

#ifndef TRAVERSE_CLIENT_GTSP_READER_H_
#define TRAVERSE_CLIENT_GTSP_READER_H_

#include <cstddef>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "client/input/input_job.h"

namespace traverse {

// Most points in all layers of one file: the points of the smallest set times all
// points.
inline constexpr size_t kMostGtspPoints = 1'000'000;

// The job in `text`, with InputJob::gtsp. Coordinates are taken as mm.
//
// The service's routes are open. So a closed tour is a layer that begins at a point of the smallest
// set, visits the other sets in any order (each a contour that may be entered at any of its
// points), and ends with a contour of the one point where it began. There is a layer for each point
// of the smallest set, with that point's number as its id; the shortest layer is the tour. The ids
// of contours are the numbers of their sets.
//
// InvalidArgument with name and line for the first fault: `a.gtsp:12: point 3 is in set 1 and in
// set 2`.
absl::StatusOr<InputJob> ReadGtsp(std::string_view text, const std::string& name);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_GTSP_READER_H_

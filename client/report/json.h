// The document of --json.

#ifndef TRAVERSE_CLIENT_REPORT_JSON_H_
#define TRAVERSE_CLIENT_REPORT_JSON_H_

#include <string>
#include <vector>

#include "client/gcode/rewrite.h"
#include "client/input/input_job.h"
#include "client/report/run.h"

namespace traverse::report {

// One job's routes, as scripts rely on them:
//   {"input": "...", "strategy": "auto", "seed": 1,
//    "total": {"travel_given_mm": , "travel_mm": , "cleaning_mm": , "lower_bound_mm": null,
//              "solve_seconds": , "wall_seconds": , "idle_seconds_given": , "idle_seconds": },
//    "layers": [{"id": 1, "start": [x, y], "travel_given_mm": , "travel_mm": ,
//                "lower_bound_mm": null, "stop": "LOCAL_OPTIMUM", "solve_seconds": ,
//                "route": [{"kind": "contour", "island": 1, "id": 1, "entry": 17},
//                          {"kind": "raster", "island": 1, "id": 1, "reversed": false}]}]}
// Lengths in mm, written so that reading them gives the same double. total.travel_mm and
// travel_given_mm include the moves to the cleaning point. Bounds are stated where the cost is
// length and the bound of each layer is known. Where the strategy's option `chain_bound` found
// one, "total" ends with "chain_lower_bound_mm", a bound of all layers together without moves to
// the cleaning point. Ids are the labels of the file; of a layer that is a plan each visit also has
// "path", the position of its path in the plan, and "island" only if it is known. The same job and
// routes give the same bytes, but for the seconds. One layer is one line.
// REQUIRES: the result passed CheckVisits.
//
// With `rewrite`, what became of the G-code stands behind "total", measured in the two files:
//   "gcode": {"layers_changed": 12,
//             "island_rest": {"enough_seconds": , "least_given_seconds": , "least_seconds": },
//             "given": {"travel_mm": , "extruded_mm": , "retractions": , "crossings": ,
//                       "open_crossings": , "print_seconds": },
//             "written": {...}}
// Of a GTSPLIB instance the closed tour (client/gtsp/tour.h) stands there, in the file's numbers:
//   "tour": {"rounded_length": 174, "points": [22, 3, ...]}
// Crossings are travel moves across visible walls, open ones those with filament not pulled back.
std::string RoutesJson(const InputJob& job, const JobRun& run,
                       const GcodeRewrite* rewrite = nullptr);

// Several strategies' routes of one job, each document as above:
//   {"input": "...", "runs": [{"label": "ni2opt:point_release=false", "seed": 1, "routes": {...}}]}
std::string CompareJson(const InputJob& job, const std::vector<ComparedStrategy>& strategies);

// "LOCAL_OPTIMUM".
std::string StopName(v1::StopReason reason);

}  // namespace traverse::report

#endif  // TRAVERSE_CLIENT_REPORT_JSON_H_

// A small job and what a run made of it.

#ifndef TRAVERSE_TESTS_CLIENT_REPORT_SMALL_RUN_H_
#define TRAVERSE_TESTS_CLIENT_REPORT_SMALL_RUN_H_

#include "client/formats/read_input.h"
#include "client/report/json.h"
#include "client/report/numbers.h"
#include "client/report/summary.h"
#include "client/report/table.h"
#include "tests/support/golden.h"

namespace traverse::report {

// A job of one layer of islands and one plan, with notes.
inline InputJob SmallJob() {
  InputJob job = *ReadInput(testing::DataPath("damat/two_islands.damat"));
  job.name = "dir/\"odd\" \xff.damat";
  job.layers.resize(1);
  v1::Layer& plan = job.layers.emplace_back();
  plan.set_id(8);
  v1::Contour& contour = *plan.mutable_plan()->add_paths()->mutable_contour();
  contour.set_id(3);
  contour.add_points(0);
  contour.add_points(0);
  v1::OpenPath& open = *plan.mutable_plan()->add_paths()->mutable_open_path();
  open.set_id(4);
  for (const double value : {1.0, 2.5, 8.0, 8.0, 3.0, 4.0}) open.add_points(value);
  job.facts = {{"slicer", "none"}, {"longer than the rest", "1"}};
  job.notes = {{}, {{0, 1}, {5, 6}}};
  return job;
}

inline void AddVisit(v1::LayerResult& layer, uint32_t island, bool contour, uint32_t path,
                     uint32_t entry) {
  v1::Visit& visit = *layer.add_visits();
  visit.set_island(island);
  if (contour) {
    visit.set_contour(path);
    visit.set_vertex(entry);
  } else {
    visit.set_raster(path);
    visit.set_reversed(entry != 0);
  }
}

inline JobRun SmallRun() {
  JobRun run;
  run.seed = 18446744073709551615u;
  run.wall_seconds = 1.5;
  v1::LayerResult& islands = run.result.layers.emplace_back();
  AddVisit(islands, 1, true, 0, 0);
  AddVisit(islands, 0, true, 1, 2);
  AddVisit(islands, 0, true, 0, 3);
  AddVisit(islands, 0, false, 1, 1);
  AddVisit(islands, 0, false, 0, 0);
  islands.mutable_start()->set_x_mm(0.1);
  islands.mutable_given()->set_total_mm(100);
  islands.mutable_travel()->set_total_mm(1.0 / 3);
  islands.set_lower_bound(0.25);
  islands.set_stop_reason(v1::STOP_REASON_OPTIMAL);
  islands.set_solve_seconds(0.125);
  v1::LayerResult& plan = run.result.layers.emplace_back();
  plan.add_visits()->set_plan_path(1);
  plan.mutable_visits(0)->set_reversed(true);
  plan.add_visits()->set_plan_path(0);
  plan.mutable_visits(1)->set_vertex(0);
  plan.set_lower_bound(0.5);
  plan.set_stop_reason(v1::STOP_REASON_TIME_LIMIT);
  v1::JobSummary& summary = run.result.summary;
  summary.set_strategy("exact");
  summary.mutable_given()->set_total_mm(200);
  summary.mutable_given()->set_contours_mm(150);
  summary.mutable_travel()->set_total_mm(150);
  summary.mutable_travel()->set_contours_mm(90);
  summary.mutable_travel()->set_rasters_mm(50);
  summary.mutable_travel()->set_links_mm(10);
  summary.set_cleaning_mm(10);
  summary.set_cleaning_given_mm(20);
  summary.set_cost(150);
  summary.set_lower_bound(120);
  summary.set_idle_seconds_given(11);
  summary.set_idle_seconds(8);
  summary.set_compute_seconds(2.5);
  v1::StopCount& stop = *summary.add_stops();
  stop.set_stop_reason(v1::STOP_REASON_OPTIMAL);
  stop.set_layers(1);
  return run;
}

inline TextStyle Page(int width) {
  TextStyle style;
  style.width = width;
  return style;
}

}  // namespace traverse::report

#endif  // TRAVERSE_TESTS_CLIENT_REPORT_SMALL_RUN_H_

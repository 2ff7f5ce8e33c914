// The thesis's figures of our runs, as one page of HTML with drawings in SVG.

#ifndef TRAVERSE_CLIENT_REPORT_REPRODUCE_FIGURES_PAGE_H_
#define TRAVERSE_CLIENT_REPORT_REPRODUCE_FIGURES_PAGE_H_

#include <map>
#include <string>

#include "client/report/reproduce/run_plan.h"
#include "client/report/reproduce/thesis_tables.h"
#include "traverse/v1/plan.pb.h"

namespace traverse::report {

// `layers`: the first layer of each part of the thesis that is to be drawn. `tables` is printed at
// the end as it is. What was not run is left out.
std::string FiguresPage(const ReproduceForm& form, const OutcomeOfRun& outcome,
                        const std::map<std::string, v1::Layer>& layers, const std::string& tables);

}  // namespace traverse::report

#endif  // TRAVERSE_CLIENT_REPORT_REPRODUCE_FIGURES_PAGE_H_

// The thesis's figures for our runs, as one HTML page with drawings in SVG.

#ifndef TRAVERSE_CLIENT_REPORT_REPRODUCE_FIGURES_PAGE_H_
#define TRAVERSE_CLIENT_REPORT_REPRODUCE_FIGURES_PAGE_H_

#include <map>
#include <string>

#include "client/report/reproduce/run_plan.h"
#include "client/report/reproduce/thesis_tables.h"
#include "traverse/v1/plan.pb.h"

namespace traverse::report {

// `layers`: the first layer of each part of the thesis to draw. Prints `tables` unchanged at the
// end. Leaves out what was not run.
std::string FiguresPage(const ReproduceForm& form, const OutcomeOfRun& outcome,
                        const std::map<std::string, v1::Layer>& layers, const std::string& tables);

}  // namespace traverse::report

#endif  // TRAVERSE_CLIENT_REPORT_REPRODUCE_FIGURES_PAGE_H_

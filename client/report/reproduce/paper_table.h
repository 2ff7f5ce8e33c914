// Table 1 of Souza et al. (2017): ours beside the paper's own.

#ifndef TRAVERSE_CLIENT_REPORT_REPRODUCE_PAPER_TABLE_H_
#define TRAVERSE_CLIENT_REPORT_REPRODUCE_PAPER_TABLE_H_

#include <string>

#include "client/report/reproduce/run_plan.h"
#include "client/report/reproduce/thesis_tables.h"

namespace traverse::report {

// Gains of Método 3 over Métodos 1 and 2, for each part and cleaning frequency, and their means.
std::string PaperTable(const ReproduceForm& form, const OutcomeOfRun& outcome);

}  // namespace traverse::report

#endif  // TRAVERSE_CLIENT_REPORT_REPRODUCE_PAPER_TABLE_H_

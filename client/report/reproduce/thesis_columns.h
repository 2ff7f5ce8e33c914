// The methods that Weller (2019) compares: the columns of table 5.2.

#ifndef TRAVERSE_CLIENT_REPORT_REPRODUCE_THESIS_COLUMNS_H_
#define TRAVERSE_CLIENT_REPORT_REPRODUCE_THESIS_COLUMNS_H_

#include <string>
#include <vector>

#include "client/report/reproduce/run_plan.h"

namespace traverse::report {

// One column, and how to run it.
struct ThesisColumn {
  std::string title;
  std::string method;
  bool programme = false;
  bool samples = false;  // one run per seed
};

std::vector<ThesisColumn> ThesisColumns(const ReproduceForm& form);

}  // namespace traverse::report

#endif  // TRAVERSE_CLIENT_REPORT_REPRODUCE_THESIS_COLUMNS_H_

#include "client/report/reproduce/thesis_columns.h"

#include "absl/strings/str_format.h"

namespace traverse::report {

std::vector<ThesisColumn> ThesisColumns(const ReproduceForm& form) {
  std::vector<ThesisColumn> columns = {
      {"NO", "none"}, {"Guloso", GreedyMethod()}, {"NI2OPT", Ni2optMethod()}};
  for (const char* name : {"sp", "nrp", "bbcp"}) {
    const std::string title = name == std::string("sp")    ? "MILP SP"
                              : name == std::string("nrp") ? "MILP NRP"
                                                           : "MILP BBCP";
    columns.push_back({title, MilpMethodName(name, true, form), true});
  }
  for (const char* name : {"nrp", "bbcp"}) {
    for (const int diversifications : form.diversifications) {
      columns.push_back({absl::StrFormat("BT %s %d", name == std::string("nrp") ? "NRP" : "BBCP",
                                         diversifications),
                         TabuMethodName(name, diversifications), false, true});
    }
  }
  return columns;
}

}  // namespace traverse::report

// Which runs the tables of the two sources need.

#ifndef TRAVERSE_CLIENT_REPORT_REPRODUCE_RUN_PLAN_H_
#define TRAVERSE_CLIENT_REPORT_REPRODUCE_RUN_PLAN_H_

#include <cstdint>
#include <string>
#include <vector>

namespace traverse::report {

// How much to run.
struct ReproduceForm {
  int thesis_layers = 5;
  int paper_layers = 393;
  int seeds = 5;           // thesis table 3.2
  int first_samples = 10;  // the same, before the sample size was known
  int diversifications[2] = {2500, 5000};
  double programme_seconds = 7200;  // thesis table 4.1; each of steps 2 and 4
  std::vector<std::string> paper_parts = {"part1",     "part2",        "part3",    "s3_bracket",
                                          "s4_grille", "s5_islands40", "s6_gears", "s7_text"};

  // For three minutes on two cores.
  static ReproduceForm Short();
};

// One run: a method on a part.
struct PlannedRun {
  std::string part;    // "part2"
  std::string method;  // as --strategies takes it
  uint64_t seed = 1;
  int layers = 5;
  int cleaning_every = 0;  // 0: none

  // Identifies this run: "part2 tabu:thesis seed=3 layers=5".
  std::string Key() const;
};

// The methods, as --strategies takes them.
std::string GreedyMethod();   // Metodo 1, "Guloso"
std::string Ni2optMethod();   // Metodo 2, "NI2OPT"
std::string ReleaseMethod();  // Metodo 3
std::string MilpMethodName(const std::string& representation, bool cold, const ReproduceForm& form);
std::string TabuMethodName(const std::string& representation, int diversifications);

inline constexpr const char* kThesisParts[3] = {"part1", "part2", "part3"};

// For the thesis's tables: each method on each part with each seed.
PlannedRun ThesisRun(const std::string& part, const std::string& method, int seed,
                     const ReproduceForm& form);
// For table 3.2: one layer of part 2.
PlannedRun SampleRun(int diversifications, int seed);
// For the paper's table, with a cleaning every `cleaning_every` layers; 0: none.
PlannedRun PaperRun(const std::string& part, const std::string& method, int cleaning_every,
                    const ReproduceForm& form);

// The frequencies of the paper's table; the last one stands for "none" there too.
inline constexpr int kCleanings[3] = {2, 10, 0};

// All runs for a source's tables, the quick ones first.
std::vector<PlannedRun> ThesisRuns(const ReproduceForm& form);
std::vector<PlannedRun> PaperRuns(const ReproduceForm& form);

}  // namespace traverse::report

#endif  // TRAVERSE_CLIENT_REPORT_REPRODUCE_RUN_PLAN_H_

#include "client/report/reproduce/run_plan.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace traverse::report {

ReproduceForm ReproduceForm::Short() {
  ReproduceForm form;
  form.paper_layers = 20;
  form.seeds = 3;
  form.first_samples = 5;
  form.diversifications[0] = 250;
  form.diversifications[1] = 500;
  form.programme_seconds = 0.4;
  return form;
}

std::string PlannedRun::Key() const {
  return absl::StrFormat("%s %s seed=%d layers=%d cleaning=%d", part, method, seed, layers,
                         cleaning_every);
}

std::string GreedyMethod() { return "greedy:pure"; }
std::string Ni2optMethod() { return "ni2opt:pure:point_release=false"; }
std::string ReleaseMethod() { return "ni2opt:pure"; }

std::string MilpMethodName(const std::string& representation, bool cold,
                           const ReproduceForm& form) {
  return absl::StrFormat("exact:model=framework:start=%s:representation=%s:time_limit=%g:trace",
                         cold ? "none" : "ni2opt", representation, form.programme_seconds);
}

std::string TabuMethodName(const std::string& representation, int diversifications) {
  return absl::StrFormat("tabu:thesis:representation=%s:diversifications=%d:trace", representation,
                         diversifications);
}

PlannedRun ThesisRun(const std::string& part, const std::string& method, int seed,
                     const ReproduceForm& form) {
  return {part, method, static_cast<uint64_t>(seed), form.thesis_layers, 0};
}

PlannedRun SampleRun(int diversifications, int seed) {
  return {"part2", TabuMethodName("bbcp", diversifications), static_cast<uint64_t>(seed), 1, 0};
}

PlannedRun PaperRun(const std::string& part, const std::string& method, int cleaning_every,
                    const ReproduceForm& form) {
  return {part, method, 1, form.paper_layers, cleaning_every};
}

std::vector<PlannedRun> ThesisRuns(const ReproduceForm& form) {
  std::vector<PlannedRun> runs;
  const auto each_part = [&](const std::string& method, int seed) {
    for (const char* part : kThesisParts) runs.push_back(ThesisRun(part, method, seed, form));
  };
  for (const std::string& method : {std::string("none"), GreedyMethod(), Ni2optMethod()}) {
    each_part(method, 1);
  }
  for (const int diversifications : form.diversifications) {
    for (int seed = 1; seed <= form.first_samples; ++seed) {
      runs.push_back(SampleRun(diversifications, seed));
    }
    for (int seed = 1; seed <= form.seeds; ++seed) {
      each_part(TabuMethodName("nrp", diversifications), seed);
      each_part(TabuMethodName("bbcp", diversifications), seed);
    }
  }
  for (const bool cold : {true, false}) {
    for (const char* representation : {"bbcp", "nrp", "sp"}) {
      each_part(MilpMethodName(representation, cold, form), 1);
    }
  }
  return runs;
}

std::vector<PlannedRun> PaperRuns(const ReproduceForm& form) {
  std::vector<PlannedRun> runs;
  for (const std::string& part : form.paper_parts) {
    for (const int cleaning : kCleanings) {
      for (const std::string& method : {GreedyMethod(), Ni2optMethod(), ReleaseMethod()}) {
        runs.push_back(PaperRun(part, method, cleaning, form));
      }
    }
  }
  return runs;
}

}  // namespace traverse::report

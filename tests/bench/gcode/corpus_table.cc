#include "tests/bench/gcode/corpus_table.h"

#include <algorithm>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "absl/strings/str_format.h"

namespace traverse::bench {
namespace {

double Median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

double TravelSaved(const CorpusRun& run) {
  return Saved(run.before.travel_mm, run.after.travel_mm);
}

double TimeSaved(const CorpusRun& run) { return Saved(run.before.seconds, run.after.seconds); }

double LinkShare(const CorpusRun& run) {
  return run.before.seconds > 0 ? 100 * run.link_seconds / run.before.seconds : 0;
}

// Of the time on links, how much is gone.
double LinkTimeSaved(const CorpusRun& run) {
  return Saved(run.link_seconds, run.link_seconds - (run.before.seconds - run.after.seconds));
}

std::string Row(const CorpusRun& run) {
  return absl::StrFormat(
      "| %s | %.2f | %.2f | %.1f %% | %d | %d | %d (%d) | %d (%d) | %.0f | %.0f | %.2f %% | %.1f "
      "%% | %d of %d | %s "
      "|\n",
      run.file, run.before.travel_mm / 1000, run.after.travel_mm / 1000, TravelSaved(run),
      run.before.retractions, run.after.retractions, run.before.crossings,
      run.before.open_crossings, run.after.crossings, run.after.open_crossings, run.before.seconds,
      run.after.seconds, TimeSaved(run), LinkShare(run), run.layers_changed, run.layers,
      run.fault.empty() ? "yes" : run.fault);
}

std::string FoundAndWritten(const std::vector<CorpusRun>& runs) {
  std::string text =
      "\nFound and written\n\n| policy | file | found s | written s | of it | retractions | after "
      "| "
      "crossings | after | computing s |\n|---|---|---:|---:|---:|---:|---:|---:|---:|---:|\n";
  for (const CorpusRun& run : runs) {
    const double written = run.before.seconds - run.after.seconds;
    text += absl::StrFormat("| %s | %s | %.1f | %.1f | %.0f %% | %d | %d | %d | %d | %.1f |\n",
                            std::string(PolicyName(run.policy)), run.file, run.found_seconds,
                            written, run.found_seconds > 0 ? 100 * written / run.found_seconds : 0,
                            run.before.retractions, run.after.retractions, run.before.crossings,
                            run.after.crossings, run.cpu_seconds);
  }
  return text;
}

constexpr char kHead[] =
    "| file | travel m | after | less | retractions | after | crossings (open) | after | time s | "
    "after | less | links' share "
    "of time | layers rewritten | verified |\n"
    "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---|\n";

using Groups = std::map<std::pair<gcode::Policy, std::string>, std::vector<const CorpusRun*>>;

std::string Medians(const Groups& groups) {
  std::string text =
      "\nMedians over the files\n\n"
      "| policy | slicer | files | travel less | time less | of the links' time | slower files | "
      "not verified |\n|---|---|---:|---:|---:|---:|---:|---:|\n";
  for (const auto& [key, group] : groups) {
    const auto median = [&group = group](const std::function<double(const CorpusRun&)>& of) {
      std::vector<double> values;
      for (const CorpusRun* run : group) values.push_back(of(*run));
      return Median(values);
    };
    int64_t slower = 0;
    int64_t faults = 0;
    for (const CorpusRun* run : group) {
      slower += TimeSaved(*run) < -1e-6 ? 1 : 0;
      faults += run->fault.empty() ? 0 : 1;
    }
    text += absl::StrFormat("| %s | %s | %d | %.1f %% | %.2f %% | %.1f %% | %d | %d |\n",
                            std::string(PolicyName(key.first)), key.second, group.size(),
                            median(TravelSaved), median(TimeSaved), median(LinkTimeSaved), slower,
                            faults);
  }
  return text;
}

}  // namespace

std::string CorpusTable(const std::vector<CorpusRun>& runs) {
  Groups groups;
  for (const CorpusRun& run : runs) groups[{run.policy, run.slicer}].push_back(&run);
  std::string text;
  const std::pair<gcode::Policy, std::string>* last = nullptr;
  for (const auto& [key, group] : groups) {
    if (last == nullptr || last->first != key.first) {
      text += absl::StrFormat("\n%s\n\n%s", std::string(PolicyName(key.first)), kHead);
    }
    for (const CorpusRun* run : group) text += Row(*run);
    last = &key;
  }
  return text + Medians(groups) + FoundAndWritten(runs);
}

std::string CorpusJson(const std::vector<CorpusRun>& runs) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  const auto totals = [](const gcode::PrintTotals& t) {
    return nlohmann::ordered_json{
        {"travel_mm", t.travel_mm},           {"extruded_mm", t.extruded_mm},
        {"retractions", t.retractions},       {"crossings", t.crossings},
        {"open_crossings", t.open_crossings}, {"seconds", t.seconds}};
  };
  for (const CorpusRun& run : runs) {
    all.push_back({{"file", run.file},
                   {"slicer", run.slicer},
                   {"policy", std::string(PolicyName(run.policy))},
                   {"verified", run.fault.empty()},
                   {"fault", run.fault},
                   {"before", totals(run.before)},
                   {"after", totals(run.after)},
                   {"link_seconds", run.link_seconds},
                   {"found_seconds", run.found_seconds},
                   {"layers", run.layers},
                   {"layers_changed", run.layers_changed},
                   {"cpu_seconds", run.cpu_seconds}});
  }
  return all.dump(1) + "\n";
}

}  // namespace traverse::bench

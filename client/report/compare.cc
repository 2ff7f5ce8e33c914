#include "client/report/compare.h"

#include <cmath>
#include <functional>

#include "absl/strings/str_format.h"
#include "client/report/numbers.h"
#include "client/report/table.h"

namespace traverse::report {
namespace {

double TravelMm(const JobRun& run) {
  return run.result.summary.travel().total_mm() + run.result.summary.cleaning_mm();
}

double GivenMm(const JobRun& run) {
  return run.result.summary.given().total_mm() + run.result.summary.cleaning_given_mm();
}

double Mean(const ComparedStrategy& strategy, const std::function<double(const JobRun&)>& value) {
  double sum = 0;
  for (const JobRun& run : strategy.runs) sum += value(run);
  return sum / static_cast<double>(strategy.runs.size());
}

// Standard deviation of the sample.
double TravelDeviation(const ComparedStrategy& strategy) {
  const double mean = Mean(strategy, TravelMm);
  double sum = 0;
  for (const JobRun& run : strategy.runs) sum += std::pow(TravelMm(run) - mean, 2);
  const size_t n = strategy.runs.size();
  return n > 1 ? std::sqrt(sum / static_cast<double>(n - 1)) : 0;
}

const ComparedStrategy* Find(const std::vector<ComparedStrategy>& strategies, const char* label) {
  for (const ComparedStrategy& strategy : strategies) {
    if (strategy.label == label) return &strategy;
  }
  return nullptr;
}

// "0.8 %" if every run has a bound.
std::string Gap(const ComparedStrategy& strategy) {
  double sum = 0;
  for (const JobRun& run : strategy.runs) {
    const v1::JobSummary& summary = run.result.summary;
    if (!summary.has_lower_bound()) return "";
    if (summary.cost() > 0) sum += 100 * (summary.cost() - summary.lower_bound()) / summary.cost();
  }
  return absl::StrFormat("%.1f", sum / static_cast<double>(strategy.runs.size()));
}

std::string Percent(double before, double after) {
  return absl::StrFormat("%.1f", GainPercent(before, after));
}

}  // namespace

std::string CompareTable(const std::vector<ComparedStrategy>& strategies) {
  const ComparedStrategy* greedy = Find(strategies, "greedy");
  const ComparedStrategy* ni2opt = Find(strategies, "ni2opt");
  bool repeated = false;
  bool cleaned = false;
  bool bounded = false;
  for (const ComparedStrategy& strategy : strategies) {
    repeated |= strategy.runs.size() > 1;
    cleaned |= strategy.runs[0].result.summary.cleaning_mm() > 0;
    bounded |= !Gap(strategy).empty();
  }

  std::vector<std::string> header = {"strategy", "travel mm"};
  if (repeated) header.push_back("+- mm");
  header.insert(header.end(), {"contours", "rasters", "links"});
  if (cleaned) header.push_back("cleaning");
  header.insert(header.end(), {"idle s", "none %"});
  if (greedy != nullptr) header.push_back("greedy %");
  if (ni2opt != nullptr) header.push_back("ni2opt %");
  if (bounded) header.push_back("gap %");
  header.push_back("seconds");

  Table table(header);
  for (const ComparedStrategy& strategy : strategies) {
    const auto mean = [&](auto value) {
      return Mean(strategy, [&](const JobRun& run) { return value(run.result.summary); });
    };
    const auto mm = [](double value) { return absl::StrFormat("%.2f", value); };
    const double travel = Mean(strategy, TravelMm);
    std::vector<std::string> row = {strategy.label, mm(travel)};
    if (repeated) row.push_back(mm(TravelDeviation(strategy)));
    row.push_back(mm(mean([](const auto& s) { return s.travel().contours_mm(); })));
    row.push_back(mm(mean([](const auto& s) { return s.travel().rasters_mm(); })));
    row.push_back(mm(mean([](const auto& s) { return s.travel().links_mm(); })));
    if (cleaned) row.push_back(mm(mean([](const auto& s) { return s.cleaning_mm(); })));
    row.push_back(absl::StrFormat("%.1f", mean([](const auto& s) { return s.idle_seconds(); })));
    row.push_back(Percent(Mean(strategy, GivenMm), travel));
    if (greedy != nullptr) row.push_back(Percent(Mean(*greedy, TravelMm), travel));
    if (ni2opt != nullptr) row.push_back(Percent(Mean(*ni2opt, TravelMm), travel));
    if (bounded) row.push_back(Gap(strategy));
    row.push_back(absl::StrFormat(
        "%.3f", Mean(strategy, [](const JobRun& run) { return run.wall_seconds; })));
    table.Add(std::move(row));
  }
  return table.Text();
}

}  // namespace traverse::report

#include "client/loadgen/load_report.h"

#include <iterator>
#include <numeric>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/files/json.h"
#include "client/report/table.h"

namespace traverse::loadgen {
namespace {

struct Column {
  const char* name;
  double share;
};
constexpr Column kColumns[] = {{"p50", 0.5}, {"p90", 0.9}, {"p99", 0.99}, {"p99_9", 0.999}};

double Ms(absl::Duration duration) { return absl::ToDoubleMilliseconds(duration); }

Json LatencyJson(const LatencyHistogram& latency) {
  if (latency.count() == 0) return nullptr;
  Json out;
  out["mean"] = Ms(latency.mean());
  for (const Column& column : kColumns) out[column.name] = Ms(latency.Percentile(column.share));
  out["max"] = Ms(latency.max());
  return out;
}

std::vector<report::Cell> Row(const std::string& first, const std::vector<std::string>& counts,
                              const LatencyHistogram& latency) {
  std::vector<report::Cell> cells = {{first}};
  for (const std::string& count : counts) cells.push_back({count});
  const auto add = [&](absl::Duration value) {
    cells.push_back({latency.count() == 0 ? "-" : absl::StrFormat("%.2f", Ms(value))});
  };
  for (const Column& column : kColumns) add(latency.Percentile(column.share));
  add(latency.max());
  return cells;
}

std::vector<std::string> Header(std::vector<std::string> first) {
  for (const char* name : {"p50", "p90", "p99", "p99.9", "max ms"}) first.push_back(name);
  return first;
}

std::string PerSecond(uint64_t jobs, const LoadResult& result) {
  return absl::StrFormat("%.1f",
                         static_cast<double>(jobs) / absl::ToDoubleSeconds(result.duration));
}

std::string OkTable(const LoadHeading& heading, const LoadResult& result) {
  report::Table table(Header({"layers", "sent", "ok", "ok/s"}));
  for (size_t i = 0; i < result.ok.size(); ++i) {
    const Tally& ok = result.ok[i];
    table.Add(Row(absl::StrFormat("%d", heading.mix[i].layers),
                  {absl::StrFormat("%d", result.sent[i]), absl::StrFormat("%d", ok.jobs),
                   PerSecond(ok.jobs, result)},
                  ok.latency));
  }
  return table.Text();
}

std::string OtherTable(const LoadResult& result) {
  report::Table table(Header({"not ok", "jobs"}));
  std::string examples;
  for (const auto& [code, tally] : result.code) {
    if (code == "OK") continue;
    table.Add(Row(code, {absl::StrFormat("%d", tally.jobs)}, tally.latency));
    const auto example = result.example.find(code);
    if (example != result.example.end() && !example->second.empty()) {
      absl::StrAppendFormat(&examples, "%s: %s\n", code, example->second);
    }
  }
  const bool none = result.code.size() == result.code.count("OK");
  return none ? "" : absl::StrCat("\n", table.Text(), examples);
}

}  // namespace

std::string LoadTable(const LoadHeading& heading, const LoadResult& result) {
  const LoadOptions& options = heading.options;
  const std::string how =
      options.rate > 0 ? absl::StrFormat("%g jobs/s%s", options.rate,
                                         options.arrivals == Arrivals::kPoisson ? " (poisson)" : "")
                       : absl::StrFormat("%d jobs in flight (closed loop)", options.in_flight);
  std::string out = absl::StrFormat("%s: %s for %s, %s, %d connections\n\n", heading.target, how,
                                    absl::FormatDuration(options.duration), heading.strategy,
                                    heading.connections);
  out += OkTable(heading, result) + OtherTable(result);
  if (options.rate > 0) {
    absl::StrAppendFormat(&out,
                          "\nLatency counts from when a job was due to be sent; jobs were sent "
                          "late by p99 %.2f, max %.2f ms.\n",
                          Ms(result.send_lag.Percentile(0.99)), Ms(result.send_lag.max()));
  }
  if (result.not_sent > 0) {
    absl::StrAppendFormat(&out, "%d jobs were not sent, because %d were in flight.\n",
                          result.not_sent, options.max_in_flight);
  }
  return out;
}

std::string LoadJson(const LoadHeading& heading, const LoadResult& result) {
  const LoadOptions& options = heading.options;
  const auto ok = result.code.find("OK");
  const uint64_t jobs = ok == result.code.end() ? 0 : ok->second.jobs;
  const double seconds = absl::ToDoubleSeconds(result.duration);
  Json out;
  out["target"] = heading.target;
  out["strategy"] = heading.strategy;
  out["rate"] = options.rate > 0 ? Json(options.rate) : Json();
  out["in_flight"] = options.rate > 0 ? Json() : Json(options.in_flight);
  out["seconds"] = seconds;
  out["seed"] = options.seed;
  out["connections"] = heading.connections;
  out["sent"] = std::accumulate(result.sent.begin(), result.sent.end(), uint64_t{0});
  out["ok"] = jobs;
  out["ok_per_second"] = static_cast<double>(jobs) / seconds;
  out["not_sent"] = result.not_sent;
  out["send_lag_ms"] = LatencyJson(result.send_lag);
  JsonArray sizes;
  for (size_t i = 0; i < result.ok.size(); ++i) {
    sizes.push_back(JsonObject{{"layers", heading.mix[i].layers},
                               {"sent", result.sent[i]},
                               {"ok", result.ok[i].jobs},
                               {"latency_ms", LatencyJson(result.ok[i].latency)}});
  }
  out["sizes"] = std::move(sizes);
  Json codes = JsonObject();
  for (const auto& [code, tally] : result.code) {
    Json& entry = codes[code];
    entry = JsonObject{{"jobs", tally.jobs},
                       {"latency_ms", LatencyJson(tally.latency)},
                       {"from_sent_ms", LatencyJson(tally.from_sent)}};
    const auto example = result.example.find(code);
    if (example != result.example.end()) entry["example"] = example->second;
  }
  out["codes"] = std::move(codes);
  return JsonText(out, 1) + "\n";
}

}  // namespace traverse::loadgen

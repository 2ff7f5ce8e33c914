#include "tests/bench/gcode/corpus_run.h"

#include <ctime>
#include <filesystem>
#include <utility>
#include <vector>

#include "client/formats/read_input.h"
#include "client/gcode/gcode_job.h"
#include "client/gcode/measure/layer_meter.h"
#include "client/gcode/model/outline.h"
#include "client/gcode/parallel.h"
#include "client/gcode/read/reader.h"
#include "client/gcode/rewrite.h"
#include "client/input/input_job.h"
#include "tests/client/gcode/support/verified.h"

namespace traverse::bench {
namespace {

double CpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double LinkSeconds(const GcodeFile& file, double total_seconds) {
  double along_paths = 0;
  for (const gcode::Block& block : file.blocks) {
    const gcode::PartStart start{gcode::StateAt(file, block), file.states[block.state_in]};
    const std::string_view text(file.text);
    along_paths +=
        gcode::Measure(file, text.substr(block.begin, block.end - block.begin), start).seconds;
  }
  return total_seconds - along_paths;
}

std::string NameOf(const std::string& path) {
  const std::string name = std::filesystem::path(path).filename().string();
  return name.substr(0, name.find('.'));
}

// What the text written amounts to by its own account, not the writer's.
void MeasureResult(const GcodeFile& file, const std::string& text, CorpusRun& run) {
  VerifyOptions rules;
  rules.permissions = *ParsePermissions(gcode::PolicyName(run.policy), "");
  const auto verified = VerifyGcode(file.text, "before", text, "after", rules);
  if (!verified.ok()) run.fault = std::string(verified.message());
  const auto again = ReadGcode(text, "after");
  if (!again.ok()) {
    run.fault = std::string(again.status().message());
    return;
  }
  const int threads = gcode::DefaultThreads();
  run.before = gcode::Sum(gcode::MeasureLayers(file, threads));
  run.after = gcode::Sum(gcode::MeasureLayers(**again, threads));
  if (file.layers.size() != (*again)->layers.size()) run.fault = "another number of layers";
  run.link_seconds = LinkSeconds(file, run.before.seconds);
}

}  // namespace

double Saved(double before, double after) {
  return before > 0 ? 100 * (before - after) / before : 0;
}

absl::StatusOr<CorpusRun> RunFile(const std::string& path, gcode::Policy policy,
                                  const std::string& strategy, OptimizerClient& client) {
  CorpusRun run;
  run.file = NameOf(path);
  run.policy = policy;
  const double began = CpuSeconds();
  GcodeOptions options;
  options.policy = policy;
  absl::StatusOr<InputJob> job = ReadInput(path, options);
  if (!job.ok()) return job.status();
  if (strategy != "auto") {
    job->options.mutable_strategy()->Clear();
    job->options.mutable_strategy()->set_name(strategy);
  }
  const GcodeFile& file = *job->gcode;
  run.slicer = file.slicer.name.empty()
                   ? "unknown"
                   : file.slicer.name.substr(0, file.slicer.name.find_first_of(" _"));
  const absl::StatusOr<JobResult> result = client.Optimize(job->options, job->layers);
  if (!result.ok()) return result.status();
  gcode::FileOrder found;
  for (size_t i = 0; i < result->layers.size(); ++i) {
    found.push_back(OrderOf(file, i, result->layers[i]));
  }
  RewriteOptions rewriting;
  rewriting.policy = policy;
  rewriting.crossings = options.crossings;
  rewriting.threads = gcode::DefaultThreads();
  if (strategy == "auto") rewriting.polish = gcode::PolishLimit();
  const absl::StatusOr<GcodeRewrite> rewrite = RewriteGcode(file, found, rewriting);
  run.cpu_seconds = CpuSeconds() - began;
  if (!rewrite.ok()) {
    run.fault = std::string(rewrite.status().message());
    return run;
  }
  run.found_seconds = rewrite->forecast.given_seconds - rewrite->forecast.seconds;
  run.layers = rewrite->layers;
  run.layers_changed = rewrite->layers_changed;
  MeasureResult(file, rewrite->text, run);
  return run;
}

}  // namespace traverse::bench

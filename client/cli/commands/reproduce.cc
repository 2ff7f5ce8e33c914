#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "client/cli/command.h"
#include "client/cli/flags/job_flags.h"
#include "client/cli/flags/strategy_spec.h"
#include "client/cli/service.h"
#include "client/cli/terminal.h"
#include "client/files/write_file.h"
#include "client/formats/read_input.h"
#include "client/report/reproduce/figures_page.h"
#include "client/report/reproduce/outcomes.h"
#include "client/report/reproduce/paper_table.h"
#include "client/report/reproduce/run_plan.h"
#include "client/report/reproduce/thesis_tables.h"

namespace traverse::cli {
namespace {

constexpr uint64_t kMostLayers = 10000;

struct Request {
  report::ReproduceForm form;
  bool thesis = true;
  bool paper = true;
  std::string parts;    // a folder; empty: the one that comes with the program
  std::string results;  // a file; empty: none
  std::string page;
  bool quiet = false;
};

absl::StatusOr<Request> ParseRequest(const Flags& flags) {
  Request request;
  if (flags.Switch("short")) request.form = report::ReproduceForm::Short();
  const std::string source = flags.Text("source", "both");
  request.thesis = source != "paper";
  request.paper = source != "thesis";
  const auto layers = flags.Integer("layers", 1, kMostLayers);
  if (!layers.ok()) return layers.status();
  if (*layers) {
    request.form.thesis_layers = request.form.paper_layers = static_cast<int>(**layers);
  }
  const auto seeds = flags.Integer("seeds", 1, 1000);
  if (!seeds.ok()) return seeds.status();
  if (*seeds) request.form.seeds = request.form.first_samples = static_cast<int>(**seeds);
  const auto diversifications = flags.Integer("diversifications", 1, 500000);
  if (!diversifications.ok()) return diversifications.status();
  if (*diversifications) {
    request.form.diversifications[0] = static_cast<int>(**diversifications);
    request.form.diversifications[1] = 2 * request.form.diversifications[0];
  }
  const auto limit = flags.Duration("programme_limit");
  if (!limit.ok()) return limit.status();
  if (*limit) request.form.programme_seconds = absl::ToDoubleSeconds(**limit);
  request.parts = flags.Text("parts");
  request.results = flags.Text("results");
  request.page = flags.Text("report");
  request.quiet = flags.Switch("quiet");
  return request;
}

// The parts in or above `folder`: in the source tree, or installed. Empty if there are none.
std::string FindPartsAbove(std::filesystem::path folder) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  for (fs::path above = std::move(folder); !above.empty();) {
    for (const char* below : {"share/traverse/parts", "tests/bench/instances"}) {
      if (fs::exists(above / below / "part1.damat", ignored)) return (above / below).string();
    }
    if (above == above.root_path()) break;
    above = above.parent_path();
  }
  return "";
}

// The parts that come with the program. If the program was copied elsewhere, the parts of the
// source tree that it runs in.
std::string FindParts() {
  std::error_code ignored;
  std::string found =
      FindPartsAbove(std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path());
  return found.empty() ? FindPartsAbove(std::filesystem::current_path(ignored)) : found;
}

// Reads the parts and runs the plan.
class Reproduction {
 public:
  Reproduction(Service& service, const Request& request, report::OutcomeFile file)
      : service_(service), request_(request), file_(std::move(file)) {}

  Outcome Run() {
    std::vector<report::PlannedRun> runs;
    if (request_.thesis) runs = report::ThesisRuns(request_.form);
    if (request_.paper) {
      const std::vector<report::PlannedRun> more = report::PaperRuns(request_.form);
      runs.insert(runs.end(), more.begin(), more.end());
    }
    for (size_t i = 0; i < runs.size(); ++i) {
      if (file_.Find(runs[i].Key()) != nullptr) continue;
      if (!request_.quiet) {
        Print(stderr, absl::StrFormat("%d of %d: %s\n", i + 1, runs.size(), runs[i].Key()));
      }
      if (Outcome outcome = RunOne(runs[i]); outcome.code != kDone) return outcome;
    }
    return Done();
  }

  // The tables of the finished runs.
  std::string Tables() const {
    std::string text;
    if (request_.thesis) text += report::ThesisTables(request_.form, Finder());
    if (request_.paper) text += report::PaperTable(request_.form, Finder());
    return text;
  }

  Outcome WritePage(const std::string& tables) {
    std::map<std::string, v1::Layer> layers;
    for (const char* part : report::kThesisParts) {
      if (!request_.thesis) continue;
      if (Outcome outcome = Read(part); outcome.code != kDone) return outcome;
      layers[part] = parts_.at(part).layers.front();
    }
    const absl::Status status =
        WriteWholeFile(request_.page, report::FiguresPage(request_.form, Finder(), layers, tables));
    return status.ok() ? Done() : InputFault(status);
  }

 private:
  report::OutcomeOfRun Finder() const {
    return [this](const report::PlannedRun& run) { return file_.Find(run.Key()); };
  }

  Outcome Read(const std::string& part) {
    if (parts_.count(part) > 0) return Done();
    std::string name = request_.parts + "/" + part + ".damat";
    if (!std::filesystem::exists(name)) name += ".xz";
    absl::StatusOr<InputJob> job = ReadInput(name);
    if (!job.ok()) return InputFault(job.status());
    if (job->layers.empty()) {
      return InputFault(
          absl::InvalidArgumentError(name + ": has no layers to reproduce the tables with"));
    }
    parts_.emplace(part, *std::move(job));
    return Done();
  }

  // The part's layers, repeated as often as the run needs.
  static InputJob Repeated(const InputJob& part, const report::PlannedRun& run) {
    InputJob job = part;
    job.layers.clear();
    for (int i = 0; i < run.layers; ++i) {
      v1::Layer& layer =
          job.layers.emplace_back(part.layers[static_cast<size_t>(i) % part.layers.size()]);
      layer.set_id(static_cast<uint64_t>(i + 1));
    }
    job.options.set_seed(run.seed);
    if (run.cleaning_every > 0) {
      job.options.mutable_cleaning()->mutable_point();  // (0, 0)
      job.options.mutable_cleaning()->set_every_layers(static_cast<uint32_t>(run.cleaning_every));
    }
    return job;
  }

  Outcome RunOne(const report::PlannedRun& run) {
    if (Outcome outcome = Read(run.part); outcome.code != kDone) return outcome;
    const InputJob job = Repeated(parts_.at(run.part), run);
    auto specs = ParseStrategySpecs(run.method);
    if (!specs.ok()) return InputFault(specs.status());
    const JobFlags flags;
    if (Outcome outcome = service_.Resolve(flags, job, *specs); outcome.code != kDone) {
      return outcome;
    }
    Expected<report::JobRun> ran = service_.Optimize(job, &specs->front(), flags, /*quiet=*/true);
    if (Outcome* outcome = std::get_if<Outcome>(&ran)) return *outcome;
    const absl::Status kept =
        file_.Add(run.Key(), report::OutcomeOf(job, std::get<report::JobRun>(ran)));
    return kept.ok() ? Done() : InputFault(kept);
  }

  Service& service_;
  const Request& request_;
  report::OutcomeFile file_;
  std::map<std::string, InputJob> parts_;
};

Outcome RunReproduce(const Flags& flags) {
  absl::StatusOr<Request> request = ParseRequest(flags);
  if (!request.ok()) return UsageFault(request.status());
  if (request->parts.empty()) request->parts = FindParts();
  if (request->parts.empty()) {
    return UsageFault(
        "found no parts beside the program or here; name their folder with --parts=FOLDER (in the "
        "source tree tests/bench/instances)");
  }
  Expected<Service> opened = Service::Open(flags);
  if (Outcome* outcome = std::get_if<Outcome>(&opened)) return *outcome;
  absl::StatusOr<report::OutcomeFile> file = report::OutcomeFile::Open(request->results);
  if (!file.ok()) return InputFault(file.status());
  Reproduction reproduction(std::get<Service>(opened), *request, *std::move(file));
  if (Outcome outcome = reproduction.Run(); outcome.code != kDone) return outcome;
  const std::string tables = reproduction.Tables();
  Print(stdout, tables);
  return request->page.empty() ? Done() : reproduction.WritePage(tables);
}

}  // namespace

Command ReproduceCommand() {
  return {.name = "reproduce",
          .summary = "Prints the tables of both sources beside our own figures.",
          .flags = Joined(
              {
                  {"source",
                   "NAME",
                   "only Weller 2019, or only Souza et al. 2017",
                   {"thesis", "paper"}},
                  {"short", "", "takes three minutes on two cores, not a night"},
                  {"layers", "N", "layers of each part (default: 5; paper 393)"},
                  {"seeds", "N", "runs of the tabu search (default: 5)"},
                  {"diversifications", "N", "restarts of the first tabu search (default: 2500)"},
                  {"programme_limit", "DURATION", "limit of each integer programme (default: 2h)"},
                  {"parts", "FOLDER", "part1.damat and others (default: bundled)"},
                  {"results", "FILE", "keep finished runs here, and resume from them"},
                  {"report", "FILE.html", "draw the sources' figures"},
                  {"quiet", "", "no progress"},
              },
              ServiceFlagTable()),
          .example = "traverse reproduce --short --results=runs.jsonl --report=figures.html",
          .run = RunReproduce};
}

}  // namespace traverse::cli

#include "client/gateway/work/file_worker.h"

#include <algorithm>
#include <map>
#include <utility>
#include <variant>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/time/clock.h"
#include "client/containers/verify_files.h"
#include "client/files/decompress.h"
#include "client/formats/detect.h"
#include "client/formats/read_input.h"
#include "client/gateway/work/guarded.h"
#include "client/gateway/work/permissions.h"
#include "client/gateway/work/verify_answer.h"
#include "client/gcode/gcode_job.h"
#include "client/gcode/measure/layer_meter.h"
#include "client/gcode/measure/print_totals.h"
#include "client/gcode/parallel.h"
#include "client/gcode/verify/report.h"
#include "client/gcode/verify/verifier.h"
#include "client/optimize_file/optimize_file.h"
#include "client/view/report_page.h"
#include "client/view/scene/job_scene.h"

namespace traverse::gateway {
namespace {

void Add(const gcode::PrintTotals& totals, v1::PrintTotals& sum) {
  sum.set_extruded_mm(sum.extruded_mm() + totals.extruded_mm);
  sum.set_travel_mm(sum.travel_mm() + totals.travel_mm);
  sum.set_retractions(sum.retractions() + static_cast<uint32_t>(totals.retractions));
  sum.set_crossings(sum.crossings() + static_cast<uint32_t>(totals.crossings));
  sum.set_open_crossings(sum.open_crossings() + static_cast<uint32_t>(totals.open_crossings));
  sum.set_print_seconds(sum.print_seconds() + totals.seconds);
}

// Adds the result of one part. `label` ("plate 2: ") precedes its messages if there are several.
void AddPart(const InputJob& job, const OptimizedFile& made, const std::string& label,
             v1::RewriteSummary& out) {
  const GcodeRewrite& rewrite = made.rewrite;
  out.set_strategy(made.run.result.summary.strategy());
  out.set_seed(made.run.seed);
  out.set_layers(out.layers() + static_cast<uint32_t>(rewrite.layers));
  out.set_layers_changed(out.layers_changed() + static_cast<uint32_t>(rewrite.layers_changed));
  Add(rewrite.before, *out.mutable_given());
  Add(rewrite.after, *out.mutable_written());
  out.set_verified(true);
  const int64_t left =
      rewrite.layers - rewrite.layers_changed - rewrite.layers_unproven - rewrite.layers_unclear;
  if (left == rewrite.layers) {
    out.add_left(label + "Nothing to gain: no allowed order makes the print faster.");
  } else if (left > 0) {
    out.add_left(absl::StrFormat("%s%d of %d layers stay: no allowed order is faster.", label, left,
                                 rewrite.layers));
  }
  for (const std::string& line : DescribeLeft(rewrite)) {
    out.add_left(absl::StrCat(label, line, "."));
  }
  for (const auto& [name, value] : job.facts) {
    if (name.starts_with("movable")) {
      out.add_left(absl::StrFormat("%s%s: %s.", label, name, value));
    }
  }
  std::string text = rewrite.layers_changed == 0
                         ? "nothing to gain, the file stays unchanged: " + DescribeRewrite(rewrite)
                         : absl::StrFormat("%d of %d layers rewritten: %s", rewrite.layers_changed,
                                           rewrite.layers, DescribeRewrite(rewrite));
  const std::string rest = DescribeRest(rewrite);
  if (!rest.empty()) absl::StrAppend(&text, ", ", rest);
  out.set_text(out.text() + (out.text().empty() ? "" : "; ") + label + text);
}

// Reports stages to `sink`, and layers a few times a second.
class ProgressTeller {
 public:
  explicit ProgressTeller(const ProgressSink& sink) : sink_(sink) {}

  void Stage(v1::RewriteProgress::Stage stage) {
    now_.set_stage(stage);
    Tell();
  }

  SearchProgress ForSearch() {
    SearchProgress progress;
    progress.on_search = [this](const SearchWork& work) {
      now_.Clear();
      now_.set_layers(static_cast<uint32_t>(work.layers.size()));
      Stage(v1::RewriteProgress::STAGE_SEARCHING);
    };
    progress.on_layer = [this](const v1::LayerResult& layer) {
      now_.set_layers_done(now_.layers_done() + 1);
      now_.set_travel_given_mm(now_.travel_given_mm() + layer.given().total_mm());
      now_.set_travel_mm(now_.travel_mm() + layer.travel().total_mm());
      if (now_.layers_done() == now_.layers()) return Stage(v1::RewriteProgress::STAGE_WRITING);
      if (absl::Now() - told_ >= absl::Milliseconds(200)) Tell();
    };
    return progress;
  }

 private:
  void Tell() {
    told_ = absl::Now();
    if (sink_) sink_(now_);
  }

  const ProgressSink& sink_;
  v1::RewriteProgress now_;
  absl::Time told_;
};

void SetStrategy(const FileRequest& request, const InputJob& job, SearchOptions& options) {
  options.strategy = request.strategy;
  if (request.strategy_options.empty()) return;
  if (!options.strategy) options.strategy = job.options.strategy();
  for (const auto& [name, value] : request.strategy_options) {
    (*options.strategy->mutable_options())[name] = value;
  }
}

absl::StatusOr<std::shared_ptr<const SpoolFile>> Spooled(Spool& spool, const std::string& caller,
                                                         std::string_view text) {
  absl::StatusOr<std::shared_ptr<SpoolFile>> file = spool.NewFile(caller);
  if (!file.ok()) return file.status();
  if (absl::Status status = (*file)->Append(text); !status.ok()) return status;
  return *std::move(file);
}

}  // namespace

absl::StatusOr<std::string> FileWorker::Unpacked(const SpoolFile& upload,
                                                 const std::string& name) const {
  absl::StatusOr<std::string> bytes = upload.ReadAll();
  if (!bytes.ok()) return bytes.status();
  const Compression compression = DetectCompression(*bytes);
  if (compression == Compression::kNone) return bytes;
  absl::StatusOr<std::string> plain = Decompress(*bytes, compression, max_file_bytes_);
  if (absl::IsResourceExhausted(plain.status())) {
    return absl::OutOfRangeError(
        absl::StrFormat("the file is longer than %d bytes when it is unpacked", max_file_bytes_));
  }
  if (plain.ok()) return plain;
  return absl::Status(plain.status().code(),
                      absl::StrCat(name, ": ", std::string(plain.status().message())));
}

absl::StatusOr<InputFile> FileWorker::Open(const SpoolFile& upload,
                                           const FileRequest& request) const {
  absl::StatusOr<std::string> bytes = Unpacked(upload, request.name);
  if (!bytes.ok()) return bytes.status();
  PlateOptions plates = request.plates;
  plates.container.max_text_bytes = max_file_bytes_;
  absl::StatusOr<InputFile> file = OpenInputBytes(*std::move(bytes), request.name, plates);
  if (absl::IsResourceExhausted(file.status())) {
    return absl::OutOfRangeError(file.status().message());
  }
  if (file.ok() && file->format != InputFormat::kGcode) {
    return absl::UnimplementedError(absl::StrFormat("%s: a file of %s, not of a slicer",
                                                    request.name, FormatName(file->format)));
  }
  return file;
}

namespace {

// The reasons not to begin; otherwise OK.
absl::Status MayBegin(absl::Time finish_by, const std::stop_token& cancel) {
  if (cancel.stop_requested()) return absl::CancelledError("cancelled");
  if (absl::Now() < finish_by) return absl::OkStatus();
  return absl::DeadlineExceededError("the deadline passed before a worker was free");
}

}  // namespace

struct FileWorker::Work {
  Work(const FileRequest& wanted, const ProgressSink& progress, InputFile file)
      : request(wanted), teller(progress), input(std::move(file)) {}

  const FileRequest& request;
  OptimizeFileOptions options;  // options.gcode: with which files are read
  ProgressTeller teller;
  InputFile input;
  std::map<size_t, NewPart> parts;
  bool changed = false;
  int ours = 0;  // parts that Traverse has already optimised
  RewrittenFile out;

  ContainerKind kind() const { return request.container.value_or(input.kind()); }
  bool kept() const { return input.container != nullptr && kind() == input.kind(); }
};

absl::Status FileWorker::RewritePart(Work& work, size_t index) {
  const FileRequest& request = work.request;
  work.teller.Stage(v1::RewriteProgress::STAGE_READING);
  const absl::Time began = absl::Now();
  absl::StatusOr<InputJob> job = ReadJob(work.input, index, work.options.gcode);
  if (!job.ok()) return job.status();
  work.options.reading = absl::Now() - began;
  if (request.only_new && HasOurLine(job->gcode->text)) {
    ++work.ours;
    return absl::OkStatus();
  }
  if (absl::Status status = ApplySettings(request.settings, *job); !status.ok()) return status;
  if (work.options.cancel.stop_requested()) return absl::CancelledError("cancelled");
  SetStrategy(request, *job, work.options);
  FileResult<OptimizedFile> result = OptimizeFile(client_, *job, work.options);
  if (const FileFault* fault = std::get_if<FileFault>(&result)) return fault->status;
  OptimizedFile& made = std::get<OptimizedFile>(result);
  std::string label;
  if (work.input.parts.size() > 1) {
    label =
        absl::StrFormat("plate %d: ", work.input.container->parts()[work.input.parts[index]].plate);
  }
  AddPart(*job, made, label, work.out.summary);
  if (request.report) {
    absl::StatusOr<view::Scene> scene =
        view::GcodeScene(*job, work.out.summary.strategy(), made.run, made.rewrite);
    if (!scene.ok()) return scene.status();
    absl::StatusOr<std::shared_ptr<const SpoolFile>> report =
        Spooled(spool_, request.caller,
                view::ReportPage(*scene, "Made by traverse-gateway",
                                 gcode::ThreadsFor(made.rewrite.text.size())));
    if (!report.ok()) return report.status();
    work.out.report = *std::move(report);
  }
  const bool changed = made.rewrite.layers_changed > 0;
  work.changed = work.changed || changed;
  // If the container is kept, a text without gain stays as it is.
  if (changed || !work.kept()) {
    work.parts[work.input.parts[index]] = {std::move(made.rewrite.text), made.times};
  }
  return absl::OkStatus();
}

// The file of the parts.
absl::StatusOr<RewrittenFile> FileWorker::Finish(Work& work) {
  absl::StatusOr<std::string> text;
  if (work.kept()) {
    text = work.input.container->WithParts(work.parts);
  } else if (work.kind() != work.input.kind()) {
    text = PackText(work.parts.begin()->second.text, work.kind());
  } else {
    text = std::move(work.parts.begin()->second.text);
  }
  if (!text.ok()) return text.status();
  absl::StatusOr<std::shared_ptr<const SpoolFile>> file =
      Spooled(spool_, work.request.caller, *text);
  if (!file.ok()) return file.status();
  work.out.file = *std::move(file);
  work.out.summary.set_bytes(work.out.file->size());
  return std::move(work.out);
}

absl::StatusOr<RewrittenFile> FileWorker::RewriteParts(const SpoolFile& upload,
                                                       const FileRequest& request,
                                                       const ProgressSink& progress,
                                                       const std::stop_token& cancel) {
  absl::StatusOr<InputFile> input = Open(upload, request);
  if (!input.ok()) return input.status();
  Work work(request, progress, *std::move(input));
  if (request.report || work.kind() != work.input.kind()) {
    if (absl::Status status = CheckOnePlate(work.input); !status.ok()) return status;
  }
  work.options.deadline = request.deadline;
  work.options.finish_by = request.finish_by;
  work.options.cancel = cancel;
  work.options.progress = work.teller.ForSearch();
  work.options.gcode = request.gcode;
  // On a busy machine a late file is better than none, but not for long.
  work.options.gcode.limit = {request.finish_by + SearchOptions::kPatience, cancel};
  work.options.restate_times = request.restate_times;
  work.out.summary.set_policy(PolicyMessage(request.gcode.policy));
  for (size_t i = 0; i < work.input.parts.size(); ++i) {
    if (absl::Status status = RewritePart(work, i); !status.ok()) return status;
  }
  if (work.ours == static_cast<int>(work.input.parts.size())) {
    return absl::AlreadyExistsError("Traverse has optimised this file before");
  }
  return Finish(work);
}

absl::StatusOr<RewrittenFile> FileWorker::Rewrite(const SpoolFile& upload,
                                                  const FileRequest& request,
                                                  const ProgressSink& progress,
                                                  const std::stop_token& cancel) {
  const absl::Time began = absl::Now();
  if (absl::Status status = MayBegin(request.finish_by, cancel); !status.ok()) return status;
  return Guarded([&]() -> absl::StatusOr<RewrittenFile> {
    absl::StatusOr<RewrittenFile> out = RewriteParts(upload, request, progress, cancel);
    if (out.ok()) out->summary.set_wall_seconds(absl::ToDoubleSeconds(absl::Now() - began));
    return out;
  });
}

absl::StatusOr<v1::InspectResponse> FileWorker::Inspect(const SpoolFile& upload,
                                                        const FileRequest& request,
                                                        const std::stop_token& cancel) {
  if (absl::Status status = MayBegin(request.finish_by, cancel); !status.ok()) return status;
  GcodeOptions gcode = request.gcode;
  gcode.limit = {request.finish_by, cancel};
  return Guarded([&]() -> absl::StatusOr<v1::InspectResponse> {
    absl::StatusOr<InputFile> input = Open(upload, request);
    if (!input.ok()) return input.status();
    v1::InspectResponse out;
    out.set_format(input->container ? ContainerName(input->kind()) : FormatName(input->format));
    for (size_t i = 0; i < input->parts.size(); ++i) {
      absl::StatusOr<InputJob> job = ReadJob(*input, i, gcode);
      if (!job.ok()) return job.status();
      if (absl::Status status = ApplySettings(request.settings, *job); !status.ok()) return status;
      const absl::StatusOr<gcode::PrintTotals> totals = AddMeasuredFacts(*job, gcode);
      if (!totals.ok()) return totals.status();
      out.set_layers(out.layers() + static_cast<uint32_t>(job->layers.size()));
      for (const auto& [name, value] : job->facts) {
        v1::Fact& fact = *out.add_facts();
        fact.set_name(name);
        fact.set_value(value);
      }
      Add(*totals, *out.mutable_totals());
    }
    return out;
  });
}

absl::StatusOr<v1::VerifyResponse> FileWorker::Verify(
    const SpoolFile& original, const SpoolFile& optimised,
    const std::optional<GivenPermissions>& permissions, absl::Time until,
    const std::stop_token& cancel) {
  if (absl::Status status = MayBegin(until, cancel); !status.ok()) return status;
  return Guarded([&]() -> absl::StatusOr<v1::VerifyResponse> {
    absl::StatusOr<std::string> one = Unpacked(original, "original");
    if (!one.ok()) return one.status();
    absl::StatusOr<std::string> other = Unpacked(optimised, "optimised");
    if (!other.ok()) return other.status();
    VerifyFilesOptions options;
    options.permissions = permissions;
    options.limit = {until, cancel};
    options.container.max_text_bytes = max_file_bytes_;
    const absl::StatusOr<VerifyReport> report =
        VerifyFiles(*std::move(one), "original", *std::move(other), "optimised", options);
    if (!report.ok()) return report.status();
    return VerifyAnswer(*report);
  });
}

bool HasOurLine(std::string_view text) {
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = text.substr(at, end - at);
    if (line.starts_with(kOptimisedMark)) return true;
    const size_t first = line.find_first_not_of(" \t\r");
    if (first != std::string_view::npos && line[first] != ';') return false;
    at = end + 1;
  }
  return false;
}

}  // namespace traverse::gateway

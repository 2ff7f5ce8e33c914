// traverse-loadgen: puts load on servers and measures how they handle it.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_join.h"
#include "client/api/channel.h"
#include "client/cli/flags/connection_flags.h"
#include "client/cli/help.h"
#include "client/cli/outcome.h"
#include "client/cli/terminal.h"
#include "client/files/write_file.h"
#include "client/formats/read_input.h"
#include "client/input/input_job.h"
#include "client/loadgen/job_bytes.h"
#include "client/loadgen/load_report.h"
#include "client/loadgen/load_run.h"
#include "client/loadgen/loadgen_flags.h"

namespace traverse::loadgen {
namespace {

using cli::Outcome;

// Number of different layers that are made up; larger jobs repeat them.
constexpr uint64_t kMadeUpLayers = 50;

absl::StatusOr<std::vector<JobKind>> MakeKinds(const LoadgenFlags& flags) {
  v1::JobOptions options = flags.job;
  std::vector<v1::Layer> parts;
  if (flags.input.empty()) {
    for (uint64_t i = 1; i <= kMadeUpLayers; ++i) parts.push_back(MadeUpLayer(i, flags.islands));
  } else {
    absl::StatusOr<InputJob> job = ReadInput(flags.input);
    if (!job.ok()) return job.status();
    if (job->layers.empty()) {
      return absl::InvalidArgumentError(flags.input + ": no layers");
    }
    parts = std::move(job->layers);
    options = job->options;
    options.MergeFrom(flags.job);
  }
  std::vector<JobKind> kinds;
  for (const SizeShare& share : flags.mix) {
    kinds.push_back({share, JobBytes(options, parts, share.layers)});
  }
  return kinds;
}

Outcome Run(const std::vector<std::string>& arguments) {
  const absl::StatusOr<LoadgenFlags> flags = ParseLoadgenFlags(arguments);
  if (!flags.ok()) {
    return cli::UsageFault("traverse-loadgen: " + std::string(flags.status().message()));
  }
  const absl::StatusOr<std::vector<JobKind>> kinds = MakeKinds(*flags);
  if (!kinds.ok()) return cli::InputFault(kinds.status());
  std::vector<std::shared_ptr<grpc::Channel>> channels;
  for (int i = 0; i < flags->connections; ++i) {
    auto channel = ConnectTo(flags->target, flags->connect);
    if (!channel.ok()) return cli::ConnectFault(channel.status());
    channels.push_back(*std::move(channel));
  }
  const LoadResult result = RunLoad(flags->load, *kinds, channels);
  const LoadHeading heading = {absl::StrJoin(flags->target, ","), flags->strategy, flags->load,
                               channels.size(), flags->mix};
  if (flags->json != "-") cli::Print(stdout, LoadTable(heading, result));
  if (!flags->json.empty()) {
    const absl::Status written = WriteWholeFile(flags->json, LoadJson(heading, result));
    if (!written.ok()) return cli::InputFault(written);
  }
  if (result.code.contains("OK")) return cli::Done();
  return {cli::kServerFault, "traverse-loadgen: no job was answered"};
}

int Main(const std::vector<std::string>& arguments) {
  setenv("GRPC_VERBOSITY", "NONE", /*overwrite=*/0);
  for (const std::string& argument : arguments) {
    if (argument == "--help" || argument == "-h") {
      cli::Print(stdout, LoadgenHelp());
      return cli::kDone;
    }
    if (argument == "--version") {
      cli::Print(stdout, cli::VersionLine() + "\n");
      return cli::kDone;
    }
  }
  const Outcome outcome = Run(arguments);
  if (!outcome.message.empty()) cli::Print(stderr, outcome.message + "\n");
  return outcome.code;
}

}  // namespace
}  // namespace traverse::loadgen

int main(int argc, char** argv) {
  return traverse::loadgen::Main(std::vector<std::string>(argv + 1, argv + argc));
}

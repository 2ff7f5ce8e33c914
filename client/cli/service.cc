#include "client/cli/service.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "client/api/channel.h"
#include "client/cli/flags/connection_flags.h"
#include "client/cli/progress.h"
#include "client/cli/terminal.h"
#include "client/files/read_file.h"

namespace traverse::cli {
namespace {

constexpr uint64_t kMaxThreads = 1024;

// The server's text without line breaks. If a connection failed, only the part that says why: gRPC
// packs it into "connections to all backends failing; last error: UNKNOWN: ipv4:...".
std::string OneLine(std::string text) {
  for (char& c : text) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  for (const char* packing : {"last error: ", "UNKNOWN: "}) {
    const size_t at = text.rfind(packing);
    if (at != std::string::npos) text.erase(0, at + std::string_view(packing).size());
  }
  return text;
}

// Whether INVALID_ARGUMENT is about options, which come from flags, and not about layers, which
// come from the file.
bool IsAboutOptions(const std::string& message) { return message.starts_with("options"); }

}  // namespace

Service::Service(std::unique_ptr<EmbeddedService> embedded, std::shared_ptr<grpc::Channel> channel,
                 std::string name, std::string token)
    : embedded_(std::move(embedded)),
      client_(std::make_unique<OptimizerClient>(std::move(channel), std::move(token))),
      name_(std::move(name)) {}

Expected<Service> Service::Open(const Flags& flags) {
  const auto threads = flags.Integer("threads", 1, kMaxThreads);
  if (!threads.ok()) return UsageFault(threads.status());
  if (!flags.Has("server")) {
    if (absl::Status unused = CheckNoConnectionFlags(flags); !unused.ok())
      return UsageFault(unused);
    const unsigned available = std::max(1u, std::thread::hardware_concurrency());
    auto embedded = EmbeddedService::Start(static_cast<int>(threads->value_or(available)));
    if (!embedded.ok()) return Outcome{kServerFault, std::string(embedded.status().message())};
    std::shared_ptr<grpc::Channel> channel = (*embedded)->channel();
    return Service(*std::move(embedded), std::move(channel), "", "");
  }
  if (*threads) return UsageFault("--threads works only without --server");
  const auto addresses = ParseAddresses(flags.Text("server"));
  if (!addresses.ok()) {
    return UsageFault(absl::StrFormat("--server: %s", std::string(addresses.status().message())));
  }
  absl::StatusOr<Connection> connection = ParseConnectionFlags(flags, *addresses);
  if (!connection.ok()) return UsageFault(connection.status());
  auto channel = ConnectTo(*addresses, connection->options);
  if (!channel.ok()) return ConnectFault(channel.status());
  return Service(nullptr, *std::move(channel), absl::StrJoin(*addresses, ","),
                 std::move(connection->token));
}

Expected<v1::ListStrategiesResponse> Service::ListStrategies() {
  constexpr absl::Duration kPatience = absl::Seconds(30);
  absl::StatusOr<v1::ListStrategiesResponse> strategies = client_->ListStrategies(kPatience);
  if (!strategies.ok()) return Failure(strategies.status(), "");
  return *std::move(strategies);
}

Outcome Service::Resolve(const JobFlags& flags, const InputJob& job,
                         std::vector<StrategySpec>& specs) {
  if (specs.empty() && flags.strategy_options.empty()) return Done();
  Expected<v1::ListStrategiesResponse> listed = ListStrategies();
  if (Outcome* outcome = std::get_if<Outcome>(&listed)) return *outcome;
  const v1::ListStrategiesResponse& known = std::get<v1::ListStrategiesResponse>(listed);
  if (specs.empty()) {
    StrategySpec spec{"optimize", job.options.strategy()};
    if (spec.strategy.name().empty()) spec.strategy.set_name(known.default_strategy());
    for (const auto& option : flags.strategy_options) {
      spec.strategy.mutable_options()->erase(option.first);
    }
    specs.push_back(std::move(spec));
  }
  const absl::Status status = ResolveStrategies(known, flags.strategy_options, specs);
  return status.ok() ? Done() : UsageFault(status);
}

Expected<report::JobRun> Service::Optimize(const InputJob& job, const StrategySpec* strategy,
                                           const JobFlags& flags, bool quiet) {
  std::optional<Progress> shown;
  absl::StatusOr<report::JobRun> run =
      Search(*client_, job, SearchOptionsFor(strategy, flags, quiet, shown));
  shown.reset();
  if (!run.ok()) return Failure(run.status(), job.name);
  TellMissed(*run);
  return *std::move(run);
}

Expected<OptimizedFile> Service::Rewrite(const InputJob& job, const StrategySpec* strategy,
                                         const JobFlags& flags, const RewriteFlags& rewrite,
                                         bool quiet) {
  std::optional<Progress> shown;
  OptimizeFileOptions options;
  static_cast<SearchOptions&>(options) = SearchOptionsFor(strategy, flags, quiet, shown);
  options.gcode = rewrite.gcode;
  options.restate_times = rewrite.restate_times;
  options.forecast_fast = !quiet && options.deadline == absl::InfiniteDuration();
  FileResult<OptimizedFile> made = OptimizeFile(*client_, job, options);
  shown.reset();
  if (const FileFault* fault = std::get_if<FileFault>(&made)) {
    if (fault->stage == FileStage::kWrite) return InputFault(fault->status);
    return Failure(fault->status, job.name);
  }
  TellMissed(std::get<OptimizedFile>(made).run);
  return std::get<OptimizedFile>(std::move(made));
}

SearchOptions Service::SearchOptionsFor(const StrategySpec* strategy, const JobFlags& flags,
                                        bool quiet, std::optional<Progress>& shown) {
  SearchOptions options;
  if (strategy != nullptr) options.strategy = strategy->strategy;
  options.deadline = flags.deadline;
  options.stand_in = [this]() -> absl::StatusOr<OptimizerClient*> {
    if (!stand_in_) {
      auto started = EmbeddedService::Start(/*threads=*/1);
      if (!started.ok()) return started.status();
      stand_in_ = *std::move(started);
      stand_in_client_ = std::make_unique<OptimizerClient>(stand_in_->channel());
    }
    return stand_in_client_.get();
  };
  const std::string label = strategy != nullptr ? strategy->label : "optimize";
  options.progress.on_search = [&shown, label, quiet](const SearchWork& work) {
    shown.emplace(Progress::StyleFor(quiet), label, work);
  };
  options.progress.on_layer = [&shown](const v1::LayerResult& layer) { shown->Take(layer); };
  return options;
}

void Service::TellMissed(const report::JobRun& run) const {
  if (run.missed_layers == 0) return;
  const std::string reason = absl::IsDeadlineExceeded(run.missed_because)
                                 ? "it was silent"
                                 : OneLine(std::string(run.missed_because.message()));
  Print(stderr,
        absl::StrFormat("%s left %d of %d layers without an answer (%s); they are greedy's\n",
                        name_.empty() ? "embedded service" : "server " + name_, run.missed_layers,
                        run.result.layers.size(), reason));
}

Outcome Service::Failure(const absl::Status& status, const std::string& input) const {
  const std::string message = OneLine(std::string(status.message()));
  if (absl::IsInvalidArgument(status)) {
    if (IsAboutOptions(message)) return UsageFault(message);
    return {kInputFault, absl::StrFormat("%s: %s", DisplayName(input), message)};
  }
  if (absl::IsDeadlineExceeded(status)) {
    return {kServerFault,
            absl::StrFormat("no answer in time%s%s", name_.empty() ? "" : " from ", name_)};
  }
  return {kServerFault,
          absl::StrFormat("%s: %s: %s", name_.empty() ? "embedded service" : "server " + name_,
                          absl::StatusCodeToString(status.code()), message)};
}

}  // namespace traverse::cli

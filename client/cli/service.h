// The service as commands use it: embedded or remote, a job with its progress, exit codes.

#ifndef TRAVERSE_CLIENT_CLI_SERVICE_H_
#define TRAVERSE_CLIENT_CLI_SERVICE_H_

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "client/api/embedded.h"
#include "client/api/optimizer_client.h"
#include "client/cli/flags/flags.h"
#include "client/cli/flags/job_flags.h"
#include "client/cli/flags/strategy_spec.h"
#include "client/cli/outcome.h"
#include "client/cli/progress.h"
#include "client/input/input_job.h"
#include "client/optimize_file/optimize_file.h"
#include "client/report/run.h"

namespace traverse::cli {

// How to rewrite G-code.
struct RewriteFlags {
  GcodeOptions gcode;
  bool restate_times = false;
};

class Service {
 public:
  // As --server and --threads say. UsageFault for bad values; kServerFault for names that do not
  // resolve. Only the calls below contact a server.
  static Expected<Service> Open(const Flags& flags);

  // Returns the service's strategies.
  Expected<v1::ListStrategiesResponse> ListStrategies();

  // Checks `specs` against the service's strategies and adds the options of --option. Without specs
  // those options go to the job's own strategy or the service's default, which joins `specs`.
  Outcome Resolve(const JobFlags& flags, const InputJob& job, std::vector<StrategySpec>& specs);

  // Runs the job with `strategy` (unset: the service's default) and shows its progress.
  Expected<report::JobRun> Optimize(const InputJob& job, const StrategySpec* strategy,
                                    const JobFlags& flags, bool quiet);

  // The same, and rewrites the job's file, which is G-code that was read with `rewrite.gcode`.
  Expected<OptimizedFile> Rewrite(const InputJob& job, const StrategySpec* strategy,
                                  const JobFlags& flags, const RewriteFlags& rewrite, bool quiet);

 private:
  Service(std::unique_ptr<EmbeddedService> embedded, std::shared_ptr<grpc::Channel> channel,
          std::string name, std::string token);

  // The options that the command line asks for. `shown` shows progress while a search runs.
  SearchOptions SearchOptionsFor(const StrategySpec* strategy, const JobFlags& flags, bool quiet,
                                 std::optional<Progress>& shown);

  // Says which layers of a run had to be done without the service.
  void TellMissed(const report::JobRun& run) const;

  // How a command ends when the service answers with `status`.
  Outcome Failure(const absl::Status& status, const std::string& input) const;

  std::unique_ptr<EmbeddedService> embedded_;  // null: remote
  std::unique_ptr<OptimizerClient> client_;
  std::string name_;  // addresses; empty: embedded

  // Once the service has failed amid a job: one that does the rest.
  std::unique_ptr<EmbeddedService> stand_in_;
  std::unique_ptr<OptimizerClient> stand_in_client_;
};

}  // namespace traverse::cli

#endif  // TRAVERSE_CLIENT_CLI_SERVICE_H_

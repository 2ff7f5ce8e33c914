// traverse-server: flags, signals, exit code; nothing else.

#include <absl/flags/flag.h>
#include <absl/flags/parse.h>
#include <absl/flags/usage.h>
#include <absl/flags/usage_config.h>
#include <grpc/support/log.h>
#include <signal.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/time/time.h"
#include "server/server.h"
#include "server/version.h"

ABSL_FLAG(std::string, listen, "127.0.0.1:50051", "HOST:PORT of the service; port 0: a free one");
ABSL_FLAG(std::string, metrics_listen, "127.0.0.1:9464",
          "HOST:PORT of /metrics, /healthz and /readyz; port 0: a free one; empty: none");
ABSL_FLAG(int32_t, threads, 0, "Worker threads; 0: one for each core");
ABSL_FLAG(bool, reflection, true, "Whether clients may ask for the service's description");
ABSL_FLAG(absl::Duration, drain_timeout, absl::Seconds(30),
          "How long jobs under way may go on after SIGTERM");
ABSL_FLAG(std::string, log_file, "", "File to append the log to; empty: stderr");
ABSL_FLAG(int64_t, max_message_bytes, int64_t{64} << 20, "Largest message accepted");
ABSL_FLAG(int64_t, max_layers_per_message, 100'000, "Most layers in one message");
ABSL_FLAG(int64_t, max_layers_per_job, 0, "Most layers in a job; 0: no limit");
ABSL_FLAG(int64_t, max_points_per_job, 0, "Most points in a job; 0: no limit");
ABSL_FLAG(int64_t, max_points_per_layer, 1'000'000, "Most points in a layer");
ABSL_FLAG(int64_t, max_queued_points, 8'000'000,
          "Most points of all jobs together that wait to be solved");
ABSL_FLAG(int32_t, max_jobs, 256, "Most jobs in flight");
ABSL_FLAG(int32_t, max_jobs_per_caller, 64, "Most jobs in flight of one caller");
ABSL_FLAG(int64_t, window_layers, 256, "Most layers of a job between solver and reader");
ABSL_FLAG(int64_t, window_points, 500'000, "Most points of a job between solver and reader");

namespace traverse {
namespace {

// Exit codes.
constexpr int kExitStart = 1;
constexpr int kExitUsage = 2;

void SetUpFlags() {
  absl::SetProgramUsageMessage(
      "Finds short routes through the paths of a 3D print's layers; see server/README.md.\n"
      "Usage: traverse-server [--listen=HOST:PORT] [--metrics_listen=HOST:PORT] [--threads=N] ...");
  absl::FlagsUsageConfig config;
  config.version_string = [] { return absl::StrCat("traverse-server ", kVersion, "\n"); };
  config.contains_helpshort_flags = [](absl::string_view file) {
    return absl::StrContains(file, "server/main.cc");
  };
  absl::SetFlagsUsageConfig(config);
}

ServerOptions OptionsFromFlags() {
  ServerOptions options;
  options.listen = absl::GetFlag(FLAGS_listen);
  options.metrics_listen = absl::GetFlag(FLAGS_metrics_listen);
  options.reflection = absl::GetFlag(FLAGS_reflection);
  ServiceOptions& service = options.service;
  const int threads = absl::GetFlag(FLAGS_threads);
  service.threads = threads > 0 ? threads : UsableCores();
  service.log_path = absl::GetFlag(FLAGS_log_file);
  service.limits.max_message_bytes = absl::GetFlag(FLAGS_max_message_bytes);
  service.limits.max_layers_per_message = absl::GetFlag(FLAGS_max_layers_per_message);
  service.limits.max_layers_per_job = absl::GetFlag(FLAGS_max_layers_per_job);
  service.limits.max_points_per_job = absl::GetFlag(FLAGS_max_points_per_job);
  service.limits.max_points_per_layer = absl::GetFlag(FLAGS_max_points_per_layer);
  service.limits.window.layers = absl::GetFlag(FLAGS_window_layers);
  service.limits.window.points = absl::GetFlag(FLAGS_window_points);
  service.admission.max_queued_points = absl::GetFlag(FLAGS_max_queued_points);
  service.admission.max_jobs = absl::GetFlag(FLAGS_max_jobs);
  service.admission.max_jobs_per_caller = absl::GetFlag(FLAGS_max_jobs_per_caller);
  return options;
}

// gRPC prints its own view of every error; ours are on one line. Its variables bring it back.
void QuietGrpc() {
  if (std::getenv("GRPC_VERBOSITY") == nullptr && std::getenv("GRPC_TRACE") == nullptr) {
    gpr_set_log_function([](gpr_log_func_args*) {});
  }
}

// Waits for the signals that end the server. Blocked in all threads, they are only seen here.
sigset_t BlockSignals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  signal(SIGPIPE, SIG_IGN);
  return signals;
}

int Run() {
  const sigset_t signals = BlockSignals();
  QuietGrpc();
  absl::StatusOr<std::unique_ptr<Server>> server = Server::Start(OptionsFromFlags());
  if (!server.ok()) {
    std::fprintf(stderr, "traverse-server: %s\n", std::string(server.status().message()).c_str());
    return kExitStart;
  }
  std::printf("listening on port %d\n", (*server)->port());
  if ((*server)->metrics_port() != 0)
    std::printf("metrics on port %d\n", (*server)->metrics_port());
  std::fflush(stdout);
  JobLog& log = *(*server)->core().log;
  log.Event(JobLog::Level::kInfo, "started",
            {{"version", kVersion}, {"port", absl::StrCat((*server)->port())}});

  int signal = 0;
  sigwait(&signals, &signal);
  log.Event(JobLog::Level::kInfo, "draining", {{"signal", strsignal(signal)}});
  std::thread([signals] {
    int second = 0;
    sigwait(&signals, &second);
    std::_Exit(128 + second);
  }).detach();
  const bool all_done = (*server)->Drain(absl::GetFlag(FLAGS_drain_timeout));
  log.Event(all_done ? JobLog::Level::kInfo : JobLog::Level::kWarning, "stopped",
            {{"jobs_cut_off", all_done ? "no" : "yes"}});
  return 0;
}

}  // namespace
}  // namespace traverse

int main(int argc, char** argv) {
  traverse::SetUpFlags();
  const std::vector<char*> arguments = absl::ParseCommandLine(argc, argv);
  if (arguments.size() > 1) {
    std::fprintf(stderr, "traverse-server: unexpected argument %s\n", arguments[1]);
    return traverse::kExitUsage;
  }
  return traverse::Run();
}

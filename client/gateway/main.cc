// traverse-gateway: flags, signals, exit code; nothing else.

#include <google/protobuf/stubs/logging.h>
#include <signal.h>
#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/gateway/gateway.h"
#include "client/gateway/gateway_flags.h"
#include "server/version.h"

namespace traverse::gateway {
namespace {

// Exit codes.
constexpr int kExitStart = 1;
constexpr int kExitUsage = 2;

// As many as the system allows this process, for each connection and each file takes one.
void RaiseFileLimit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);
}

// Blocked in all threads, they are only seen where they are waited for.
sigset_t BlockSignals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  signal(SIGPIPE, SIG_IGN);
  return signals;
}

// Waits for a signal that ends the gateway, and returns it.
int WaitForEnd(const sigset_t& signals, Gateway& gateway) {
  int signal = SIGHUP;
  while (true) {
    sigwait(&signals, &signal);
    if (signal != SIGHUP) return signal;
    gateway.Reload();
    gateway.core().log->Event(JobLog::Level::kInfo, "reloaded", {{"signal", strsignal(signal)}});
  }
}

int Fail(const absl::Status& status, int exit_code) {
  std::fprintf(stderr, "traverse-gateway: %s\n", std::string(status.message()).c_str());
  return exit_code;
}

int ExitCodeOf(const absl::Status& status) {
  return absl::IsInvalidArgument(status) ? kExitUsage : kExitStart;
}

int Run() {
  const sigset_t signals = BlockSignals();
  // Both print what our own messages say.
  google::protobuf::SetLogHandler(nullptr);
  setenv("GRPC_VERBOSITY", "NONE", /*overwrite=*/0);
  RaiseFileLimit();
  const absl::StatusOr<GatewayOptions> options = OptionsFromFlags();
  if (!options.ok()) return Fail(options.status(), ExitCodeOf(options.status()));
  absl::StatusOr<std::unique_ptr<Gateway>> gateway = Gateway::Start(*options);
  if (!gateway.ok()) return Fail(gateway.status(), ExitCodeOf(gateway.status()));
  std::printf("HTTP on port %d\n", (*gateway)->http_port());
  if ((*gateway)->grpc_port() != 0) std::printf("gRPC on port %d\n", (*gateway)->grpc_port());
  if ((*gateway)->metrics_port() != 0) {
    std::printf("metrics on port %d\n", (*gateway)->metrics_port());
  }
  std::fflush(stdout);
  JobLog& log = *(*gateway)->core().log;
  log.Event(JobLog::Level::kInfo, "started",
            {{"version", kVersion}, {"port", absl::StrCat((*gateway)->http_port())}});

  const int signal = WaitForEnd(signals, **gateway);
  log.Event(JobLog::Level::kInfo, "draining", {{"signal", strsignal(signal)}});
  std::thread([signals] {
    int second = SIGHUP;
    while (second == SIGHUP) sigwait(&signals, &second);
    std::_Exit(128 + second);
  }).detach();
  const bool all_done = (*gateway)->Drain(DrainTimeout());
  log.Event(all_done ? JobLog::Level::kInfo : JobLog::Level::kWarning, "stopped",
            {{"requests_cut_off", all_done ? "no" : "yes"}});
  if (!all_done) {
    std::fflush(nullptr);
    std::_Exit(0);  // nothing is left behind: the spool has no names
  }
  return 0;
}

}  // namespace
}  // namespace traverse::gateway

int main(int argc, char** argv) {
  const absl::StatusOr<std::string> text =
      traverse::gateway::ReadFlags(std::vector<std::string>(argv + 1, argv + argc));
  if (!text.ok()) return traverse::gateway::Fail(text.status(), traverse::gateway::kExitUsage);
  if (text->empty()) return traverse::gateway::Run();
  std::fputs(text->c_str(), stdout);
  return 0;
}

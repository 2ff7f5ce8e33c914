// traverse-server: flags, signals, exit code; nothing else.

#include <grpc/support/log.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "absl/strings/str_cat.h"
#include "server/server.h"
#include "server/server_flags.h"
#include "server/version.h"

namespace traverse {
namespace {

// Exit codes.
constexpr int kExitStart = 1;
constexpr int kExitUsage = 2;

// What the process sends itself when its port is lost.
constexpr int kPortLost = SIGUSR1;

// gRPC prints its own view of every error; ours are on one line. Its variables bring it back.
//
// One of its errors matters: where a connection cannot be accepted, for want of file descriptors,
// gRPC 1.51 gives up the port for good and goes on. Its log is the only place that says so.
void WatchGrpcLog() {
  static const bool print =
      std::getenv("GRPC_VERBOSITY") != nullptr || std::getenv("GRPC_TRACE") != nullptr;
  gpr_set_log_function([](gpr_log_func_args* line) {
    if (print) std::fprintf(stderr, "%s:%d %s\n", line->file, line->line, line->message);
    if (std::strncmp(line->message, "Failed accept4", 14) == 0) kill(getpid(), kPortLost);
  });
}

// As many as the system allows this process, for each connection takes one.
void RaiseFileLimit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);
}

// The signals that mean something. Blocked in all threads, they are only seen where they are waited
// for.
sigset_t BlockSignals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGHUP);
  sigaddset(&signals, kPortLost);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  signal(SIGPIPE, SIG_IGN);
  return signals;
}

int Fail(const absl::Status& status, int exit_code) {
  std::fprintf(stderr, "traverse-server: %s\n", std::string(status.message()).c_str());
  return exit_code;
}

// Waits for a signal that ends the server, and returns it.
int WaitForEnd(const sigset_t& signals, Server& server) {
  int signal = SIGHUP;
  while (true) {
    sigwait(&signals, &signal);
    if (signal != SIGHUP) return signal;
    server.Reload();
    server.core().log->Event(JobLog::Level::kInfo, "reloaded", {{"signal", strsignal(signal)}});
  }
}

int Run() {
  const sigset_t signals = BlockSignals();
  WatchGrpcLog();
  RaiseFileLimit();
  absl::StatusOr<std::unique_ptr<Server>> server = Server::Start(OptionsFromFlags());
  if (!server.ok()) {
    return Fail(server.status(),
                absl::IsInvalidArgument(server.status()) ? kExitUsage : kExitStart);
  }
  std::printf("listening on port %d\n", (*server)->port());
  if ((*server)->metrics_port() != 0)
    std::printf("metrics on port %d\n", (*server)->metrics_port());
  std::fflush(stdout);
  JobLog& log = *(*server)->core().log;
  log.Event(JobLog::Level::kInfo, "started",
            {{"version", kVersion}, {"port", absl::StrCat((*server)->port())}});

  const int signal = WaitForEnd(signals, **server);
  const bool port_lost = signal == kPortLost;
  if (port_lost) {
    log.Event(JobLog::Level::kError, "port_lost",
              {{"message", "no file descriptor for a new connection; ends, to be started again"}});
  }
  log.Event(JobLog::Level::kInfo, "draining", {{"signal", strsignal(signal)}});
  std::thread([signals] {
    int second = kPortLost;
    while (second == kPortLost || second == SIGHUP) sigwait(&signals, &second);
    std::_Exit(128 + second);
  }).detach();
  const bool all_done = (*server)->Drain(DrainTimeout());
  log.Event(all_done ? JobLog::Level::kInfo : JobLog::Level::kWarning, "stopped",
            {{"jobs_cut_off", all_done ? "no" : "yes"}});
  return port_lost ? kExitStart : 0;
}

}  // namespace
}  // namespace traverse

int main(int argc, char** argv) {
  const absl::StatusOr<std::string> text =
      traverse::ReadFlags(std::vector<std::string>(argv + 1, argv + argc));
  if (!text.ok()) return traverse::Fail(text.status(), traverse::kExitUsage);
  if (text->empty()) return traverse::Run();
  std::fputs(text->c_str(), stdout);
  return 0;
}

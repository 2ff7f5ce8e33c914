// traverse-server: flags, signals, exit code; nothing else.

#include <grpc/support/log.h>
#include <signal.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include "absl/strings/str_cat.h"
#include "server/server.h"
#include "server/server_flags.h"
#include "server/version.h"

namespace traverse {
namespace {

// Exit codes.
constexpr int kExitStart = 1;
constexpr int kExitUsage = 2;

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

int Fail(const absl::Status& status, int exit_code) {
  std::fprintf(stderr, "traverse-server: %s\n", std::string(status.message()).c_str());
  return exit_code;
}

int Run() {
  const sigset_t signals = BlockSignals();
  QuietGrpc();
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

  int signal = 0;
  sigwait(&signals, &signal);
  log.Event(JobLog::Level::kInfo, "draining", {{"signal", strsignal(signal)}});
  std::thread([signals] {
    int second = 0;
    sigwait(&signals, &second);
    std::_Exit(128 + second);
  }).detach();
  const bool all_done = (*server)->Drain(DrainTimeout());
  log.Event(all_done ? JobLog::Level::kInfo : JobLog::Level::kWarning, "stopped",
            {{"jobs_cut_off", all_done ? "no" : "yes"}});
  return 0;
}

}  // namespace
}  // namespace traverse

int main(int argc, char** argv) {
  if (const absl::Status status = traverse::ReadFlags(argc, argv); !status.ok()) {
    return traverse::Fail(status, traverse::kExitUsage);
  }
  return traverse::Run();
}

// traverse-server: flags, signals, exit code; nothing else.

#include <google/protobuf/stubs/logging.h>
#include <grpc/support/log.h>
#include <signal.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "server/ops/daemon.h"
#include "server/server.h"
#include "server/server_flags.h"

namespace traverse {
namespace {

// What the process sends itself when its port is lost.
constexpr int kPortLost = SIGUSR1;

// gRPC prints its own text for every error; ours are on one line. Its variables bring gRPC's back.
//
// One of its errors matters: if a connection cannot be accepted for lack of file descriptors, gRPC
// 1.51 gives up the port for good and goes on. Only its log says so.
void WatchGrpcLog() {
  static const bool print =
      std::getenv("GRPC_VERBOSITY") != nullptr || std::getenv("GRPC_TRACE") != nullptr;
  gpr_set_log_function([](gpr_log_func_args* line) {
    if (print) std::fprintf(stderr, "%s:%d %s\n", line->file, line->line, line->message);
    if (std::strncmp(line->message, "Failed accept4", 14) == 0) kill(getpid(), kPortLost);
  });
}

int Run(const Daemon& daemon) {
  WatchGrpcLog();
  google::protobuf::SetLogHandler(nullptr);  // a line for each text of a caller that is not UTF-8
  absl::StatusOr<std::unique_ptr<Server>> server = Server::Start(OptionsFromFlags());
  if (!server.ok()) return daemon.Fail(server.status());
  std::printf("listening on port %d\n", (*server)->port());
  if ((*server)->metrics_port() != 0)
    std::printf("metrics on port %d\n", (*server)->metrics_port());
  std::fflush(stdout);
  JobLog& log = *(*server)->core().files.log;
  daemon.LogStart(log, (*server)->port(), FewFiles());

  const int signal = daemon.WaitForEnd(log, [&] { (*server)->Reload(); });
  const bool port_lost = signal == kPortLost;
  if (port_lost) {
    log.Event(JobLog::Level::kError, "port_lost",
              {{"message", "no file descriptor for a new connection; ends, to be started again"}});
  }
  daemon.BeginDraining(signal, log);
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
  const traverse::Daemon daemon("traverse-server", traverse::kPortLost);
  if (!text.ok()) return daemon.Fail(text.status());
  if (text->empty()) return traverse::Run(daemon);
  std::fputs(text->c_str(), stdout);
  return 0;
}

// traverse-gateway: only flags, signals and the exit code.

#include <google/protobuf/stubs/logging.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "client/gateway/gateway.h"
#include "client/gateway/gateway_flags.h"
#include "server/ops/daemon.h"

namespace traverse::gateway {
namespace {

int Run(const Daemon& daemon) {
  // Both print what our own messages already say.
  google::protobuf::SetLogHandler(nullptr);
  setenv("GRPC_VERBOSITY", "NONE", /*overwrite=*/0);
  const absl::StatusOr<GatewayOptions> options = OptionsFromFlags();
  if (!options.ok()) return daemon.Fail(options.status());
  absl::StatusOr<std::unique_ptr<Gateway>> gateway = Gateway::Start(*options);
  if (!gateway.ok()) return daemon.Fail(gateway.status());
  std::printf("HTTP on port %d\n", (*gateway)->http_port());
  if ((*gateway)->grpc_port() != 0) std::printf("gRPC on port %d\n", (*gateway)->grpc_port());
  if ((*gateway)->metrics_port() != 0) {
    std::printf("metrics on port %d\n", (*gateway)->metrics_port());
  }
  std::fflush(stdout);
  JobLog& log = *(*gateway)->core().files.log;
  daemon.LogStart(log, (*gateway)->http_port(), options->few_files);

  const int signal = daemon.WaitForEnd(log, [&] { (*gateway)->Reload(); });
  daemon.BeginDraining(signal, log);
  const bool all_done = (*gateway)->Drain(DrainTimeout());
  log.Event(all_done ? JobLog::Level::kInfo : JobLog::Level::kWarning, "stopped",
            {{"requests_cut_off", all_done ? "no" : "yes"}});
  if (!all_done) {
    std::fflush(nullptr);
    std::_Exit(0);  // leaves nothing behind: the spool's files have no names
  }
  return 0;
}

}  // namespace
}  // namespace traverse::gateway

int main(int argc, char** argv) {
  const absl::StatusOr<std::string> text =
      traverse::gateway::ReadFlags(std::vector<std::string>(argv + 1, argv + argc));
  const traverse::Daemon daemon("traverse-gateway");
  if (!text.ok()) return daemon.Fail(text.status());
  if (text->empty()) return traverse::gateway::Run(daemon);
  std::fputs(text->c_str(), stdout);
  return 0;
}

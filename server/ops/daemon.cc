#include "server/ops/daemon.h"

#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/ops/memory.h"
#include "server/version.h"

namespace traverse {
namespace {

// Each connection takes a file, and other work may too.
void RaiseFileLimit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);
}

}  // namespace

Daemon::Daemon(std::string name, int also_ends) : name_(std::move(name)), also_ends_(also_ends) {
  sigemptyset(&signals_);
  for (const int one : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&signals_, one);
  if (also_ends != 0) sigaddset(&signals_, also_ends);
  pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
  signal(SIGPIPE, SIG_IGN);
  RaiseFileLimit();
  GiveLargeBlocksBack();
}

int Daemon::Fail(const absl::Status& status) const {
  std::fprintf(stderr, "%s: %s\n", name_.c_str(), std::string(status.message()).c_str());
  return absl::IsInvalidArgument(status) ? kExitUsage : kExitStart;
}

void Daemon::LogStart(JobLog& log, int port, const std::string& few_files) const {
  log.Event(JobLog::Level::kInfo, "started", {{"version", kVersion}, {"port", absl::StrCat(port)}});
  if (few_files.empty()) return;
  log.Event(JobLog::Level::kWarning, "few_files", {{"message", few_files}});
}

int Daemon::WaitForEnd(JobLog& log, const std::function<void()>& reload) const {
  int signal = SIGHUP;
  while (true) {
    sigwait(&signals_, &signal);
    if (signal != SIGHUP) return signal;
    reload();
    log.Event(JobLog::Level::kInfo, "reloaded", {{"signal", strsignal(signal)}});
  }
}

void Daemon::BeginDraining(int signal, JobLog& log) const {
  log.Event(JobLog::Level::kInfo, "draining", {{"signal", strsignal(signal)}});
  std::thread([signals = signals_, also_ends = also_ends_] {
    int second = SIGHUP;
    while (second == SIGHUP || second == also_ends) sigwait(&signals, &second);
    std::_Exit(128 + second);
  }).detach();
}

}  // namespace traverse

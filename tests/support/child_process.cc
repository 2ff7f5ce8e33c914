#include "tests/support/child_process.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>

namespace traverse::testing {
namespace {

// Waits until `fd` can be read. Returns whether it can.
bool Readable(int fd, std::chrono::milliseconds patience) {
  const auto end = std::chrono::steady_clock::now() + patience;
  pollfd polled{fd, POLLIN, 0};
  while (true) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        end - std::chrono::steady_clock::now());
    const int ready = poll(&polled, 1, static_cast<int>(std::max<int64_t>(0, left.count())));
    if (ready != -1 || errno != EINTR) return ready == 1;
  }
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& arguments) {
  const int errors = open(stderr_path_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  int pipe_ends[2];
  if (errors < 0 || pipe2(pipe_ends, O_CLOEXEC) != 0) std::abort();
  stdout_ = pipe_ends[0];
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  pid_ = fork();
  if (pid_ < 0) std::abort();
  if (pid_ == 0) {
    // Ends with the test, however that ends.
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    dup2(pipe_ends[1], STDOUT_FILENO);
    dup2(errors, STDERR_FILENO);
    execv(argv[0], argv.data());
    _exit(127);
  }
  close(pipe_ends[1]);
  close(errors);
}

ChildProcess::~ChildProcess() {
  if (pid_ > 0) {
    Signal(SIGKILL);
    Wait();
  }
  close(stdout_);
}

void ChildProcess::GiveUp(const char* what) const {
  Signal(SIGKILL);
  ADD_FAILURE() << "process " << pid_ << " did not " << what << "; its stderr:\n" << Errors();
}

std::string ChildProcess::ReadLine(std::chrono::milliseconds patience) {
  std::string line;
  for (char c = 0; Readable(stdout_, patience);) {
    if (read(stdout_, &c, 1) != 1 || c == '\n') return line;
    line.push_back(c);
  }
  GiveUp("print a line");
  return "";
}

void ChildProcess::Signal(int signal) const {
  if (pid_ > 0) kill(pid_, signal);
}

int ChildProcess::Wait(std::chrono::milliseconds patience) {
  if (pid_ <= 0) return -1;
  const int end = static_cast<int>(syscall(SYS_pidfd_open, pid_, 0));
  if (!Readable(end, patience)) GiveUp("end");
  close(end);
  int status = 0;
  if (waitpid(pid_, &status, 0) != pid_) return -1;
  pid_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::string ChildProcess::Errors() const {
  std::ifstream file(stderr_path_);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace traverse::testing

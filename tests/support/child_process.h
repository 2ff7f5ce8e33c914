// A program run by a test.
//
//   ChildProcess server({path, "--listen=127.0.0.1:0"});
//   const std::string line = server.ReadLine();      // "listening on port 41234"
//   server.Signal(SIGTERM);
//   EXPECT_EQ(server.Wait(), 0);

#ifndef TRAVERSE_TESTS_SUPPORT_CHILD_PROCESS_H_
#define TRAVERSE_TESTS_SUPPORT_CHILD_PROCESS_H_

#include <sys/types.h>

#include <chrono>
#include <string>
#include <vector>

#include "tests/support/scratch_folder.h"

namespace traverse::testing {

// Runs from construction to its end; killed by the destructor if it still runs. Its stdout is read
// by the test, its stderr goes to a file. Not thread-safe.
//
// No test waits for it forever: a process that says nothing, or does not end, within kPatience is
// killed, and the test fails with what the process wrote to stderr.
class ChildProcess {
 public:
  static constexpr std::chrono::seconds kPatience{60};

  explicit ChildProcess(const std::vector<std::string>& arguments);
  ~ChildProcess();

  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t pid() const { return pid_; }

  // The next line of stdout without its end; empty at the end of the output, and if no more of it
  // comes within `patience`.
  std::string ReadLine(std::chrono::milliseconds patience = kPatience);

  void Signal(int signal) const;

  // Waits for the end. Returns the exit code, or 128 + the signal that ended it: 128 + SIGKILL
  // after `patience`.
  int Wait(std::chrono::milliseconds patience = kPatience);

  // What was written to stderr so far.
  std::string Errors() const;

 private:
  // The process has not done `what` in time: kills it and fails the test.
  void GiveUp(const char* what) const;

  pid_t pid_ = -1;
  int stdout_ = -1;
  const ScratchFolder scratch_;
  const std::string stderr_path_ = scratch_.Path("stderr");
};

}  // namespace traverse::testing

#endif  // TRAVERSE_TESTS_SUPPORT_CHILD_PROCESS_H_

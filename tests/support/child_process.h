// A program run by a test.
//
//   ChildProcess server({path, "--listen=127.0.0.1:0"});
//   const std::string line = server.ReadLine();      // "listening on port 41234"
//   server.Signal(SIGTERM);
//   EXPECT_EQ(server.Wait(), 0);

#ifndef TRAVERSE_TESTS_SUPPORT_CHILD_PROCESS_H_
#define TRAVERSE_TESTS_SUPPORT_CHILD_PROCESS_H_

#include <sys/types.h>

#include <string>
#include <vector>

#include "tests/support/scratch_folder.h"

namespace traverse::testing {

// Runs from construction to its end; killed by the destructor if it still runs. Its stdout is read
// by the test, its stderr goes to a file. Not thread-safe.
class ChildProcess {
 public:
  explicit ChildProcess(const std::vector<std::string>& arguments);
  ~ChildProcess();

  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t pid() const { return pid_; }

  // The next line of stdout without its end; empty at the end of the output.
  std::string ReadLine();

  void Signal(int signal) const;

  // Waits for the end. Returns the exit code, or 128 + the signal that ended it.
  int Wait();

  // What was written to stderr so far.
  std::string Errors() const;

 private:
  pid_t pid_ = -1;
  int stdout_ = -1;
  const ScratchFolder scratch_;
  const std::string stderr_path_ = scratch_.Path("stderr");
};

}  // namespace traverse::testing

#endif  // TRAVERSE_TESTS_SUPPORT_CHILD_PROCESS_H_

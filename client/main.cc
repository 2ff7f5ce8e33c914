#include <unistd.h>

#include <csignal>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "client/cli/command.h"
#include "client/files/process_memory.h"

namespace {

// Whichever thread it is. Takes no memory, and leaves no output: that appears in one step at the
// end.
void EndForLackOfMemory() {
  constexpr std::string_view kLine = "traverse: out of memory\n";
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kLine.data(), kLine.size());
  _exit(1);
}

}  // namespace

int main(int argc, char** argv) {
  std::set_new_handler(EndForLackOfMemory);
  // A file that may not become as large is a failed write, with a message.
  std::signal(SIGXFSZ, SIG_IGN);
  traverse::KeepFreedMemory();
  return traverse::cli::Main(std::vector<std::string>(argv + 1, argv + argc));
}

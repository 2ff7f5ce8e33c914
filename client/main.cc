#include <string>
#include <vector>

#include "client/cli/command.h"
#include "client/files/process_memory.h"

int main(int argc, char** argv) {
  traverse::KeepFreedMemory();
  return traverse::cli::Main(std::vector<std::string>(argv + 1, argv + argc));
}

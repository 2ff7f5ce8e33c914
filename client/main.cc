#include <string>
#include <vector>

#include "client/cli/command.h"

int main(int argc, char** argv) {
  return traverse::cli::Main(std::vector<std::string>(argv + 1, argv + argc));
}

// What the strategies find, how fast, and how that grows: the tables of tests/bench/run.sh.
//
//   build/release/tests/bench/layers/layers_bench [--quick] [--parts=part2,st200] [--seeds=5]
//       [--threads=N] [--sections=routes,time,tenth,threads,growth,memory,deadlines]
//       [--deadlines=1000]
//
// Prints Markdown. Exit code 1 if a route was invalid, `auto` was longer than greedy, or, on a
// machine with nothing else to do, an answer was late.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <thread>

#include "absl/strings/str_split.h"
#include "tests/bench/layers/sections.h"

namespace traverse::bench {
namespace {

bool Parse(int argc, char** argv, BenchOptions& options) {
  options.threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const size_t equals = argument.find('=');
    const std::string name = argument.substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : argument.substr(equals + 1);
    if (name == "--quick") {
      options.quick = true;
      options.seeds = 1;
      options.deadlines = 20;
      options.parts = {"part1", "part2", "s1_block", "s3_bracket", "st200"};
    } else if (name == "--parts") {
      options.parts = absl::StrSplit(value, ',');
    } else if (name == "--sections") {
      options.sections = absl::StrSplit(value, ',');
    } else if (name == "--seeds") {
      options.seeds = std::max(1, std::atoi(value.c_str()));
    } else if (name == "--threads") {
      options.threads = std::max(1, std::atoi(value.c_str()));
    } else if (name == "--deadlines") {
      options.deadlines = std::max(1, std::atoi(value.c_str()));
    } else {
      return false;
    }
  }
  return true;
}

int Main(int argc, char** argv) {
  BenchOptions options;
  if (!Parse(argc, argv, options)) {
    std::fprintf(stderr, "see the head of tests/bench/layers/layers_bench.cc\n");
    return 2;
  }
  const auto parts = BundledParts(options.parts);
  if (!parts.ok()) {
    std::fprintf(stderr, "%s\n", parts.status().ToString().c_str());
    return 2;
  }
  bool good = true;
  for (const std::string& section : options.sections) {
    if (section == "routes") good = PrintRoutes(*parts, options) && good;
    if (section == "time") good = PrintTime(*parts, options) && good;
    if (section == "tenth") good = PrintFirstTenth(*parts, options) && good;
    if (section == "threads") good = PrintThreads(*parts, options) && good;
    if (section == "growth") good = PrintGrowth(options) && good;
    if (section == "memory") good = PrintMemory(options) && good;
    if (section == "deadlines") good = PrintDeadlines(*parts, options) && good;
  }
  return good ? 0 : 1;
}

}  // namespace
}  // namespace traverse::bench

int main(int argc, char** argv) { return traverse::bench::Main(argc, argv); }

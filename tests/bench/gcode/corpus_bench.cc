// What optimising sliced files gains, file by file and by slicer: travel, retractions and estimated
// print time before and after, and whether the result was verified.
//
//   build/release/tests/bench/gcode/gcode_corpus_bench [--policies=safe,balanced,free,fast]
//       [--strategy=auto] [--threads=2] [--json=FILE] [FOLDER or FILE]...
//
// Without files: those of tests/data/gcode. Prints Markdown. Exit code 1 if a file could not be
// read, or a result is not equivalent, is slower, or saves another time than was found.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/strings/str_split.h"
#include "client/api/embedded.h"
#include "client/files/write_file.h"
#include "tests/bench/gcode/corpus_run.h"
#include "tests/bench/gcode/corpus_table.h"
#include "tests/support/source_dir.h"

namespace traverse::bench {
namespace {

struct Arguments {
  std::vector<gcode::Policy> policies = {gcode::Policy::kSafe, gcode::Policy::kBalanced,
                                         gcode::Policy::kFree, gcode::Policy::kFast};
  std::string strategy = "auto";
  std::string json;
  int threads = 2;
  std::vector<std::string> files;
};

// False if `path` is a folder without sliced files.
bool AddFiles(const std::string& path, std::vector<std::string>& files) {
  if (!std::filesystem::is_directory(path)) {
    files.push_back(path);
    return true;
  }
  const size_t before = files.size();
  for (const auto& entry : std::filesystem::directory_iterator(path)) {
    if (entry.path().filename().string().find(".gcode") != std::string::npos) {
      files.push_back(entry.path().string());
    }
  }
  if (files.size() > before) return true;
  std::fprintf(stderr, "%s: no sliced files in this folder\n", path.c_str());
  return false;
}

bool Parse(int argc, char** argv, Arguments& arguments) {
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const size_t equals = argument.find('=');
    const std::string name = argument.substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : argument.substr(equals + 1);
    if (name == "--policies") {
      arguments.policies.clear();
      const std::vector<std::string> names = absl::StrSplit(value, ',');
      for (const std::string& policy : names) {
        const auto known = gcode::PolicyOfName(policy);
        if (!known) return false;
        arguments.policies.push_back(*known);
      }
    } else if (name == "--strategy") {
      arguments.strategy = value;
    } else if (name == "--json") {
      arguments.json = value;
    } else if (name == "--threads") {
      arguments.threads = std::max(1, std::atoi(value.c_str()));
    } else if (name.starts_with("-")) {
      return false;
    } else if (!AddFiles(argument, arguments.files)) {
      return false;
    }
  }
  const char* usual = TRAVERSE_SOURCE_DIR "/tests/data/gcode";
  if (arguments.files.empty() && !AddFiles(usual, arguments.files)) return false;
  std::sort(arguments.files.begin(), arguments.files.end());
  return true;
}

bool MeetsPromises(const CorpusRun& run) {
  if (!run.fault.empty() || Saved(run.before.seconds, run.after.seconds) < -1e-6) return false;
  // Of less, rounding is a large part.
  constexpr double kTellingSeconds = 5;
  constexpr double kMostOff = 0.02;
  const double written = run.before.seconds - run.after.seconds;
  return written < kTellingSeconds || std::abs(run.found_seconds / written - 1) < kMostOff;
}

int Main(int argc, char** argv) {
  Arguments arguments;
  if (!Parse(argc, argv, arguments)) {
    std::fprintf(stderr, "see the head of tests/bench/gcode/corpus_bench.cc\n");
    return 2;
  }
  auto service = EmbeddedService::Start(arguments.threads);
  if (!service.ok()) {
    std::fprintf(stderr, "%s\n", service.status().ToString().c_str());
    return 1;
  }
  OptimizerClient client((*service)->channel());
  std::vector<CorpusRun> runs;
  bool good = true;
  for (const gcode::Policy policy : arguments.policies) {
    for (const std::string& file : arguments.files) {
      absl::StatusOr<CorpusRun> run = RunFile(file, policy, arguments.strategy, client);
      if (!run.ok()) {
        std::fprintf(stderr, "%s: %s\n", file.c_str(), run.status().ToString().c_str());
        good = false;
        continue;
      }
      good = good && MeetsPromises(*run);
      runs.push_back(*std::move(run));
    }
  }
  std::printf("%s", CorpusTable(runs).c_str());
  if (!arguments.json.empty()) good = WriteWholeFile(arguments.json, CorpusJson(runs)).ok() && good;
  return good ? 0 : 1;
}

}  // namespace
}  // namespace traverse::bench

int main(int argc, char** argv) { return traverse::bench::Main(argc, argv); }

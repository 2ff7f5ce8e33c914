// How fast a large sliced file is read, optimised, written and verified, and in how much memory.
//
//   build/release/tests/bench/gcode/gcode_speed_bench FILE [MB] [STRATEGY]
//
// FILE (relative E, or with G92 E0 in each layer) is repeated from its second layer mark on until
// it has MB megabytes (100), and optimised as `traverse optimize --strategy=ni2opt` does. Prints,
// phase by phase, MB/s of wall time and CPU seconds, and the peak memory per byte of input.

#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include "client/api/embedded.h"
#include "client/api/optimizer_client.h"
#include "client/files/process_memory.h"
#include "client/files/read_file.h"
#include "client/files/write_file.h"
#include "client/formats/read_input.h"
#include "client/gcode/gcode_job.h"
#include "client/gcode/parallel.h"
#include "client/gcode/rewrite.h"
#include "client/input/input_job.h"

namespace traverse::bench {
namespace {

double Wall() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

double Cpu() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

class Phases {
 public:
  explicit Phases(double megabytes) : megabytes_(megabytes) {}

  void Done(const char* name) {
    const double wall = Wall();
    const double cpu = Cpu();
    Print(name, wall - wall_, cpu - cpu_);
    wall_ = wall;
    cpu_ = cpu;
  }

  void Finish() const {
    Print("total", Wall() - first_wall_, Cpu() - first_cpu_);
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    std::printf("peak memory %.1f bytes per byte\n",
                static_cast<double>(usage.ru_maxrss) * 1024 / (megabytes_ * 1e6));
  }

 private:
  void Print(const char* name, double wall, double cpu) const {
    std::printf("%-10s %7.2f s  %7.1f MB/s   CPU %7.2f s  %7.1f MB/s\n", name, wall,
                megabytes_ / wall, cpu, megabytes_ / cpu);
  }

  const double megabytes_;
  const double first_wall_ = Wall();
  const double first_cpu_ = Cpu();
  double wall_ = first_wall_;
  double cpu_ = first_cpu_;
};

// Repeats all layers of `text` but the first.
std::string Grown(const std::string& text, size_t bytes) {
  size_t mark = std::string::npos;
  for (const char* of_slicer : {"\n;LAYER_CHANGE", "\n;LAYER:1\n"}) {
    mark = text.find(of_slicer, std::min(text.find(of_slicer) + 1, text.size()));
    if (mark != std::string::npos) break;
  }
  const size_t foot = text.rfind("\nM107");
  if (mark == std::string::npos || foot == std::string::npos || foot <= mark) return text;
  const std::string body = text.substr(mark, foot - mark);
  std::string grown = text.substr(0, foot);
  while (grown.size() + body.size() < bytes) grown += body;
  return grown + text.substr(foot);
}

bool Run(const std::string& input, const std::string& strategy, double megabytes) {
  auto service = EmbeddedService::Start(gcode::DefaultThreads());
  if (!service.ok()) return false;
  OptimizerClient client((*service)->channel());
  Phases phases(megabytes);
  absl::StatusOr<InputJob> job = ReadInput(input);
  if (!job.ok()) return false;
  phases.Done("read");
  job->options.clear_strategy();
  job->options.mutable_strategy()->set_name(strategy);
  absl::StatusOr<JobResult> result = client.Optimize(job->options, job->layers);
  if (!result.ok()) return false;
  phases.Done("optimise");
  gcode::FileOrder found;
  for (size_t i = 0; i < result->layers.size(); ++i) {
    found.push_back(OrderOf(*job->gcode, i, result->layers[i]));
  }
  RewriteOptions options;
  options.threads = gcode::DefaultThreads();
  const auto rewrite = RewriteGcode(*job->gcode, found, options);
  if (!rewrite.ok()) return false;
  phases.Done("rewrite");
  if (!WriteWholeFile(input + ".out", rewrite->text).ok()) return false;
  phases.Done("write");
  phases.Finish();
  std::printf("%s\n", DescribeRewrite(*rewrite).c_str());
  return true;
}

int Main(int argc, char** argv) {
  if (argc < 2) return 2;
  KeepFreedMemory();  // as the command line does
  const double megabytes = argc > 2 ? std::atof(argv[2]) : 100;
  const std::string strategy = argc > 3 ? argv[3] : "ni2opt";
  const std::string input = std::filesystem::temp_directory_path() /
                            ("gcode_speed_bench." + std::to_string(getpid()) + ".gcode");
  size_t bytes = 0;
  {
    const absl::StatusOr<std::string> text = ReadWholeFile(argv[1]);
    if (!text.ok()) return 1;
    const std::string grown = Grown(*text, static_cast<size_t>(megabytes * 1e6));
    bytes = grown.size();
    if (!WriteWholeFile(input, grown).ok()) return 1;
  }
  const bool good = Run(input, strategy, static_cast<double>(bytes) / 1e6);
  std::filesystem::remove(input);
  std::filesystem::remove(input + ".out");
  return good ? 0 : 1;
}

}  // namespace
}  // namespace traverse::bench

int main(int argc, char** argv) { return traverse::bench::Main(argc, argv); }

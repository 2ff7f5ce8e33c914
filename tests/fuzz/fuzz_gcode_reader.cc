// Bytes as G-code, through the reader and what takes apart what it read.
//
// Rules: a refusal is the file's fault and names it; links and paths make up the text, each path is
// in one layer, and each plan does each path once.

#include <memory>
#include <string>
#include <vector>

#include "absl/strings/match.h"
#include "client/gcode/gcode_job.h"
#include "client/gcode/read/reader.h"
#include "client/input/input_job.h"
#include "tests/fuzz/support/check.h"
#include "tests/fuzz/support/gcode_mutator.h"

namespace traverse::fuzz {
namespace {

void CheckParts(const GcodeFile& file) {
  gcode::Offset at = 0;
  uint32_t block = 0;
  for (const gcode::Layer& layer : file.layers) {
    Check(layer.first_block == block && layer.end_block > block, "layers follow one another");
    for (; block < layer.end_block; ++block) {
      const gcode::Block& path = file.blocks[block];
      Check(path.begin >= at && path.end > path.begin, "paths follow one another");
      Check(path.end_count > 0, "a path has segments");
      at = path.end;
    }
  }
  Check(block == file.blocks.size() && at <= file.text.size(), "each path is in a layer");
}

// Each path is a leaf once; pairs of `before` go forwards in the order of the file.
void CheckPlan(const v1::Plan& plan) {
  std::vector<int> leaves(static_cast<size_t>(plan.paths_size()));
  for (const v1::PlanNode& node : plan.nodes()) {
    if (node.has_path()) {
      Check(node.path() < leaves.size(), "a leaf is a path");
      ++leaves[node.path()];
    }
    for (const v1::Precedence& pair : node.any_order().before()) {
      const auto children = static_cast<uint32_t>(node.any_order().children_size());
      Check(pair.first() < pair.second() && pair.second() < children, "`before` goes forwards");
    }
  }
  for (const int count : leaves) Check(count == 1, "a path is a leaf once");
}

void CheckJob(const std::shared_ptr<GcodeFile>& file, gcode::Policy policy) {
  GcodeOptions options;
  options.policy = policy;
  const InputJob job = MakeGcodeJob(file, options);
  Check(job.layers.size() == file->layers.size(), "a plan for each layer");
  for (const v1::Layer& layer : job.layers) CheckPlan(layer.plan());
}

}  // namespace
}  // namespace traverse::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace traverse;
  const auto file = ReadGcode(std::string(reinterpret_cast<const char*>(data), size), "in.gcode");
  if (!file.ok()) {
    fuzz::Check(absl::IsInvalidArgument(file.status()), file.status().ToString());
    fuzz::Check(absl::StartsWith(file.status().message(), "in.gcode:"), file.status().ToString());
    return 0;
  }
  fuzz::CheckParts(**file);
  const auto policy = static_cast<gcode::Policy>(size % 3);
  fuzz::CheckJob(*file, policy);
  return 0;
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size,
                                          unsigned int seed) {
  return traverse::fuzz::MutateGcode(data, size, max_size, seed);
}

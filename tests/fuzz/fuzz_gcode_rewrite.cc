// Bytes as G-code, read, written with its paths in random orders, and verified.
//
// Rules: what is returned as rewritten is verified, is read again, and extrudes as far as before;
// what cannot be rewritten is refused with the first difference.

#include <cmath>
#include <string_view>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/gcode/measure/layer_meter.h"
#include "client/gcode/plan/layer_plan.h"
#include "client/gcode/read/reader.h"
#include "client/gcode/rewrite.h"
#include "engine/base/rng.h"
#include "tests/client/gcode/support/random_order.h"
#include "tests/client/gcode/support/verified.h"
#include "tests/fuzz/support/check.h"
#include "tests/fuzz/support/gcode_mutator.h"

namespace traverse::fuzz {
namespace {

void CheckSamePrint(const GcodeFile& file, const std::string& text, bool returned) {
  const absl::Status same = VerifyGcode(file.text, "original", text, "rewritten", OnlySamePrint());
  Check(same.ok(), absl::StrCat("what was rewritten is verified: ", same.ToString()));
  const auto again = ReadGcode(text, "rewritten");
  Check(again.ok(), absl::StrCat("what was rewritten can be read: ", again.status().ToString()));
  // Without M82 and M83 another order may hide how E counts: such a text is not returned.
  if (!returned && !gcode::CountAlike(file, **again)) return;
  const double before = gcode::Sum(gcode::MeasureLayers(file)).extruded_mm;
  const double after = gcode::Sum(gcode::MeasureLayers(**again)).extruded_mm;
  // Arcs may end a little beside their circle, and are then as long as the end that they begin at
  // says.
  Check(std::abs(before - after) <= 1e-3 * (1 + before),
        absl::StrCat("extrudes as far as before: ", before, " mm, ", after, " mm"));
}

gcode::FileOrder RandomOrders(const GcodeFile& file, gcode::Policy policy, uint64_t seed) {
  Rng rng(seed);
  gcode::FileOrder orders;
  for (const gcode::Layer& layer : file.layers) {
    orders.push_back(
        gcode::testing::RandomOrder(layer, gcode::MakeLayerPlan(file, layer, policy).plan, rng));
  }
  return orders;
}

}  // namespace
}  // namespace traverse::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace traverse;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto file = ReadGcode(std::string(bytes), "in.gcode");
  if (!file.ok()) return 0;
  const uint64_t seed = std::hash<std::string_view>{}(bytes);
  RewriteOptions options;
  options.policy = static_cast<gcode::Policy>(seed % 3);
  const auto found = fuzz::RandomOrders(**file, options.policy, seed);
  const auto rewrite = RewriteGcode(**file, found, options);
  if (rewrite.ok()) {
    fuzz::CheckSamePrint(**file, rewrite->text, /*returned=*/true);
    fuzz::Check(rewrite->after.seconds <= rewrite->before.seconds, "no print gets slower");
  } else {
    fuzz::Check(absl::IsFailedPrecondition(rewrite.status()), rewrite.status().ToString());
  }
  // No layer keeps its order for being better.
  const std::string shuffled = gcode::testing::Shuffled(**file, options.policy, seed);
  if (VerifyGcode((*file)->text, "original", shuffled, "shuffled", OnlySamePrint()).ok()) {
    fuzz::CheckSamePrint(**file, shuffled, /*returned=*/false);
  }
  return 0;
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size,
                                          unsigned int seed) {
  return traverse::fuzz::MutateGcode(data, size, max_size, seed);
}

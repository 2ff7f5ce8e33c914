// The verifier's heights of what stands: client/gcode/verify/match/height_grid.h.

#include "client/gcode/verify/match/height_grid.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <string>

namespace traverse::gcode {
namespace {

// The most memory that the process used, in KiB.
int64_t PeakKib() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    int64_t kib = 0;
    if (word == "VmHWM:" && status >> kib) return kib;
  }
  return 0;
}

TEST(HeightGrid, OfALargePlateTakesLittleMemory) {
  std::ofstream("/proc/self/clear_refs") << 5 << std::flush;  // the peak is what is used now
  const int64_t before_kib = PeakKib();
  HeightGrid tip(0.5, {.base_mm = 0.4, .most_mm = 2.4, .slack_mm = 0.5, .is_tip = true});
  HeightGrid head(2, {.least_excess_mm = 2, .base_mm = 30, .most_mm = 30, .slack_mm = 3});

  // A plate of 400 mm and 1,500 layers; the height goes down now and then.
  for (int layer = 0; layer < 1500; ++layer) {
    const double z = 0.2 * (1 + layer % 100);
    for (HeightGrid* grid : {&tip, &head}) {
      if (layer % 100 == 0) grid->ForgetVisits();
      for (int line = layer % 4; line < 800; line += 40) {
        grid->Print({line * 0.5, 0}, {line * 0.5, 400}, z);
        grid->Visit({0, line * 0.5}, z, {400, line * 0.5}, z);
      }
    }
  }

  EXPECT_TRUE(tip.NearestHit({1.25, 1}, 0.2, {1.25, 390}, 0.2));
  EXPECT_LT(PeakKib() - before_kib, 20 << 10);
}

}  // namespace
}  // namespace traverse::gcode

// What a retraction costs in a search.

#include <gtest/gtest.h>

#include <string>

#include "client/gcode/gcode_job.h"
#include "client/input/input_job.h"
#include "tests/client/gcode/support/sketch.h"

namespace traverse::gcode {
namespace {

// Four layers of lines; filament is pulled back by 0.8 mm before each and pushed by `primed`.
InputJob Lines(const std::string& primed) {
  testing::Sketch sketch;
  for (const char* z : {".2", ".4", ".6", ".8"}) {
    sketch.Add(";LAYER_CHANGE").Add(std::string("G1 Z") + z + " F9000");
    for (const double x : {0.0, 30.0, 10.0, 40.0, 20.0}) {
      sketch.Add("G1 E-.8 F2100").Go(x, 5).Add("G1 E" + primed + " F2100").Infill(x, 35);
    }
  }
  return MakeGcodeJob(sketch.Read(), {});
}

// Then a layer keeps its number of retractions. The second search looks for orders at the usual
// price, so that there are some with more and some with fewer.
TEST(RetractionPrice, IsNoneInTheFirstSearchWherePrimesPushMoreThanWasPulledBack) {
  for (const bool more : {false, true}) {
    const InputJob job = Lines(more ? ".82" : ".8");

    const double first = job.layers[2].cost().time().retraction_seconds();
    const double second = NarrowLayers(job, {})[2].cost().time().retraction_seconds();

    EXPECT_EQ(first > 0, !more);
    EXPECT_GT(second, 0);
  }
}

}  // namespace
}  // namespace traverse::gcode

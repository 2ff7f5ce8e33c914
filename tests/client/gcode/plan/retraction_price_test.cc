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

// Then a layer keeps its number of retractions.
TEST(RetractionPrice, IsNoneWherePrimesPushMoreThanWasPulledBack) {
  for (const bool more : {false, true}) {
    const InputJob job = Lines(more ? ".82" : ".8");

    EXPECT_EQ(job.layers[2].cost().time().retraction_seconds() > 0, !more);
  }
}

}  // namespace
}  // namespace traverse::gcode

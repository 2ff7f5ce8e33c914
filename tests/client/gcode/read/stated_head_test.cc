// What files state about the machine's head, as the reader and the verifier find it apart.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "client/gcode/machine/machine_profile.h"
#include "client/gcode/verify/match/layer_pair.h"

namespace traverse::gcode {
namespace {

struct Head {
  double reach_mm = 0;
  double above_tip_mm = 0;
};

// As both find it, with the verifier's own values where it is not stated; -1 if they do not agree.
Head HeadIn(const std::string& text) {
  const SlicerSettings unstated;
  const MachineProfile profile = ReadProfile(text);
  const SlicerSettings settings = ReadSettings(text);
  const auto both = [](double read, double verified) { return read == verified ? read : -1; };
  return {
      both(profile.clearance_radius.value_or(unstated.clearance_radius_mm),
           settings.clearance_radius_mm),
      both(profile.nozzle_height.value_or(unstated.nozzle_height_mm), settings.nozzle_height_mm)};
}

TEST(StatedHead, IsACircleInTheWordsOfPrusaSlicerAndOthers) {
  EXPECT_EQ(HeadIn("; extruder_clearance_radius = 45\n").reach_mm, 45);
  EXPECT_EQ(HeadIn("; extruder_clearance_max_radius = 68\n; nozzle_height = 4.7\n").reach_mm, 68);
  EXPECT_EQ(HeadIn("; extruder_clearance_max_radius = 68\n; nozzle_height = 4.7\n").above_tip_mm,
            4.7);
}

TEST(StatedHead, IsAPolygonInCuras) {
  const std::string polygon = "machine_head_with_fans_polygon = [[-20, 10], [12.5, 10], [12, -5]]";
  const double reach = std::hypot(20, 10);
  EXPECT_EQ(HeadIn(";" + polygon + "\n").reach_mm, reach);
  EXPECT_EQ(HeadIn("; " + polygon + "\r\n").reach_mm, reach);
  // The front end cuts its settings into lines amid a word.
  const std::string whole = "{\"global_quality\": \"[values]\\\\nmachine_head_shape = 7\\\\n" +
                            polygon + "\\\\nmachine_nozzle_head_distance = 5\\\\n\"}";
  for (size_t cut = 20; cut < whole.size() - 20; cut += 7) {
    const Head head =
        HeadIn(";SETTING_3 " + whole.substr(0, cut) + "\n;SETTING_3 " + whole.substr(cut) + "\n");
    EXPECT_EQ(head.reach_mm, reach) << cut;
    EXPECT_EQ(head.above_tip_mm, 5) << cut;
  }
}

TEST(StatedHead, IsUnknownWhereWhatIsStatedCannotBe) {
  const Head unknown = HeadIn("");
  for (const char* text : {"; machine_head_with_fans_polygon = []\n", "; nozzle_height = 0\n",
                           "; machine_head_with_fans_polygon = [[-2000, 10], [10, 10]]\n",
                           "; machine_head_with_fans_polygon = none\n"}) {
    EXPECT_EQ(HeadIn(text).reach_mm, unknown.reach_mm) << text;
    EXPECT_EQ(HeadIn(text).above_tip_mm, unknown.above_tip_mm) << text;
  }
}

}  // namespace
}  // namespace traverse::gcode

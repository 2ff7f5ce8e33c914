// Where travel joins the paths that it leads from and to. If it does not retract, the machine takes
// the corner there without a stop: how fast depends on the angle, and printing loses time by it as
// well.

#ifndef TRAVERSE_CLIENT_GCODE_PLAN_JOINTS_H_
#define TRAVERSE_CLIENT_GCODE_PLAN_JOINTS_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "client/gcode/model/gcode_file.h"
#include "client/gcode/model/outline.h"

namespace traverse::gcode {

// One end of a path. If the speed is 0, the machine stops there in any case.
struct Joint {
  Vertex along;           // the direction of printing, of length 1
  double speed_mm_s = 0;  // of printing, if it went straight on
  double accel_mm_s2 = 0;
};

// Those of a travel move.
struct WayJoints {
  Joint from;
  Joint to;
};

// What printing loses by a stop at `joint`.
double StopSeconds(const Joint& joint);

// All joints of one layer; paths by their index in it.
class LayerJoints {
 public:
  // `outlines` belong to `layer` and outlive the joints.
  LayerJoints(const GcodeFile& file, const Layer& layer, const std::vector<Outline>& outlines);

  // Where the path begins and ends if it is begun at `entry`: a vertex of a closed path; of an open
  // one 0, or 1 if it is reversed.
  Joint BeginOf(size_t path, uint32_t entry) const;
  Joint EndOf(size_t path, uint32_t entry) const;

 private:
  // How the first or the last segment of a path is printed.
  struct Pace {
    double speed_mm_s = 0;
    double accel_mm_s2 = 0;
    double corner_speed = 0;
  };
  struct Paces {
    Pace first;
    Pace last;
  };

  Joint JointAt(size_t path, uint32_t entry, bool at_end) const;

  const std::vector<Outline>& outlines_;
  std::vector<Paces> paces_;  // [path]
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_PLAN_JOINTS_H_

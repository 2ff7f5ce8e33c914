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
#include "client/gcode/plan/loop_stops.h"

namespace traverse::gcode {

// One end of a path. If the speed is 0, the machine stops there in any case.
struct Joint {
  Vertex along;           // the direction of printing, of length 1
  double speed_mm_s = 0;  // of printing, if it went straight on
  double accel_mm_s2 = 0;
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

  // What printing a closed path takes longer, in corners and short segments beyond the two joints,
  // if it is begun at `entry` instead of where it was: it passes its old start then, and stops at
  // `entry`. Below 0 if `entry` is the better place to stop. Of other paths 0.
  double RestartSeconds(size_t path, uint32_t entry) const;

 private:
  // How the first and the last segment of a path are printed.
  struct Paces {
    Pace first;
    Pace last;
  };

  Joint JointAt(size_t path, uint32_t entry, bool at_end) const;
  bool HasStops(size_t path) const;
  double StopBesideJoints(size_t path, uint32_t entry) const;

  const std::vector<Outline>& outlines_;
  std::vector<Paces> paces_;      // [path]
  std::vector<LoopStops> stops_;  // [path]; of loops, printed as their first segment is
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_PLAN_JOINTS_H_

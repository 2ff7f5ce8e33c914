// How long a composed link takes between the two paths that it joins: line by line, as it would be
// measured if it were printed.

#ifndef TRAVERSE_CLIENT_GCODE_LINK_LINK_METER_H_
#define TRAVERSE_CLIENT_GCODE_LINK_LINK_METER_H_

#include "client/gcode/link/new_link.h"
#include "client/gcode/measure/print_meter.h"
#include "client/gcode/model/gcode_file.h"
#include "client/gcode/model/part_start.h"
#include "client/gcode/plan/joints.h"

namespace traverse::gcode {

// Of one link.
class LinkMeter {
 public:
  // `file` outlives the meter. The machine is at `start` behind the path that ends with `joint`.
  LinkMeter(const GcodeFile& file, const PartStart& start, const Joint& joint);

  void Follow(const NewLink& link);

  // The seconds of the links, with what printing loses by them before and behind; the next path
  // begins with `joint`.
  double Finish(const Joint& joint);

 private:
  void FollowPart(const FilePart& part);
  void FollowLine(const LinkLine& line);
  void Set(const PrintState& state, SlotMask slots);
  void Print(const Joint& joint);

  const GcodeFile& file_;
  PartStart at_;
  PrintMeter meter_;
  double printing_seconds_ = 0;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_LINK_LINK_METER_H_

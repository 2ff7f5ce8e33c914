// The segments of one path, read again so that it can be written in another order.

#ifndef TRAVERSE_CLIENT_GCODE_MODEL_PATH_BODY_H_
#define TRAVERSE_CLIENT_GCODE_MODEL_PATH_BODY_H_

#include <string_view>
#include <vector>

#include "client/gcode/model/gcode_file.h"

namespace traverse::gcode {

struct BodySegment {
  Position from;
  Position to;
  Decimal filament = 0;
  Decimal feed = 0;
  uint32_t state = 0;    // index into PathBody::states
  uint8_t command = 1;   // 0 and 1: straight; 2, 3: an arc
  Decimal center_i = 0;  // for arcs with I or J: the center relative to `from`
  Decimal center_j = 0;
  Decimal radius = 0;  // for arcs with R
  bool by_radius = false;
  std::string_view comment;
};

struct PathBody {
  std::vector<BodySegment> segments;
  std::vector<PrintState> states;

  // How far the moves after the last segment go that extrude nothing; 0: there are none.
  double tail_length = 0;
};

PathBody ReadBody(const GcodeFile& file, const Block& block);

// The words of `segment`, which is an arc.
Command ArcCommand(const BodySegment& segment);

// Points on `segment` between its ends, in mm, so near to each other that the lines between them
// are as good; none unless it is an arc.
std::vector<Point> BendsOf(const BodySegment& segment, double unit_mm);

// The same segment from its end to its start.
BodySegment Reversed(const BodySegment& segment);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MODEL_PATH_BODY_H_

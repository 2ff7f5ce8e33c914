// What Policy::kFast would save, told from a few layers before anybody asks for it.

#ifndef TRAVERSE_CLIENT_GCODE_CHOOSE_FAST_FORECAST_H_
#define TRAVERSE_CLIENT_GCODE_CHOOSE_FAST_FORECAST_H_

#include <vector>

#include "client/gcode/choose/layer_column.h"
#include "client/gcode/link/link_donors.h"
#include "client/gcode/plan/head_room.h"
#include "client/gcode/plan/policy.h"
#include "client/gcode/plan/travel_model.h"

namespace traverse::gcode {

// The seconds of the travel of `file` that Policy::kFast would save, with what else `allow` allows.
// One path in sixteen is looked at, or three layers at the least: in layers whose retractions are
// as many as those of the layers around them, what was chosen is improved by the rules of that
// policy. 0 if there are fewer than three layers. `columns` have the layers, `travel` their travel;
// `donors` and `room` belong to `file`.
double SecondsSavedByFast(const GcodeFile& file, const std::vector<LayerColumn>& columns,
                          const std::vector<TravelModel>& travel, const LinkDonors& donors,
                          const HeadRoom& room, Allowance allow);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_CHOOSE_FAST_FORECAST_H_

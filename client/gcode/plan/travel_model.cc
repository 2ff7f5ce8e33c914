#include "client/gcode/plan/travel_model.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <utility>

#include "client/gcode/machine/motion_planner.h"
#include "client/gcode/measure/print_meter.h"
#include "client/gcode/model/part_start.h"
#include "client/gcode/parallel.h"

namespace traverse::gcode {
namespace {

// What each retraction adds to its travel, in seconds.
using Retractions = std::vector<double>;

// Those that last longer do something else as well, such as to change the filament.
double MostSeconds(Retractions seconds) {
  constexpr double kOtherwise = 4;  // times the median
  const auto middle = seconds.begin() + static_cast<ptrdiff_t>(seconds.size() / 2);
  std::nth_element(seconds.begin(), middle, seconds.end());
  return std::max(kOtherwise * *middle, *middle);  // rounding may be below 0
}

// The mean of the others: few may last longer than all of them.
double UsualSeconds(const Retractions& seconds) {
  const double most = MostSeconds(seconds);
  double sum = 0;
  size_t count = 0;
  for (const double each : seconds) {
    if (each > most) continue;
    sum += each;
    ++count;
  }
  return sum / static_cast<double>(count);
}

// Of the same links.
struct Additions {
  Retractions alone;  // without what the stops cost the travel
  Retractions altogether;

  bool empty() const { return alone.empty(); }
};

// What the links of one layer add up to.
struct LayerTravel {
  std::map<std::pair<double, double>, double> at_speed_mm;  // by speed and acceleration
  Additions between_paths;
  Additions at_marks;  // where scripts may change tools, prime and wait as well
};

class TravelLearner {
 public:
  explicit TravelLearner(const GcodeFile& file) : file_(file) {}

  LayerTravel LearnLayer(const Layer& layer) {
    LayerTravel learnt;
    for (uint32_t b = std::max(layer.first_block, 1u); b < layer.end_block; ++b) {
      LearnLink(b, learnt);
    }
    return learnt;
  }

 private:
  const Dynamics& DynamicsAt(uint32_t state) {
    const auto found = dynamics_.find(state);
    if (found != dynamics_.end()) return found->second;
    return dynamics_.emplace(state, DynamicsOf(file_.profile, file_.states[state], file_.setters))
        .first->second;
  }

  void LearnLink(uint32_t b, LayerTravel& learnt) {
    const Block& before = file_.blocks[b - 1];
    const Block& block = file_.blocks[b];
    if ((block.link & kLinkFixed) != 0) return;
    const bool retracts = (block.link & kLinkRetracts) != 0;
    Dynamics dynamics = DynamicsAt(before.state_out);
    Interpreter interpreter(std::string_view(file_.text).substr(0, block.begin), before.end,
                            StartBehind(file_, before).machine);
    PrintMeter all(file_.profile, dynamics, nullptr);
    PrintMeter travel(file_.profile, dynamics, nullptr);
    PrintMeter flowing(file_.profile, dynamics, nullptr);  // without stops
    for (Step step; interpreter.Next(step);) {
      const bool travels = step.kind == StepKind::kTravel || step.kind == StepKind::kSlot;
      if (retracts) all.Follow(step, interpreter);
      if (retracts && travels) travel.Follow(step, interpreter);
      if (retracts && travels) flowing.Follow(step, interpreter);
      if (MovesFilament(step.kind)) travel.Stop();
      LearnStep(step, interpreter, dynamics, learnt);
    }
    if (!retracts) return;
    const bool at_mark = (block.link & kLinkSplits) != 0;
    Additions& added = at_mark ? learnt.at_marks : learnt.between_paths;
    const double seconds = all.Finish().seconds;
    added.alone.push_back(seconds - travel.Finish().seconds);
    added.altogether.push_back(seconds - flowing.Finish().seconds);
  }

  void LearnStep(const Step& step, const Interpreter& interpreter, Dynamics& dynamics,
                 LayerTravel& learnt) {
    const MachineState& state = interpreter.state();
    const double unit = state.UnitMm();
    if (step.kind == StepKind::kSlot && (step.slots & kDynamicsSlots) != 0) {
      dynamics.Follow(step.line.Text(interpreter.text()));
    } else if (step.kind == StepKind::kTravel) {
      const double speed = std::min(ToDouble(state.feed) / 60 * unit, dynamics.max_speed());
      const double travelled_mm =
          std::hypot(ToDouble(state.at.x - step.from.x), ToDouble(state.at.y - step.from.y)) * unit;
      learnt.at_speed_mm[{speed, dynamics.travel_accel()}] += travelled_mm;
    }
  }

  const GcodeFile& file_;
  std::map<uint32_t, Dynamics> dynamics_;  // by state
};

}  // namespace

std::vector<TravelModel> LearnTravel(const GcodeFile& file, int threads) {
  std::vector<LayerTravel> layers(file.layers.size());
  ParallelFor(layers.size(), threads, [&file, &layers](size_t i) {
    layers[i] = TravelLearner(file).LearnLayer(file.layers[i]);
  });
  std::vector<TravelModel> models;
  TravelModel model;
  model.accel_mm_s2 = Dynamics(file.profile).travel_accel();
  bool from_paths = false;
  for (size_t layer = 0; layer < layers.size(); ++layer) {
    const LayerTravel& learnt = layers[layer];
    double longest_mm = 0;
    for (const auto& [how, at_speed_mm] : learnt.at_speed_mm) {
      if (at_speed_mm <= longest_mm || !(how.first > 0)) continue;
      longest_mm = at_speed_mm;
      model.speed_mm_s = how.first;
      model.accel_mm_s2 = how.second;
    }
    from_paths = from_paths || !learnt.between_paths.empty();
    const Additions& added = from_paths ? learnt.between_paths : learnt.at_marks;
    if (!added.empty()) {
      model.retraction_seconds = UsualSeconds(added.alone);
      model.retraction_price = UsualSeconds(added.altogether);
    }
    models.push_back(model);
  }
  return models;
}

namespace {

// Travel at the speed and acceleration of a model.
class TravelPlanner {
 public:
  TravelPlanner(const GcodeFile& file, uint32_t before, const TravelModel& model)
      : dynamics_(
            DynamicsOf(file.profile, file.states[file.blocks[before].state_out], file.setters)),
        model_(model),
        planner_({file.profile.klipper, dynamics_.cruise_ratio()}) {}

  void Go(double dx, double dy) {
    planner_.Move(dx, dy, model_.speed_mm_s, model_.accel_mm_s2, dynamics_.corner_speed());
  }

  double Seconds() {
    planner_.Stop();
    return planner_.seconds();
  }

 private:
  const Dynamics dynamics_;
  const TravelModel& model_;
  MotionPlanner planner_;
};

}  // namespace

double TravelSeconds(const GcodeFile& file, uint32_t block, const TravelModel& model) {
  assert(0 < block && block < file.blocks.size());
  TravelPlanner planner(file, block - 1, model);
  Interpreter interpreter(file.LinkText(block), 0,
                          StartBehind(file, file.blocks[block - 1]).machine);
  bool departs = (file.blocks[block].link & kLinkDeparts) != 0;
  for (Step step; interpreter.Next(step);) {
    if (step.kind != StepKind::kTravel || std::exchange(departs, false)) continue;
    const MachineState& at = interpreter.state();
    planner.Go(ToDouble(at.at.x - step.from.x) * at.UnitMm(),
               ToDouble(at.at.y - step.from.y) * at.UnitMm());
  }
  return planner.Seconds();
}

double NewTravelSeconds(const GcodeFile& file, uint32_t before, const PlannedTravel& planned,
                        const TravelModel& model) {
  if (planned.via.empty()) {
    return StopToStopSeconds(Distance(planned.from, planned.to), model.speed_mm_s,
                             model.accel_mm_s2);
  }
  TravelPlanner planner(file, before, model);
  Point at = planned.from;
  const auto go = [&](Point to) {
    planner.Go(to.x - at.x, to.y - at.y);
    at = to;
  };
  for (const Point& bend : planned.via) go(bend);
  go(planned.to);
  return planner.Seconds();
}

}  // namespace traverse::gcode

#include "client/gcode/plan/travel_model.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "client/gcode/machine/motion_planner.h"
#include "client/gcode/measure/print_meter.h"
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
  Additions at_marks;                 // where scripts may change tools, prime and wait as well
  std::vector<uint32_t> between;      // [of between_paths] the block in the layer that it leads to
  Retractions arriving;               // [of between_paths] its part behind the travel
  double slope = 0;                   // of the last move that rises on its way
  double descent_seconds_per_mm = 0;  // of the last one of Z alone
};

// Filament is pulled back, or pushed, at a standstill.
bool StandsStill(const Step& step) {
  return step.kind == StepKind::kFilament || step.kind == StepKind::kFirmwareRetract ||
         step.kind == StepKind::kFirmwareUnretract;
}

class TravelLearner {
 public:
  explicit TravelLearner(const GcodeFile& file) : file_(file) {}

  LayerTravel LearnLayer(const Layer& layer) {
    LayerTravel learnt;
    for (uint32_t b = std::max(layer.first_block, 1u); b < layer.end_block; ++b) {
      LearnLink(b, layer.first_block, learnt);
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

  void LearnLink(uint32_t b, uint32_t first_block, LayerTravel& learnt) {
    const Block& before = file_.blocks[b - 1];
    const Block& block = file_.blocks[b];
    if ((block.link & kLinkFixed) != 0) return;
    const bool retracts = (block.link & kLinkRetracts) != 0;
    Dynamics dynamics = DynamicsAt(before.state_out);
    MachineState state = file_.modes[before.mode];
    state.at = before.last;
    state.e = before.e_out;
    state.feed = before.feed_out;
    Interpreter interpreter(std::string_view(file_.text).substr(0, block.begin), before.end, state);
    PrintMeter all(file_.profile, dynamics, nullptr);
    PrintMeter travel(file_.profile, dynamics, nullptr);
    PrintMeter flowing(file_.profile, dynamics, nullptr);  // without stops
    std::optional<PrintMeter> behind;                      // the last retracted travel
    for (Step step; interpreter.Next(step);) {
      const bool travels = step.kind == StepKind::kTravel || step.kind == StepKind::kSlot;
      if (retracts) all.Follow(step, interpreter);
      if (retracts && travels) travel.Follow(step, interpreter);
      if (retracts && travels) flowing.Follow(step, interpreter);
      if (StandsStill(step)) travel.Stop();
      if (step.kind == StepKind::kTravel) {
        if (step.retracted) behind.emplace(file_.profile, dynamics, nullptr);
      } else if (behind) {
        behind->Follow(step, interpreter);
      }
      LearnStep(step, interpreter, dynamics, learnt);
    }
    if (!retracts) return;
    const bool at_mark = (block.link & kLinkSplits) != 0;
    Additions& added = at_mark ? learnt.at_marks : learnt.between_paths;
    if (!at_mark) {
      learnt.between.push_back(b - first_block);
      learnt.arriving.push_back(behind ? behind->Finish().seconds : 0);
    }
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
      const double rise = ToDouble(state.at.z - step.from.z) * unit;
      if (rise > 0 && travelled_mm > 0 && !step.arc) learnt.slope = rise / travelled_mm;
    } else if (step.kind == StepKind::kLift && state.at.z < step.from.z && state.feed > 0) {
      learnt.descent_seconds_per_mm = 60 / (ToDouble(state.feed) * unit);
    }
  }

  const GcodeFile& file_;
  std::map<uint32_t, Dynamics> dynamics_;  // by state
};

std::vector<AddedSeconds> AddedIn(const Layer& layer, const LayerTravel& learnt) {
  const Retractions& seconds = learnt.between_paths.alone;
  std::vector<AddedSeconds> added(layer.end_block - layer.first_block);
  const double most = seconds.empty() ? 0 : MostSeconds(seconds);
  for (size_t i = 0; i < seconds.size(); ++i) {
    if (seconds[i] > most) continue;
    const double arriving = learnt.arriving[i];
    added[learnt.between[i]] = {static_cast<float>(seconds[i] - arriving),
                                static_cast<float>(arriving)};
  }
  return added;
}

}  // namespace

std::vector<TravelModel> LearnTravel(const GcodeFile& file, double threshold_mm, int threads) {
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
    const bool rises = learnt.slope > 0 && learnt.descent_seconds_per_mm > 0;
    model.slope = rises ? learnt.slope : 0;
    model.descent_seconds_per_mm = rises ? learnt.descent_seconds_per_mm : 0;
    models.push_back(model);
    models.back().added = AddedIn(file.layers[layer], learnt);
  }
  for (TravelModel& each : models) each.retraction_threshold_mm = threshold_mm;
  return models;
}

namespace {

// Travel at the speed and acceleration of a model, with the paths that it joins.
class TravelPlanner {
 public:
  TravelPlanner(const GcodeFile& file, uint32_t before, const TravelModel& model,
                const TravelJoints* joints)
      : dynamics_(
            DynamicsOf(file.profile, file.states[file.blocks[before].state_out], file.setters)),
        model_(model),
        joints_(joints),
        planner_({file.profile.klipper, dynamics_.cruise_ratio()}) {
    if (joints_ != nullptr) Print(joints_->from);
  }

  void Go(double dx, double dy) {
    planner_.Move(dx, dy, model_.speed_mm_s, model_.accel_mm_s2, dynamics_.corner_speed());
  }

  void Stop() { planner_.Stop(); }

  double Seconds() {
    if (joints_ != nullptr) Print(joints_->to);
    planner_.Stop();
    return planner_.seconds() - printing_seconds_;
  }

 private:
  // Straight on, long enough to get going from standstill to the joint and to stop there. That it
  // stands still where the path goes on is no loss.
  void Print(const Joint& joint) {
    if (!(joint.speed_mm_s > 0)) return;
    const double ramp_seconds = joint.speed_mm_s / joint.accel_mm_s2;
    const double length = joint.speed_mm_s * ramp_seconds;
    planner_.Move(joint.along.x * length, joint.along.y * length, joint.speed_mm_s,
                  joint.accel_mm_s2, dynamics_.corner_speed());
    printing_seconds_ += 1.5 * ramp_seconds;
  }

  const Dynamics dynamics_;
  const TravelModel& model_;
  const TravelJoints* const joints_;
  MotionPlanner planner_;
  double printing_seconds_ = 0;
};

}  // namespace

double TravelSeconds(const GcodeFile& file, uint32_t block, const TravelModel& model,
                     bool with_departure, const TravelJoints* joints) {
  assert(0 < block && block < file.blocks.size());
  const Block& before = file.blocks[block - 1];
  TravelPlanner planner(file, block - 1, model, joints);
  MachineState state = file.modes[before.mode];
  state.at = before.last;
  state.e = before.e_out;
  state.feed = before.feed_out;
  Interpreter interpreter(file.LinkText(block), 0, state);
  bool departs = !with_departure && file.dialect != Dialect::kCura &&
                 (file.blocks[block].link & kLinkDeparts) != 0;
  for (Step step; interpreter.Next(step);) {
    if (joints != nullptr && StandsStill(step)) planner.Stop();
    if (step.kind != StepKind::kTravel || std::exchange(departs, false)) continue;
    const MachineState& at = interpreter.state();
    planner.Go(ToDouble(at.at.x - step.from.x) * at.UnitMm(),
               ToDouble(at.at.y - step.from.y) * at.UnitMm());
  }
  return planner.Seconds();
}

double NewTravelSeconds(const GcodeFile& file, uint32_t before, const PlannedTravel& planned,
                        const TravelModel& model, const TravelJoints* joints) {
  const bool straight = planned.via.empty() && planned.ahead == Vertex{};
  if (straight && (joints == nullptr || planned.retracts)) {
    const double printing =
        joints == nullptr ? 0 : StopSeconds(joints->from) + StopSeconds(joints->to);
    return printing + StopToStopSeconds(Distance(planned.from, planned.to), model.speed_mm_s,
                                        model.accel_mm_s2);
  }
  TravelPlanner planner(file, before, model, joints);
  Vertex at = planned.from;
  const auto go = [&](Vertex to) {
    planner.Go(to.x - at.x, to.y - at.y);
    at = to;
  };
  if (!(planned.ahead == Vertex{})) planner.Go(planned.ahead.x, planned.ahead.y);
  if (planned.retracts) planner.Stop();
  for (const Vertex& bend : planned.via) go(bend);
  go(planned.to);
  if (planned.retracts) planner.Stop();
  return planner.Seconds();
}

}  // namespace traverse::gcode

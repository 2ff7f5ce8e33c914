#include "client/gcode/measure/layer_meter.h"

#include <cassert>

#include "client/gcode/measure/nominal_time.h"
#include "client/gcode/measure/print_meter.h"
#include "client/gcode/model/loops.h"
#include "client/gcode/model/outline.h"
#include "client/gcode/parallel.h"

namespace traverse::gcode {
namespace {

// Lines are measured in some microseconds.
constexpr size_t kLinesToLimit = 64;

// A lift on a spiral is as wide as its slicer makes it anywhere, and counts as straight.
bool IsBlocked(const Step& step, const MachineState& machine, const Room& room) {
  const bool moves = IsXyMotion(step.kind) && step.kind != StepKind::kExtrude;
  if (!moves && step.kind != StepKind::kLift) return false;
  const double unit_mm = machine.UnitMm();
  return !room.IsClear(machine.InMm(step.from), ToDouble(step.from.z) * unit_mm,
                       machine.InMm(machine.at), ToDouble(machine.at.z) * unit_mm);
}

}  // namespace

std::vector<size_t> PathMarks(const GcodeFile& file, const Layer& layer) {
  const Offset begin = file.blocks[layer.first_block].begin;
  std::vector<size_t> marks;
  for (uint32_t b = layer.first_block; b < layer.end_block; ++b) {
    marks.push_back(file.blocks[b].begin - begin);
    marks.push_back(file.blocks[b].end - begin);
  }
  return marks;
}

namespace {

// The nominal seconds of the lines `text`; calls visit(step, the interpreter behind it, when the
// step begins) for each. Measures `moments`, unless that is null.
template <typename Visit>
double FollowLines(const GcodeFile& file, std::string_view text, const PartStart& start,
                   TextMoments* moments, Visit visit) {
  Interpreter interpreter(text, 0, start.machine);
  double seconds = 0;
  const auto reach = [moments, &seconds](size_t offset) {
    if (moments == nullptr) return;
    std::vector<double>& known = moments->seconds;
    while (known.size() < moments->offsets.size() && moments->offsets[known.size()] <= offset) {
      known.push_back(seconds);
    }
  };
  size_t lines = 0;
  for (Step step; interpreter.Next(step);) {
    if (++lines % kLinesToLimit == 0 && file.limit.Ended()) break;
    reach(step.line.begin);
    visit(step, interpreter, seconds);
    seconds += NominalSeconds(step, interpreter.state());
  }
  reach(text.size());
  return seconds;
}

}  // namespace

PrintTotals Measure(const GcodeFile& file, std::string_view text, const PartStart& start,
                    const VisibleWalls* walls, const Room* room, TextMoments* moments) {
  PrintMeter meter(file.profile, DynamicsOf(file.profile, start.state, file.setters), walls);
  int64_t blocked = 0;
  const auto follow = [&](const Step& step, const Interpreter& interpreter, double) {
    meter.Follow(step, interpreter);
    if (room != nullptr && IsBlocked(step, interpreter.state(), *room)) ++blocked;
  };
  const double nominal_seconds = FollowLines(file, text, start, moments, follow);
  PrintTotals totals = meter.Finish();
  totals.nominal_seconds = nominal_seconds;
  totals.blocked = blocked;
  return totals;
}

double MeasureMoments(const GcodeFile& file, std::string_view text, const PartStart& start,
                      TextMoments* moments, const VisitStep& visit) {
  return FollowLines(file, text, start, moments,
                     [&visit](const Step& step, const Interpreter&, double seconds) {
                       if (visit) visit(step, seconds);
                     });
}

PartStart StartOfFile(const GcodeFile& file) {
  PartStart start;
  start.machine.relative_e = !file.modes.empty() && file.modes[0].relative_e;
  return start;
}

PrintTotals MeasurePaths(const GcodeFile& file, const Layer& layer, const VisibleWalls& walls,
                         TextMoments* moments) {
  const Block& first = file.blocks[layer.first_block];
  const PartStart start{StateAt(file, first), file.states[first.state_in]};
  return Measure(file, file.PathsText(layer), start, &walls, nullptr, moments);
}

PrintTotals MeasureTravel(const GcodeFile& file, const Layer& layer, const VisibleWalls& walls) {
  return layer.first_block > 0 ? MeasureLink(file, layer.first_block, walls) : PrintTotals{};
}

PrintTotals MeasureLink(const GcodeFile& file, uint32_t block, const VisibleWalls& walls) {
  assert(block > 0);
  const PartStart start = StartBehind(file, file.blocks[block - 1]);
  return Measure(file, file.LinkText(block), start, &walls);
}

std::vector<PrintTotals> MeasureLayers(const GcodeFile& file, int threads) {
  std::vector<PrintTotals> totals(file.layers.size());
  const auto measure = [&file, &totals](size_t i) {
    const VisibleWalls walls(OutlinesOf(file, file.layers[i]));
    totals[i] = MeasureTravel(file, file.layers[i], walls);
    totals[i] += MeasurePaths(file, file.layers[i], walls);
  };
  ParallelFor(totals.size(), threads, measure, file.limit);
  return totals;
}

PrintTotals Sum(const std::vector<PrintTotals>& totals) {
  PrintTotals sum;
  for (const PrintTotals& each : totals) sum += each;
  return sum;
}

}  // namespace traverse::gcode

#include "client/gcode/link/link_looks.h"

#include <algorithm>
#include <utility>

#include "client/gcode/link/link.h"
#include "client/gcode/model/loops.h"
#include "client/gcode/model/part_links.h"
#include "client/gcode/parallel.h"

namespace traverse::gcode {
namespace {

// From where the head leaves the path before `block` to that block: all of the travel in the link
// if it is open, else straight.
std::vector<Point> LineTo(const GcodeFile& file, uint32_t block, bool straight) {
  const MachineState& mode = file.modes[file.blocks[block].mode];
  const Link link = ReadLink(file, block);
  const LinkStep* going_on = GoingOnAlong(file.blocks[block - 1], link);
  std::vector<Point> line = {
      mode.InMm(going_on != nullptr ? going_on->to : file.blocks[block - 1].last)};
  bool skips = going_on != nullptr;
  for (const LinkStep& step : link.steps) {
    if (straight) break;
    if (IsXyMotion(step.kind) && !std::exchange(skips, false)) line.push_back(mode.InMm(step.to));
  }
  line.push_back(mode.InMm(file.blocks[block].first));
  return line;
}

}  // namespace

std::vector<LinkLook> LooksOfLinks(const GcodeFile& file, size_t layer,
                                   const RetractionHabit& habit) {
  const Layer& of_file = file.layers[layer];
  const std::vector<Outline> outlines = OutlinesOf(file, of_file);
  const VisibleWalls walls(outlines);
  const TravelRules rules(file, of_file, habit, outlines, walls);
  std::vector<LinkLook> looks(outlines.size());
  for (uint32_t block = of_file.first_block; block < of_file.end_block; ++block) {
    LinkLook& look = looks[block - of_file.first_block];
    look.retracts = (file.blocks[block].link & kLinkRetracts) != 0;
    if (block == of_file.first_block || IsBoundary(file.blocks[block])) continue;
    look.hidden = rules.Hides(LineTo(file, block, look.retracts),
                              outlines[block - of_file.first_block].feature);
  }
  return looks;
}

RetractionHabit HabitOfLooks(const GcodeFile& file, double longest_mm, int threads,
                             std::shared_ptr<const HiddenMoves> hidden) {
  Allowance allow;
  allow.hidden_retractions = true;
  allow.max_hidden_travel_mm = longest_mm;
  return HabitOfNewTravels(file, allow, threads, std::move(hidden));
}

HiddenCounts CountHiddenRetractions(const GcodeFile& file, const RetractionHabit& habit,
                                    int threads) {
  HiddenCounts counts(file.layers.size());
  ParallelFor(counts.size(), threads, [&](size_t layer) {
    const std::vector<LinkLook> looks = LooksOfLinks(file, layer, habit);
    counts[layer] = std::count_if(looks.begin(), looks.end(), [](const LinkLook& look) {
      return look.retracts && look.hidden;
    });
  });
  return counts;
}

}  // namespace traverse::gcode

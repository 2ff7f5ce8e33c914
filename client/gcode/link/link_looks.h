// How the links of a file look: for people who count and look at them.

#ifndef TRAVERSE_CLIENT_GCODE_LINK_LINK_LOOKS_H_
#define TRAVERSE_CLIENT_GCODE_LINK_LINK_LOOKS_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "client/gcode/model/gcode_file.h"
#include "client/gcode/plan/travel_rules.h"

namespace traverse::gcode {

struct LinkLook {
  bool retracts = false;
  bool hidden = false;  // nobody sees its travel, or would see it if it went straight and open
};

// [block of layer `layer`] the link before it, as it is in `file`. What is hidden by `habit`, be it
// that of another file with the same layers.
std::vector<LinkLook> LooksOfLinks(const GcodeFile& file, size_t layer,
                                   const RetractionHabit& habit);

// The habit by which links are looked at: travel of up to `longest_mm` may be hidden.
// `hidden`: see HabitOfNewTravels.
RetractionHabit HabitOfLooks(const GcodeFile& file, double longest_mm, int threads = 1,
                             std::shared_ptr<const HiddenMoves> hidden = nullptr);

// [layer] retractions between its paths whose travel nobody would see.
using HiddenCounts = std::vector<int64_t>;
HiddenCounts CountHiddenRetractions(const GcodeFile& file, const RetractionHabit& habit,
                                    int threads = 1);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_LINK_LINK_LOOKS_H_

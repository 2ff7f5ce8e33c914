// A link, line by line: the text between two paths.

#ifndef TRAVERSE_CLIENT_GCODE_LINK_LINK_H_
#define TRAVERSE_CLIENT_GCODE_LINK_LINK_H_

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <vector>

#include "client/gcode/model/gcode_file.h"
#include "client/gcode/model/part_start.h"

namespace traverse::gcode {

struct LinkStep {
  StepKind kind = StepKind::kBlank;
  Line line;
  Position from;
  Position to;
  Decimal filament = 0;   // pushed or retracted; for kSetE the new value of the register
  Decimal e = 0;          // the register behind the line in the file
  Decimal feed = 0;       // in force for this line
  SlotMask slots = 0;     // kSlot
  uint32_t words = 0;     // of commands
  double travel_mm = 0;   // length in XY, along the arc if it is one
  bool arc = false;       // G2 or G3
  bool relative = false;  // Step
};

// How filament is pulled back.
struct Retraction {
  Decimal pulled = 0;     // by E words, the most of it
  bool firmware = false;  // with G10
  bool wipes = false;     // while moving

  bool retracts() const { return pulled > 0 || firmware; }
  bool SameRetraction(const Retraction& other) const {
    return std::abs(pulled - other.pulled) <= kRetractionSlack && firmware == other.firmware;
  }
};

// As a Retraction, what it pulls back before the arrival.
struct Link : Retraction {
  std::vector<LinkStep> steps;

  // Steps [0, fixed) stay unchanged; `behind_fixed` is the machine after them.
  size_t fixed = 0;
  PartStart behind_fixed;

  // Index of the travel move that arrives at the next path: the last one in XY, or the last
  // retracted one if there are such; not among the fixed ones. -1: none.
  int arrival = -1;
  bool arrives_retracted = false;

  // The print state during the arrival.
  PrintState travel_state{};

  // The heights of what is printed before and after.
  Decimal z_before = 0;
  Decimal z_behind = 0;

  // The height of the layer behind: scarf seams begin lower, at z_behind.
  Decimal layer_behind = 0;

  // The arrival runs, or begins, this much above both of them.
  Decimal lift = 0;

  // The arrival itself descends to the next path, which lies lower than the one before.
  bool sinks = false;

  // If moves in XY rise to that height: their length, and whether the level arrival follows them.
  // 0: it rises only by moves of Z, or not at all.
  double ramp_mm = 0;
  bool ramp_ends = false;

  // Feed rate of moves of Z alone; 0 if there are none.
  Decimal lift_feed = 0;

  // Steps before the arrival begin with a short move away from the path.
  bool departs = false;

  // The height of the arrival; that of the next path if the arrival is not above what was printed.
  Decimal top = 0;

  // REQUIRES: arrival >= 0.
  const LinkStep& arriving() const { return steps[static_cast<size_t>(arrival)]; }
  LinkStep& arriving() { return steps[static_cast<size_t>(arrival)]; }

  // True if step `i` stands before the arrival.
  bool Leaves(size_t i) const { return static_cast<int>(i) < arrival; }
};

// Whether the link before block `index` may begin with a slicer's move inwards; combing moves of
// CuraEngine look the same but lead somewhere.
bool MayDepart(const GcodeFile& file, size_t index);

// The step of the short move with which `link` begins; null if it begins with none.
const LinkStep* DepartureOf(const Link& link);

// The step before which what the travel is made under is set: where the file sets it if it wipes
// before, as the path was printed, and else the first that is not fixed.
size_t SetsTravelAt(const Link& link);

// What the wipe of a link does that stands before its first prime.
struct WipeForm {
  double travel_mm = 0;
  Decimal pulled = 0;
  Decimal feed = 0;
  Decimal still_feed = 0;  // of what is pulled at a standstill; 0: nothing is
};

WipeForm WipeOf(const Link& link);

// Whether the nozzle is opened on the way, before step `i`.
bool PrimesBefore(const Link& link, size_t i);

// Whether filament is pulled back before anything else moves in XY behind `departure`, a step of
// `link` without unknown lines.
bool PullsBackBehind(const Link& link, const LinkStep& departure);

// The label of an object stands before the travel, at the height of the path before it.
bool LabelsBeforeTravel(const Link& link);

// Step `i` is a travel move behind which the head sinks under what was printed before: it leads to
// where there is nothing in the way, to the next object of a print one by one.
bool LeadsAside(const Link& link, size_t i);
bool LeadsAside(const Link& link);  // by any step

// Of a layer, of an object, or a line that stays where it is.
bool IsMark(const LinkStep& step);

// It has labels of objects, at which nothing is done, and no other marks.
bool MarksObjectsOnly(const Link& link);

// The slots that the link itself sets before its first mark.
SlotMask SetBeforeMarks(const Link& link);

// `form`, which pulls filament back as `own` first does; nothing if `own` pulls back another amount
// there, or does not wipe, or does so behind marks, and `form` wipes too. REQUIRES: form.arrival >=
// 0.
std::optional<Link> WithWipeOf(Link form, const Link& own);

// `link` with its marks, in which filament is first pulled back as in `own`; nothing unless one of
// the two wipes there and the other one does not, and both pull back as much.
std::optional<Link> WithPullOf(const Link& link, const Link& own);

// The link that leads to block `index`; to the first one leads none, which is empty. REQUIRES:
// index < file.blocks.size().
Link ReadLink(const GcodeFile& file, size_t index);

// The step of `link`, the one behind `block`, a closed path, that continues along it without
// filament; null for most. CuraEngine wipes its outer walls so. It belongs to the end of the path,
// wherever that end is.
const LinkStep* GoingOnAlong(const Block& block, const Link& link);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_LINK_LINK_H_

#include "client/gcode/verify/sections.h"

#include <algorithm>
#include <utility>

namespace traverse::gcode {
namespace {

// Stands for a line that ends the last section: what holds there has to agree as well.
constexpr uint64_t kEndOfText = 1;

uint64_t DigestOf(const Motion& motion) {
  uint64_t digest = Mix(static_cast<uint64_t>(motion.number), static_cast<uint64_t>(motion.feed));
  for (size_t axis = 0; axis < 3; ++axis) {
    digest = Mix(digest, static_cast<uint64_t>(motion.from[axis]));
    digest = Mix(digest, static_cast<uint64_t>(motion.to[axis]));
  }
  return Mix(digest, static_cast<uint64_t>(motion.filament));
}

}  // namespace

SectionCutter::SectionCutter(std::string_view ignored, bool marked)
    : ignored_(ignored), in_script_(marked) {
  section_.first_line = section_.first_note = 1;
}

SectionCutter::Cut SectionCutter::Take(const VerifyLine& line, const VerifyMachine& machine) {
  Cut cut;
  if (line.role == LineRole::kComment && line.text.substr(0, ignored_.size()) == ignored_) {
    return cut;
  }
  if (line.role == LineRole::kDeposit && has_height_ && line.z != height_) {
    CutAtHeight(machine);
    cut.before = true;
  }
  last_line_ = line.number;
  if (line.moves && (in_script_ || section_.deposits.count == 0)) {
    section_.moves = Mix(section_.moves, DigestOf(machine.motion()));
  }
  if (line.travels) section_.lowest = std::min(section_.lowest, machine.z());
  switch (line.role) {
    case LineRole::kDeposit:
      height_ = line.z;
      has_height_ = true;
      section_.lowest = std::min(section_.lowest, line.z);
      section_.deposits.Add(line.digest);
      last_deposit_ = line.number;
      section_.notes += loose_notes_;
      loose_notes_ = {};
      break;
    case LineRole::kComment:
    case LineRole::kProgress:
      loose_notes_.Add(line.digest);
      break;
    case LineRole::kFence:
    case LineRole::kFixed:
      Close(machine, line.number, line.digest, line.role == LineRole::kFixed);
      cut_.sections.back().command = line.text.front() != ';';
      cut.behind = true;
      break;
    case LineRole::kNothing:
      break;
  }
  return cut;
}

void SectionCutter::Finish(const VerifyMachine& machine) {
  Close(machine, last_line_, kEndOfText, false);
}

// Notes since the last deposit belong to what comes: whatever path that begins with, its comments
// stand before it.
void SectionCutter::CutAtHeight(const VerifyMachine& machine) {
  const size_t first_note = std::max(last_deposit_ + 1, section_.first_note);
  const DigestSet notes = std::exchange(loose_notes_, {});
  Close(machine, last_line_, 0, false);
  cut_.sections.back().last_note = first_note - 1;
  section_.first_note = first_note;
  loose_notes_ = notes;
}

void SectionCutter::Close(const VerifyMachine& machine, size_t last_line, uint64_t fence,
                          bool fixed) {
  section_.last_line = section_.last_note = last_line;
  section_.notes += loose_notes_;
  loose_notes_ = {};
  section_.fence = fence;
  section_.fixed = fixed;
  if (fixed) {
    section_.x = machine.x();
    section_.y = machine.y();
    section_.z = machine.z();
    section_.retracted = machine.retracted();
  }
  // A change of height is no line: what holds there may still change before it prints.
  if (fence != 0) section_.fan = machine.fan();
  cut_.sections.push_back(section_);
  if (in_script_) cut_.of_script = cut_.sections.size();
  section_ = Section{};
  section_.first_line = section_.first_note = last_line + 1;
}

}  // namespace traverse::gcode

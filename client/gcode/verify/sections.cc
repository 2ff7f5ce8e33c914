#include "client/gcode/verify/sections.h"

#include <algorithm>
#include <utility>

#include "client/gcode/verify/machine/print_settings.h"

namespace traverse::gcode {
namespace {

// Stands for a line that ends the last section: the state there must agree too.
constexpr uint64_t kEndOfText = 1;

uint64_t DigestOf(const Motion& motion) {
  // G0 and G1 are the same to what prints nothing.
  const auto number = static_cast<uint64_t>(std::max(motion.number, 1));
  const std::array<Micro, 3>& from = motion.from;
  const std::array<Micro, 3>& to = motion.to;
  return MixAll(number, motion.feed, from[0], to[0], from[1], to[1], from[2], to[2],
                motion.filament);
}

// A comment that says of what the next paths are, or a mark of a wipe: what it leads to is
// compared, and in a script also the line.
bool IsStateComment(const VerifyLine& line) {
  return line.role == LineRole::kNothing && !line.text.empty() && line.text[0] == ';';
}

// Waiting or not: of the nozzle, the bed, the chamber, the heat break.
bool Heats(std::string_view text) {
  constexpr std::string_view kCommands[] = {"M104", "M109", "M140", "M190", "M141", "M142"};
  return BeginsWithAny(text, kCommands);
}

// Comments that slicers put after the mark of a layer, where scripts look for them.
bool SaysOfLayer(std::string_view text) {
  constexpr std::string_view kNotes[] = {
      ";Z:", ";HEIGHT:", "; Z_HEIGHT:", "; LAYER_HEIGHT:", "; layer num"};
  return BeginsWithAny(text, kNotes);
}

}  // namespace

SectionCutter::SectionCutter(std::string_view ignored, bool marked)
    : ignored_(ignored), in_script_(marked) {
  section_.first_line = section_.first_note = 1;
}

// A line within a picture would spoil it, and one after the head could be anything.
bool SectionCutter::Ignores(const VerifyLine& line) {
  if (line.text.empty()) return false;
  in_head_ = in_head_ && (line.text[0] == ';' || line.number == 1);
  if (!in_head_ || line.role != LineRole::kComment) return false;
  if (line.text.starts_with("; thumbnail")) {
    in_picture_ = line.text.find(" begin") != std::string_view::npos;
  }
  if (in_picture_ || !line.text.starts_with(ignored_)) return false;
  ++cut_.ignored;
  cut_.last_ignored = line.number;
  return true;
}

// What is said of a layer stands behind its mark. A path that begins where the last one ended needs
// no travel: what is said of it, as its height, is not of the layer.
void SectionCutter::NoteHeader(const VerifyLine& line, bool mark) {
  const bool of_layer = !line.text.empty() && line.text[0] == ';' && SaysOfLayer(line.text);
  if (in_header_ && of_layer) section_.header = Mix(section_.header, DigestOf(line.text));
  const bool ends = line.travels || line.primes || line.role == LineRole::kDeposit ||
                    line.role == LineRole::kFence || line.role == LineRole::kFixed ||
                    (line.role == LineRole::kComment && line.command != 0) ||
                    NamesFeature(line.text);
  in_header_ = mark || (in_header_ && !ends);
}

void SectionCutter::TakeLoose(uint64_t position) {
  section_.notes += loose_notes_;
  loose_notes_ = {};
  for (size_t kind = 0; kind < loose_said_.size(); ++kind) {
    uint64_t& digest = section_.said[kind];
    for (const uint64_t one : loose_said_[kind]) digest = Mix(digest, Mix(one, position));
    loose_said_[kind].clear();
  }
}

SectionCutter::Cut SectionCutter::Take(const VerifyLine& line, const VerifyMachine& machine,
                                       bool mark) {
  Cut cut;
  if (Ignores(line)) return cut;
  const bool rises = line.role == LineRole::kDeposit && machine.motion().from[2] < line.z;
  const bool of_layer = layer_prints_ && line.z <= height_;
  const bool within = rises && (of_layer || GoesOnRising(machine.motion()));
  if (line.role == LineRole::kDeposit && has_height_ && line.z != height_ && !within) {
    CutAtHeight(machine);
    cut.before = true;
    ramp_begin_ = machine.motion().from[2];
  }
  if (line.role == LineRole::kDeposit || line.moves) rising_ = rises;
  last_line_ = line.number;
  NoteHeader(line, mark);
  // Unknown commands leave the head elsewhere, so a move to where it was does move it.
  const bool before_deposits = in_script_ || section_.deposits.count == 0;
  if ((line.moves || line.stays) && before_deposits) {
    section_.moves = Mix(section_.moves, DigestOf(machine.motion()));
  } else if ((line.sets || IsStateComment(line)) && before_deposits) {
    section_.moves = Mix(section_.moves, DigestOf(line.text));
  }
  if (line.travels) section_.lowest = std::min(section_.lowest, machine.z());
  switch (line.role) {
    case LineRole::kDeposit:
      height_ = within ? std::max(height_, line.z) : line.z;
      has_height_ = layer_prints_ = true;
      section_.lowest = std::min(section_.lowest, line.z);
      section_.deposits.Add(line.digest);
      section_.order = Mix(section_.order, line.digest);
      last_deposit_ = line.number;
      TakeLoose(section_.deposits.count);
      break;
    case LineRole::kComment:
      loose_said_[line.command == 0 ? 0 : 1].push_back(line.digest);
      loose_notes_.Add(line.digest);
      break;
    case LineRole::kFence:
    case LineRole::kFixed:
      // Where it waits for the picture, it drips or not.
      if (line.photo) section_.retracted = machine.retracted();
      Close(machine, line.number, line.digest, line.role == LineRole::kFixed, line.label);
      cut_.sections.back().command = line.text.front() != ';';
      cut_.sections.back().ends_layer = mark;
      layer_prints_ &= !mark;
      cut_.sections.back().heats = Heats(line.text);
      cut_.sections.back().names = labels_.Take(line.text);
      cut_.sections.back().label_faults = labels_.faults();
      cut.behind = true;
      break;
    case LineRole::kProgress:  // rules/progress.cc
    case LineRole::kNothing:
      break;
  }
  return cut;
}

// Without another move since the deposit before, from where that ended; but a spiral vase rises on
// and on.
bool SectionCutter::GoesOnRising(const Motion& motion) const {
  constexpr Micro kMostRise = 1'000'000;
  return rising_ && motion.from[2] == height_ && motion.to[2] - ramp_begin_ <= kMostRise;
}

void SectionCutter::Count(uint32_t section, const std::vector<uint64_t>& printed,
                          const std::vector<uint64_t>& as) {
  DigestSet& deposits = cut_.sections[section].deposits;
  for (const uint64_t digest : printed) deposits.Remove(digest);
  for (const uint64_t digest : as) deposits.Add(digest);
}

void SectionCutter::Finish(const VerifyMachine& machine) {
  Close(machine, last_line_, kEndOfText, false);
}

// Notes since the last deposit belong to what comes: whatever path that begins with, its comments
// stand before it.
void SectionCutter::CutAtHeight(const VerifyMachine& machine) {
  const uint32_t first_note = std::max(last_deposit_ + 1, section_.first_note);
  const DigestSet notes = std::exchange(loose_notes_, {});
  auto said = std::exchange(loose_said_, {});
  Close(machine, last_line_, 0, false);
  // Behind the mark of a layer the first path is of that one.
  cut_.sections.back().ends_layer = std::exchange(layer_prints_, false);
  cut_.sections.back().last_note = first_note - 1;
  section_.first_note = first_note;
  loose_notes_ = notes;
  loose_said_ = std::move(said);
}

void SectionCutter::Close(const VerifyMachine& machine, uint32_t last_line, uint64_t fence,
                          bool fixed, bool label) {
  section_.last_line = section_.last_note = last_line;
  TakeLoose(section_.deposits.count + 1);
  section_.fence = fence;
  section_.under = labels_.digest();
  section_.fixed = fixed;
  // What follows the print may be all that leads away from it.
  const bool end = fence == kEndOfText;
  if (fixed) {
    section_.head = machine.at();
    section_.settings = machine.settings().SettingsDigest();
  }
  // A change of height is not a line: the state there may still change before it prints.
  if (fence != 0) section_.fan = machine.settings().fan();
  section_.label = label;
  section_.lift = label && has_height_ ? machine.z() - height_ : 0;
  if (end) section_.head[2] = machine.z();
  if (label || fixed || end) section_.retracted = machine.retracted();
  cut_.sections.push_back(section_);
  if (in_script_) cut_.of_script = cut_.sections.size();
  section_ = Section{};
  section_.first_line = section_.first_note = last_line + 1;
}

}  // namespace traverse::gcode

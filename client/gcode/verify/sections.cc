#include "client/gcode/verify/sections.h"

#include <algorithm>
#include <utility>

namespace traverse::gcode {
namespace {

// Stands for a line that ends the last section: what holds there has to agree as well.
constexpr uint64_t kEndOfText = 1;

class Cutter {
 public:
  Cutter(std::string_view text, std::string_view ignored) : machine_(text), ignored_(ignored) {}

  Sections Cut() {
    section_.first_line = section_.first_note = 1;
    for (VerifyLine line; machine_.Next(line);) Take(line);
    Close(last_line_, kEndOfText, false);
    return std::move(cut_);
  }

 private:
  void Take(const VerifyLine& line) {
    if (line.role == LineRole::kComment && line.text.substr(0, ignored_.size()) == ignored_) return;
    if (line.role == LineRole::kDeposit && has_height_ && line.z != height_) {
      CutAtHeight();
    }
    last_line_ = line.number;
    if (line.travels) section_.lowest = std::min(section_.lowest, machine_.z());
    if (line.primes) {
      const Micro slack = VerifyMachine::kSlack;
      cut_.surpluses.insert((line.surplus + slack / 2) / slack * slack);
    }
    switch (line.role) {
      case LineRole::kDeposit:
        height_ = line.z;
        has_height_ = true;
        section_.lowest = std::min(section_.lowest, line.z);
        section_.deposits.Add(line.digest);
        last_deposit_ = line.number;
        section_.notes += loose_notes_;
        loose_notes_ = {};
        return;
      case LineRole::kComment:
      case LineRole::kProgress:
        loose_notes_.Add(line.digest);
        return;
      case LineRole::kFence:
      case LineRole::kFixed:
        Close(line.number, line.digest, line.role == LineRole::kFixed);
        return;
      case LineRole::kNothing:
        return;
    }
  }

  // A change of height in front of this line. Notes since the last deposit belong to what comes:
  // whatever path that begins with, its comments stand before it.
  void CutAtHeight() {
    const size_t first_note = std::max(last_deposit_ + 1, section_.first_note);
    const DigestSet notes = std::exchange(loose_notes_, {});
    Close(last_line_, 0, false);
    cut_.sections.back().last_note = first_note - 1;
    section_.first_note = first_note;
    loose_notes_ = notes;
  }

  void Close(size_t last_line, uint64_t fence, bool fixed) {
    section_.last_line = section_.last_note = last_line;
    section_.notes += loose_notes_;
    loose_notes_ = {};
    section_.fence = fence;
    section_.fixed = fixed;
    if (fixed) {
      section_.x = machine_.x();
      section_.y = machine_.y();
      section_.z = machine_.z();
      section_.retracted = machine_.retracted();
    }
    // A change of height is no line: what holds there may still change before it prints.
    if (fence != 0) section_.fan = machine_.fan();
    cut_.sections.push_back(section_);
    section_ = Section{};
    section_.first_line = section_.first_note = last_line + 1;
  }

  VerifyMachine machine_;
  const std::string_view ignored_;
  Sections cut_;
  Section section_;
  DigestSet loose_notes_;  // since the last deposit
  size_t last_line_ = 0;
  size_t last_deposit_ = 0;
  Micro height_ = 0;
  bool has_height_ = false;
};

}  // namespace

Sections CutIntoSections(std::string_view text, std::string_view ignored) {
  return Cutter(text, ignored).Cut();
}

}  // namespace traverse::gcode

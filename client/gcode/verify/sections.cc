#include "client/gcode/verify/sections.h"

#include <algorithm>

namespace traverse::gcode {
namespace {

// Stands for a line that ends the last section: what holds there has to agree as well.
constexpr uint64_t kEndOfText = 1;

class Cutter {
 public:
  Cutter(std::string_view text, std::string_view ignored) : machine_(text), ignored_(ignored) {}

  Sections Cut() {
    section_.first_line = 1;
    for (VerifyLine line; machine_.Next(line);) Take(line);
    Close(last_line_, kEndOfText, false);
    return std::move(cut_);
  }

 private:
  void Take(const VerifyLine& line) {
    if (line.role == LineRole::kComment && line.text.substr(0, ignored_.size()) == ignored_) return;
    if (line.role == LineRole::kDeposit && has_height_ && line.z != height_) {
      // Cut in front of this line.
      Close(last_line_, 0, false);
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
        return;
      case LineRole::kComment:
      case LineRole::kProgress:
        section_.notes.Add(line.digest);
        return;
      case LineRole::kFence:
      case LineRole::kFixed:
        Close(line.number, line.digest, line.role == LineRole::kFixed);
        return;
      case LineRole::kNothing:
        return;
    }
  }

  void Close(size_t last_line, uint64_t fence, bool fixed) {
    section_.last_line = last_line;
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
    section_.first_line = last_line + 1;
  }

  VerifyMachine machine_;
  const std::string_view ignored_;
  Sections cut_;
  Section section_;
  size_t last_line_ = 0;
  Micro height_ = 0;
  bool has_height_ = false;
};

}  // namespace

Sections CutIntoSections(std::string_view text, std::string_view ignored) {
  return Cutter(text, ignored).Cut();
}

}  // namespace traverse::gcode

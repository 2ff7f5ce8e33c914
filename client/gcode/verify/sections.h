// A print cut into sections, each as digests that do not depend on the order within it.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_SECTIONS_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_SECTIONS_H_

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "client/gcode/verify/machine/object_labels.h"
#include "client/gcode/verify/machine/verify_machine.h"
#include "client/gcode/verify/text.h"

namespace traverse::gcode {

// A digest of a multiset: equal multisets have equal sums, and others do not, except by accidents
// of probability 2^-64.
struct DigestSet {
  uint64_t count = 0;
  uint64_t sum = 0;
  uint64_t mixed = 0;

  void Add(uint64_t digest) {
    ++count;
    sum += digest;
    mixed += Mix(kSeed, digest);
  }
  void Remove(uint64_t digest) {
    --count;
    sum -= digest;
    mixed -= Mix(kSeed, digest);
  }
  DigestSet& operator+=(const DigestSet& other) {
    count += other.count;
    sum += other.sum;
    mixed += other.mixed;
    return *this;
  }
  friend bool operator==(const DigestSet&, const DigestSet&) = default;

 private:
  static constexpr uint64_t kSeed = 0x7261767472617665u;
};

struct Section {
  uint32_t first_line = 0;
  uint32_t last_line = 0;  // the line that ends it
  DigestSet deposits;
  DigestSet notes;          // comments, in lines of their own range:
  uint32_t first_note = 0;  // behind a change of height they are counted from the last deposit on
  uint32_t last_note = 0;
  Micro lowest = INT64_MAX;  // height of all moves in XY
  uint64_t moves = 0;    // of everything but deposits, and of settings, before the first deposit
  bool command = false;  // it ends with a command
  uint64_t header = 0;   // of the comments between the mark of a layer and the first travel

  // Of deposits, and of comments and of commands that only say something, each with their place
  // among these, in their order; notes say to which section they belong.
  uint64_t order = 0;
  std::array<uint64_t, 2> said{};

  // How it ends: with a line, or with a change of height (digest 0), or with the text.
  uint64_t fence = 0;
  bool fixed = false;
  bool label = false;  // it ends with the label of an object
  bool ends_layer = false;
  bool heats = false;  // it ends with a command that sets a temperature

  // Of labels of objects in every notation (object_labels.h).
  uint64_t under = 0;           // those in force in it
  bool names = false;           // it ends with one
  uint32_t label_faults = 0;    // of them up to its end
  std::array<Micro, 3> head{};  // where it is there, if the line is fixed
  bool retracted = false;       // at labels of objects and pictures, too
  Micro lift = 0;               // how far above what was printed last, at labels of objects
  uint64_t settings = 0;
  uint64_t fan = 0;
};

struct Sections {
  std::vector<Section> sections;
  size_t of_script = 0;  // the first sections, before the first mark of a layer
  uint32_t ignored = 0;  // lines of the head, and where the last of them stands
  uint32_t last_ignored = 0;
};

// Cuts a text, line by line. Ignores comments before the first command that begin with `ignored`,
// except those in pictures.
class SectionCutter {
 public:
  // Which sections ended with a line.
  struct Cut {
    bool before = false;  // one ended before it, with a change of height
    bool behind = false;  // one ends with it
  };

  // `marked`: the text before the first mark of a layer is a script.
  SectionCutter(std::string_view ignored, bool marked);

  // `mark`: the line is the mark of a layer.
  Cut Take(const VerifyLine& line, const VerifyMachine& machine, bool mark);
  void Finish(const VerifyMachine& machine);

  // No start script follows.
  void EndScript() { in_script_ = false; }

  // Index of the section that the next line belongs to.
  uint32_t open_section() const { return static_cast<uint32_t>(cut_.sections.size()); }

  // Those that have ended.
  const Sections& cut() const { return cut_; }

  // Counts the deposits `printed` of a section that has ended as those of `as`.
  void Count(uint32_t section, const std::vector<uint64_t>& printed,
             const std::vector<uint64_t>& as);

 private:
  bool GoesOnRising(const Motion& motion) const;
  void CutAtHeight(const VerifyMachine& machine);
  void Close(const VerifyMachine& machine, uint32_t last_line, uint64_t fence, bool fixed,
             bool label = false);
  bool Ignores(const VerifyLine& line);
  void TakeLoose(uint64_t position);  // among the deposits of the section
  void NoteHeader(const VerifyLine& line, bool mark);

  const std::string_view ignored_;
  ObjectLabels labels_;
  Sections cut_;
  Section section_;
  DigestSet loose_notes_;                            // since the last deposit
  std::array<std::vector<uint64_t>, 2> loose_said_;  // comments and commands among them
  uint32_t last_line_ = 0;
  uint32_t last_deposit_ = 0;
  bool in_script_;
  Micro height_ = 0;
  bool has_height_ = false;
  bool rising_ = false;        // the last move was a deposit that rose, as scarf seams do
  Micro ramp_begin_ = 0;       // where the first deposit of the section began, if a height cut it
  bool layer_prints_ = false;  // since the last mark of a layer, or change of height
  bool in_head_ = true;        // no command yet
  bool in_picture_ = false;
  bool in_header_ = false;  // no travel, and no section has ended, since the mark of a layer
};

// For messages: the lines of sections, in one pass over the text while sections follow each other.
class SectionLines {
 public:
  explicit SectionLines(std::string_view text) : text_(text), machine_(text) {}

  // Calls visit(line) for the lines `first` to `last`.
  template <typename Visit>
  void ForEach(uint32_t first, uint32_t last, Visit visit) {
    if (first <= passed_) *this = SectionLines(text_);
    VerifyLine line;
    while (passed_ + 1 < first && machine_.Next(line)) passed_ = line.number;
    for (VerifyMachine machine = machine_; machine.Next(line) && line.number <= last;) visit(line);
  }

 private:
  std::string_view text_;
  VerifyMachine machine_;  // behind line passed_
  uint32_t passed_ = 0;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_SECTIONS_H_

// The labels of objects that stand in a link, and whose they are.
//
//   ... ; stop printing object A | EXCLUDE_OBJECT_END NAME=A | ; printing object B | ...
//       `----------- end the object before ---------------'   `- begin the next -'
//
// Where whole objects change places, the rest of a link stays where it is in the layer, and the
// lines that name an object are exchanged for those of the object that stands there now.

#ifndef TRAVERSE_CLIENT_GCODE_LINK_LABEL_LINES_H_
#define TRAVERSE_CLIENT_GCODE_LINK_LABEL_LINES_H_

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "client/gcode/link/link.h"
#include "client/gcode/model/gcode_file.h"

namespace traverse::gcode {

// Steps of a link that name an object, and messages and the like that stand right beside these,
// within the object.
struct LabelLines {
  std::vector<size_t> ends;    // the object before, ahead of all that begin one
  std::vector<size_t> begins;  // the object behind, after all that end one

  // Something that stays stands within the object before, or behind, but not beside its label.
  bool apart_in_before = false;
  bool apart_in_behind = false;
};

LabelLines LabelLinesOf(const GcodeFile& file, const Link& link);

// The first block of the object that `block` is of, and the first one behind it: the run of blocks
// of its layer under one label.
uint32_t ObjectBegin(const GcodeFile& file, uint32_t block);
uint32_t ObjectEnd(const GcodeFile& file, uint32_t block);

// The lines of one link with the labels of other objects.
class ExchangedLabels {
 public:
  // `link` stands before block `place` in the file; here it leads from block `from` to block `to`.
  ExchangedLabels(const GcodeFile& file, const Link& link, uint32_t place, uint32_t from,
                  uint32_t to);

  // The line to write for step `i`, as raw text.
  std::string_view LineOf(size_t i) const;

 private:
  // Takes `mine` of the link before block `other` for `theirs` of this one.
  void Exchange(uint32_t other, bool begins);

  const GcodeFile& file_;
  const Link& link_;
  const LabelLines lines_;
  std::vector<std::string_view> other_;  // [step], empty for its own
};

// The link before block `block` has labels and what leads from path to path, and nothing else but
// lines of progress, which stand by the time.
bool SaysLabelsOnly(const GcodeFile& file, uint32_t block);

// What keeps the object that begins with block `one`, or ends before it, from standing where that
// of block `other` does: the lines that begin it, or end it, are not of the same sorts, some of them
// stand among lines that stay, or such a line stands within one of the objects, apart from these.
bool BeginsAlike(const GcodeFile& file, uint32_t one, uint32_t other);
bool EndsAlike(const GcodeFile& file, uint32_t one, uint32_t other);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_LINK_LABEL_LINES_H_

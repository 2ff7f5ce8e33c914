// The labels of objects that stand in a link, and whose they are.
//
//   ... ; stop printing object A | EXCLUDE_OBJECT_END NAME=A | ; printing object B | ...
//       `----------- end the object before ---------------'   `- begin the next -'
//
// Where whole objects change places, the rest of a link stays where it is in the layer, and the
// lines that name an object are exchanged for those of the object that stands there now.

#ifndef TRAVERSE_CLIENT_GCODE_LINK_LABEL_LINES_H_
#define TRAVERSE_CLIENT_GCODE_LINK_LABEL_LINES_H_

#include <cstdint>
#include <string_view>
#include <vector>

#include "client/gcode/link/link.h"
#include "client/gcode/model/gcode_file.h"

namespace traverse::gcode {

// The first block of the object that `block` is of: of the run of blocks of its layer under one
// label.
uint32_t ObjectBegin(const GcodeFile& file, uint32_t block);

// [step] the line to write for it, as raw text, where `link`, which stands before block `place` in
// the file, leads from block `from` to block `to`.
std::vector<std::string_view> LabelledLines(const GcodeFile& file, const Link& link, uint32_t place,
                                            uint32_t from, uint32_t to);

// The link before block `block` has labels and what leads from path to path, and nothing else but
// lines of progress, which stand by the time.
bool SaysLabelsOnly(const GcodeFile& file, uint32_t block);

// What keeps the object that begins with block `one`, or ends before it, from standing where that
// of block `other` does: the lines that begin it, or end it, are not of the same sorts, some of
// them stand among lines that stay, or such a line stands within one of the objects, apart from
// these.
bool BeginsAlike(const GcodeFile& file, uint32_t one, uint32_t other);
bool EndsAlike(const GcodeFile& file, uint32_t one, uint32_t other);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_LINK_LABEL_LINES_H_

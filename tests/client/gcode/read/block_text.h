// The text of a block.

#ifndef TRAVERSE_TESTS_CLIENT_GCODE_READ_BLOCK_TEXT_H_
#define TRAVERSE_TESTS_CLIENT_GCODE_READ_BLOCK_TEXT_H_

#include <string>

#include "client/gcode/model/gcode_file.h"

namespace traverse::gcode {

inline std::string TextOf(const GcodeFile& file, const Block& block) {
  return file.text.substr(block.begin, block.end - block.begin);
}

}  // namespace traverse::gcode

#endif  // TRAVERSE_TESTS_CLIENT_GCODE_READ_BLOCK_TEXT_H_

// A file as text, read as tests need it.

#ifndef TRAVERSE_TESTS_CLIENT_GCODE_SUPPORT_READ_TEXT_H_
#define TRAVERSE_TESTS_CLIENT_GCODE_SUPPORT_READ_TEXT_H_

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "client/gcode/read/reader.h"

namespace traverse::gcode::testing {

// The file named "part.gcode". If it cannot be read, the test fails and an empty file comes back.
inline std::shared_ptr<GcodeFile> Read(const std::string& text) {
  absl::StatusOr<std::shared_ptr<GcodeFile>> file = ReadGcode(text, "part.gcode");
  EXPECT_TRUE(file.ok()) << file.status();
  return file.ok() ? *file : std::make_shared<GcodeFile>();
}

}  // namespace traverse::gcode::testing

#endif  // TRAVERSE_TESTS_CLIENT_GCODE_SUPPORT_READ_TEXT_H_

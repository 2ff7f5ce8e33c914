// Files of a folder that goes with the test.

#ifndef TRAVERSE_TESTS_CLIENT_FILES_SCRATCH_FILES_H_
#define TRAVERSE_TESTS_CLIENT_FILES_SCRATCH_FILES_H_

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/scratch_folder.h"

namespace traverse {

class ScratchFiles : public ::testing::Test {
 protected:
  std::string Path(const std::string& name) const { return scratch_.Path(name); }
  void Put(const std::string& name, const std::string& bytes) const {
    std::ofstream(Path(name), std::ios::binary) << bytes;
  }
  std::string Get(const std::string& name) const {
    std::ifstream file(Path(name), std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  }

  const testing::ScratchFolder scratch_;
  const std::filesystem::path folder_ = scratch_.path();
};

}  // namespace traverse

#endif  // TRAVERSE_TESTS_CLIENT_FILES_SCRATCH_FILES_H_

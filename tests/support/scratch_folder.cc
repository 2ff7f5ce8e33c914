#include "tests/support/scratch_folder.h"

#include <stdlib.h>

#include <filesystem>
#include <system_error>

namespace traverse::testing {

ScratchFolder::ScratchFolder()
    : path_(std::filesystem::temp_directory_path() / "traverse_test_XXXXXX") {
  if (mkdtemp(path_.data()) == nullptr) std::abort();
}

ScratchFolder::~ScratchFolder() {
  // What is left behind harms nobody; a destructor must not throw.
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace traverse::testing

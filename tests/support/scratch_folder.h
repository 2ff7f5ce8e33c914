#ifndef TRAVERSE_TESTS_SUPPORT_SCRATCH_FOLDER_H_
#define TRAVERSE_TESTS_SUPPORT_SCRATCH_FOLDER_H_

#include <string>

namespace traverse::testing {

// A new, empty folder of the test's own below the system's folder for temporary files; it and all
// in it are gone with the object. Aborts if there can be none.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::string& path() const { return path_; }
  // The path of `name` in it; nothing is made.
  std::string Path(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

}  // namespace traverse::testing

#endif  // TRAVERSE_TESTS_SUPPORT_SCRATCH_FOLDER_H_

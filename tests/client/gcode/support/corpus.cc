#include "tests/client/gcode/support/corpus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "client/files/read_file.h"
#include "tests/support/golden.h"

namespace traverse::gcode::testing {
namespace {

std::vector<std::string> FilesIn(const std::filesystem::path& folder) {
  std::vector<std::string> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().filename().string().find(".gcode") != std::string::npos) {
      files.push_back(entry.path().string());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

std::vector<std::string> KeptFiles() { return FilesIn(traverse::testing::DataPath("gcode")); }

std::vector<std::string> CorpusFiles() {
  if (const char* folder = std::getenv("TRAVERSE_CORPUS")) return FilesIn(folder);
  const std::filesystem::path root =
      std::filesystem::path(traverse::testing::DataPath("")).parent_path().parent_path();
  for (std::filesystem::path at = root; at.has_relative_path(); at = at.parent_path()) {
    const std::vector<std::string> files = FilesIn(at.parent_path() / "shared/corpus/gcode");
    if (!files.empty()) return files;
  }
  return {};
}

std::string TextOf(const std::string& path) {
  absl::StatusOr<std::string> text = ReadWholeFile(path);
  EXPECT_TRUE(text.ok()) << text.status();
  return text.ok() ? *std::move(text) : "";
}

std::string NameOf(const std::string& path) {
  const std::string name = std::filesystem::path(path).filename().string();
  return name.substr(0, name.find('.'));
}

}  // namespace traverse::gcode::testing

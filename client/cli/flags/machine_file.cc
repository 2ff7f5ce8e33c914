#include "client/cli/flags/machine_file.h"

#include <glob.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "client/files/read_file.h"

namespace traverse::cli {
namespace {

// Of all files together, each as often as it is included.
constexpr size_t kMostBytes = size_t{16} << 20;
constexpr size_t kMostFiles = 1000;

// `folder` as a pattern that means only itself.
std::string Literally(const std::string& folder) {
  std::string out;
  for (const char c : folder) {
    if (c == '*' || c == '?' || c == '[' || c == '\\') out.push_back('\\');
    out.push_back(c);
  }
  return out;
}

absl::StatusOr<std::vector<std::string>> NamesOf(const std::string& pattern,
                                                 const std::string& from) {
  std::string all = pattern;
  if (std::filesystem::path(pattern).is_relative()) {
    const std::string folder = std::filesystem::path(from).parent_path().string();
    if (!folder.empty()) all = absl::StrCat(Literally(folder), "/", pattern);
  }
  glob_t found = {};
  const std::unique_ptr<glob_t, decltype(&globfree)> owner(&found, &globfree);
  const int code = glob(all.c_str(), 0, nullptr, &found);
  const bool has_wildcards = pattern.find_first_of("*?[") != std::string::npos;
  if (code == GLOB_NOMATCH && has_wildcards) return std::vector<std::string>();
  if (code != 0) {
    return absl::NotFoundError(absl::StrCat("\"", pattern, "\": there is no such file to include"));
  }
  return std::vector<std::string>(found.gl_pathv, found.gl_pathv + found.gl_pathc);
}

class MachineFileReader {
 public:
  absl::StatusOr<std::string> Read(const std::string& name) {
    if (files_left_-- == 0) {
      return absl::ResourceExhaustedError(
          absl::StrCat("more than ", kMostFiles, " files are included"));
    }
    absl::StatusOr<std::string> text = ReadWholeFile(name, bytes_left_);
    if (text.ok()) bytes_left_ -= text->size();
    return text;
  }

  absl::StatusOr<std::vector<gcode::IncludedFile>> ReadIncluded(const std::string& pattern,
                                                                const std::string& from) {
    const absl::StatusOr<std::vector<std::string>> names = NamesOf(pattern, from);
    if (!names.ok()) return names.status();
    std::vector<gcode::IncludedFile> files;
    for (const std::string& name : *names) {
      absl::StatusOr<std::string> text = Read(name);
      if (!text.ok()) return text.status();
      files.push_back({name, *std::move(text)});
    }
    return files;
  }

 private:
  size_t bytes_left_ = kMostBytes;
  size_t files_left_ = kMostFiles;
};

}  // namespace

absl::StatusOr<gcode::MachineLimits> ReadMachineFile(const std::string& name) {
  MachineFileReader reader;
  const absl::StatusOr<std::string> text = reader.Read(name);
  if (!text.ok()) return text.status();
  const auto includes = [&reader](const std::string& pattern, const std::string& from) {
    return reader.ReadIncluded(pattern, from);
  };
  return gcode::ReadMachineLimits(*text, DisplayName(name), includes);
}

}  // namespace traverse::cli

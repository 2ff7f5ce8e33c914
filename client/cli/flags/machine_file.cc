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

constexpr size_t kMostBytes = size_t{16} << 20;  // of a file
constexpr size_t kMostFiles = 1000;              // that one line may include

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
  if (found.gl_pathc > kMostFiles) {
    return absl::InvalidArgumentError(
        absl::StrCat("\"", pattern, "\": means more than ", kMostFiles, " files"));
  }
  return std::vector<std::string>(found.gl_pathv, found.gl_pathv + found.gl_pathc);
}

absl::StatusOr<std::vector<gcode::IncludedFile>> ReadIncluded(const std::string& pattern,
                                                              const std::string& from) {
  const absl::StatusOr<std::vector<std::string>> names = NamesOf(pattern, from);
  if (!names.ok()) return names.status();
  std::vector<gcode::IncludedFile> files;
  for (const std::string& name : *names) {
    absl::StatusOr<std::string> text = ReadWholeFile(name, kMostBytes);
    if (!text.ok()) return text.status();
    files.push_back({name, *std::move(text)});
  }
  return files;
}

}  // namespace

absl::StatusOr<gcode::MachineLimits> ReadMachineFile(const std::string& name) {
  const absl::StatusOr<std::string> text = ReadWholeFile(name, kMostBytes);
  if (!text.ok()) return text.status();
  return gcode::ReadMachineLimits(*text, DisplayName(name), &ReadIncluded);
}

}  // namespace traverse::cli

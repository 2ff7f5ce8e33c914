// Bytes as a zip archive with G-code, through its reader and writer.
//
// Rules: a refusal is the file's fault and names it; what is read is written, and read again it is
// the same, with the other entries byte by byte.

#include <algorithm>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "absl/strings/match.h"
#include "client/containers/container.h"
#include "client/containers/zip/archive.h"
#include "client/files/md5.h"
#include "tests/client/containers/zip_maker.h"
#include "tests/fuzz/support/byte_changes.h"
#include "tests/fuzz/support/check.h"

namespace traverse::fuzz {
namespace {

using testing::MadeEntry;

void CheckRefusal(const absl::Status& status) {
  Check(absl::IsInvalidArgument(status) || absl::IsResourceExhausted(status), status.ToString());
  Check(absl::StartsWith(status.message(), "in.3mf: "), status.ToString());
}

// A good archive of a random shape.
std::string FreshArchive(std::mt19937& random) {
  const std::string gcode = "G28\nG1 X1 Y" + std::to_string(random() % 100) + "\n";
  const bool ufp = random() % 4 == 0;
  std::vector<MadeEntry> entries;
  const auto add = [&](const std::string& name, const std::string& content) {
    MadeEntry& entry = entries.emplace_back();
    entry.name = ufp ? "/" + name : name;
    entry.content = content;
    entry.deflated = random() % 3 != 0;
    entry.descriptor = random() % 3 == 0;
    if (random() % 4 == 0) entry.local_extra = std::string("\x01\x00\x04\x00zzzz", 8);
    if (random() % 4 == 0) entry.extra = std::string("\xfe\xca\x00\x00", 4);
    if (random() % 4 == 0) entry.gap = "gap";
  };
  add("Metadata/thumbnail.png", "picture");
  if (ufp) add("3D/model.gcode", gcode);
  for (size_t plate = 1 + random() % 2; plate > 0 && !ufp; --plate) {
    const std::string name = "Metadata/plate_" + std::to_string(plate) + ".gcode";
    add(name, gcode);
    if (random() % 2 == 0) add(name + ".md5", Md5Hex(gcode) + "\n");
  }
  if (!ufp) {
    add("Metadata/slice_info.config",
        "<plate><metadata key=\"index\" value=\"1\"/><metadata key=\"prediction\" "
        "value=\"9\"/></plate>");
  }
  return MakeZip(entries, random() % 2 == 0 ? "comment" : "").bytes;
}

void CheckOthers(const std::string& before, const std::string& after,
                 const std::map<size_t, NewPart>& parts, const Container& container) {
  const auto was = containers::ParseZip(before);
  const auto is = containers::ParseZip(after);
  Check(was.ok() && is.ok() && was->entries.size() == is->entries.size(), "the same entries");
  for (size_t i = 0; i < was->entries.size(); ++i) {
    const containers::ZipEntry& a = was->entries[i];
    const containers::ZipEntry& b = is->entries[i];
    Check(a.name == b.name && a.method == b.method, "the same names and methods");
    bool touched = absl::EndsWith(std::string(a.name), ".config");
    for (const auto& [index, part] : parts) {
      const std::string& name = container.parts()[index].name;
      touched = touched || a.name == name || a.name == name + ".md5";
    }
    if (touched) continue;
    Check(before.substr(a.begin, a.end - a.begin) == after.substr(b.begin, b.end - b.begin),
          "entries stay byte by byte");
  }
}

}  // namespace
}  // namespace traverse::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace traverse;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  if (DetectContainer(bytes) != ContainerKind::kGcode3mf) return 0;
  ContainerOptions options;
  options.max_text_bytes = size_t{8} << 20;
  options.ignore_md5 = size % 2 == 0;
  const auto container = OpenContainer(bytes, "in.3mf", options);
  if (!container.ok()) {
    fuzz::CheckRefusal(container.status());
    return 0;
  }
  (*container)->Facts();
  std::map<size_t, NewPart> parts;
  for (size_t i = 0; i < (*container)->parts().size(); ++i) {
    const auto text = (*container)->Text(i);
    if (!text.ok()) {
      fuzz::CheckRefusal(text.status());
      continue;
    }
    parts[i] = {*text + "; more\n", gcode::TimeScale{0.5, 0.5}};
  }
  const auto written = (*container)->WithParts(parts);
  if (!written.ok()) {  // a digest that cannot be read is seen late where it does not matter
    fuzz::CheckRefusal(written.status());
    return 0;
  }
  fuzz::CheckOthers(bytes, *written, parts, **container);
  const auto again = OpenContainer(*written, "in.3mf", options);
  fuzz::Check(again.ok(), again.status().ToString());
  for (const auto& [index, part] : parts) {
    const auto text = (*again)->Text(index);
    fuzz::Check(text.ok() && *text == part.text, "what is written is what is read");
  }
  return 0;
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size,
                                          unsigned int seed) {
  std::mt19937 random(seed);
  std::string bytes(reinterpret_cast<const char*>(data), size);
  if (size < 4 || random() % 8 == 0) {
    bytes = traverse::fuzz::FreshArchive(random);
  } else {
    traverse::fuzz::ChangeBytes(bytes, random() % 64 == 0 ? 0 : 4, random);
  }
  const size_t out = std::min(bytes.size(), max_size);
  std::memcpy(data, bytes.data(), out);
  return out;
}

// A zip archive of two plates.

#ifndef TRAVERSE_TESTS_CLIENT_CONTAINERS_ZIP_PLATES_H_
#define TRAVERSE_TESTS_CLIENT_CONTAINERS_ZIP_PLATES_H_

#include <memory>
#include <string>
#include <vector>

#include "client/containers/container.h"
#include "client/files/md5.h"
#include "tests/client/containers/zip_maker.h"

namespace traverse::containers {

inline constexpr const char* kPlatesName = "plates.gcode.3mf";
inline constexpr size_t kPlatesLimit = size_t{1} << 24;

inline const std::string kSliceInfo =
    "<config>\n  <plate>\n    <metadata key=\"index\" value=\"1\"/>\n"
    "    <metadata key=\"prediction\" value=\"543\"/>\n"
    "    <metadata key=\"first_layer_time\" value=\"137.977020\"/>\n  </plate>\n"
    "  <plate>\n    <metadata key=\"index\" value=\"2\"/>\n"
    "    <metadata key=\"prediction\" value=\"1000\"/>\n  </plate>\n</config>\n";

inline const std::string kPlate1 = "; plate 1\nG28\nG1 X1\n";
inline const std::string kPlate2 = "; plate 2\nG28\nG1 X2\n";

// Two plates, the second one first; streamed, aligned and stored entries.
inline std::vector<testing::MadeEntry> Plates() {
  using namespace std::string_literals;
  return {
      {.name = "[Content_Types].xml", .content = "<Types/>", .descriptor = true},
      {.name = "Metadata/plate_2.gcode", .content = kPlate2, .descriptor = true, .gap = "padding"},
      {.name = "Metadata/plate_2.gcode.md5", .content = Md5Hex(kPlate2), .deflated = false},
      {.name = "Metadata/plate_1.gcode",
       .content = kPlate1,
       .local_extra = "\x01\x00\x08\x00zip64...\xfe\xca\x00\x00"s,
       .extra = "\xfe\xca\x02\x00xy"s},
      {.name = "Metadata/plate_1.gcode.md5", .content = Md5Hex(kPlate1) + "\n"},
      {.name = "Metadata/slice_info.config", .content = kSliceInfo, .extra = "\xfe\xca\x02\x00xy"s},
      {.name = "Metadata/plate_1.png", .content = "picture", .deflated = false, .gap = "##"},
  };
}

inline absl::StatusOr<std::unique_ptr<Container>> Open(const std::string& bytes,
                                                       bool ignore_md5 = false) {
  ContainerOptions options;
  options.ignore_md5 = ignore_md5;
  return OpenContainer(bytes, kPlatesName, options);
}

}  // namespace traverse::containers

#endif  // TRAVERSE_TESTS_CLIENT_CONTAINERS_ZIP_PLATES_H_

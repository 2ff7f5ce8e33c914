// Zip archives, whole and damaged: client/containers/zip/archive.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "client/containers/bytes.h"
#include "tests/client/containers/zip/plates.h"
#include "tests/client/containers/zip_maker.h"
#include "tests/support/status_matchers.h"

namespace traverse::containers {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;
using namespace std::string_literals;
using testing::MadeEntry;
using testing::MadeZip;
using testing::MakeZip;
using testing::StatusIs;

TEST(Zip, RefusesNamesThatLeadElsewhere) {
  for (const char* name : {"../plate_1.gcode", "Metadata/../../x", "Metadata/..", "C:/x", "a\\b",
                           "//x", "/etc/passwd"}) {
    std::vector<MadeEntry> entries = Plates();
    entries.push_back({.name = name, .content = "x"});
    EXPECT_THAT(Open(MakeZip(entries).bytes),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("name")))
        << name;
  }
}

TEST(Zip, RefusesTwoEntriesOfOneName) {
  std::vector<MadeEntry> entries = Plates();
  entries.push_back({.name = "Metadata/plate_1.gcode", .content = "G28\n"});
  EXPECT_THAT(Open(MakeZip(entries).bytes),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("entry Metadata/plate_1.gcode: there are two with that name")));
}

TEST(Zip, RefusesEncryptedEntries) {
  std::vector<MadeEntry> entries = Plates();
  entries[3].flags = 1;
  EXPECT_THAT(Open(MakeZip(entries).bytes),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("entry Metadata/plate_1.gcode: it is encrypted")));
}

TEST(Zip, RefusesUnknownCompression) {
  std::vector<MadeEntry> entries = Plates();
  entries[3].method = 93;
  const auto container = Open(MakeZip(entries).bytes);
  ASSERT_OK(container);
  EXPECT_THAT((*container)->Text(0),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("entry Metadata/plate_1.gcode: compression 93 is unknown")));
}

TEST(Zip, RefusesZip64) {
  const MadeZip zip = MakeZip(Plates());
  std::string entry = zip.bytes;
  StoreU32(entry, zip.record[3] + 24, 0xffffffff);
  EXPECT_THAT(Open(entry), StatusIs(absl::StatusCode::kInvalidArgument,
                                    HasSubstr("entry Metadata/plate_1.gcode: it is a zip64")));
  std::string archive = zip.bytes;
  archive.insert(zip.end, "PK\x06\x07"s + std::string(16, '\0'));
  EXPECT_THAT(Open(archive), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("zip64")));
}

TEST(Zip, RefusesSizesThatLie) {
  const MadeZip zip = MakeZip(Plates());
  // Sizes of plate 1, in the directory and before its data.
  const auto lies = [&](size_t record, size_t local, uint32_t size) {
    std::string bytes = zip.bytes;
    StoreU32(bytes, zip.record[3] + record, size);
    StoreU32(bytes, zip.local[3] + local, size);
    return bytes;
  };
  EXPECT_THAT(Open(lies(20, 18, 0xf0000000)),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("entry Metadata/plate_1.gcode: it states 4026531840 bytes")));
  EXPECT_THAT(Open(lies(24, 22, 0xf0000000)),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("it states 3840 MiB")));
  const auto large = Open(lies(24, 22, 0x2000000));
  ASSERT_OK(large);
  EXPECT_THAT((*large)->Text(0),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("cannot be 33554432 bytes")));
}

TEST(Zip, RefusesABomb) {
  const std::string zeros(size_t{100} << 20, '0');
  const std::string bytes = MakeZip({{.name = "Metadata/plate_1.gcode", .content = zeros}}).bytes;
  ASSERT_LT(bytes.size(), size_t{1} << 18);
  EXPECT_THAT(Open(bytes), StatusIs(absl::StatusCode::kResourceExhausted,
                                    HasSubstr("states 100 MiB, which makes 100 MiB of G-code")));
}

TEST(Zip, RefusesEntriesThatLieOverEachOther) {
  const MadeZip zip = MakeZip({{.name = "Metadata/plate_1.gcode", .content = kPlate1},
                               {.name = "Metadata/plate_2.gcode", .content = kPlate1}});
  std::string bytes = zip.bytes;
  // The second record's data are the first one's.
  StoreU32(bytes, zip.record[1] + 42, static_cast<uint32_t>(zip.local[0]));
  EXPECT_THAT(Open(bytes), StatusIs(absl::StatusCode::kInvalidArgument,
                                    HasSubstr("its local header differs from the directory")));
}

TEST(Zip, RefusesAFileThatIsCutShortAnywhere) {
  const std::string bytes = MakeZip(Plates()).bytes;
  for (size_t size = 4; size < bytes.size(); ++size) {
    EXPECT_THAT(Open(bytes.substr(0, size)),
                StatusIs(absl::StatusCode::kInvalidArgument, StartsWith(kPlatesName)))
        << size;
  }
}

// What is read of a damaged archive is what it was, or it is refused.
TEST(Zip, NeverReadsAnotherText) {
  const std::string bytes = MakeZip(Plates()).bytes;
  for (size_t at = 4; at < bytes.size(); ++at) {
    std::string bad = bytes;
    bad[at] = static_cast<char>(bad[at] ^ 0x10);
    const auto container = Open(bad);
    if (!container.ok()) continue;
    for (size_t i = 0; i < (*container)->parts().size(); ++i) {
      const auto text = (*container)->Text(i);
      if (!text.ok()) continue;
      EXPECT_EQ(*text, (*container)->parts()[i].plate == 2 ? kPlate2 : kPlate1) << at;
    }
  }
}

}  // namespace
}  // namespace traverse::containers

// Zip archives, and those that hold G-code.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "client/containers/bytes.h"
#include "client/containers/container.h"
#include "client/containers/zip/archive.h"
#include "client/containers/zip/md5.h"
#include "client/containers/zip/slice_info.h"
#include "tests/client/containers/zip_maker.h"
#include "tests/support/status_matchers.h"

namespace traverse::containers {
namespace {

using namespace std::string_literals;
using ::testing::HasSubstr;
using testing::MadeEntry;
using testing::MadeZip;
using testing::MakeZip;
using ::testing::StartsWith;
using testing::StatusIs;

constexpr const char* kName = "plates.gcode.3mf";
constexpr size_t kPlenty = size_t{1} << 24;

const std::string kSliceInfo =
    "<config>\n  <plate>\n    <metadata key=\"index\" value=\"1\"/>\n"
    "    <metadata key=\"prediction\" value=\"543\"/>\n"
    "    <metadata key=\"first_layer_time\" value=\"137.977020\"/>\n  </plate>\n"
    "  <plate>\n    <metadata key=\"index\" value=\"2\"/>\n"
    "    <metadata key=\"prediction\" value=\"1000\"/>\n  </plate>\n</config>\n";

const std::string kPlate1 = "; plate 1\nG28\nG1 X1\n";
const std::string kPlate2 = "; plate 2\nG28\nG1 X2\n";

// Two plates, the second one first; streamed, aligned and stored entries.
std::vector<MadeEntry> Plates() {
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

absl::StatusOr<std::unique_ptr<Container>> Open(const std::string& bytes, bool ignore_md5 = false) {
  ContainerOptions options;
  options.ignore_md5 = ignore_md5;
  return OpenContainer(bytes, kName, options);
}

std::string Content(const std::string& zip, const std::string& name) {
  const auto archive = ParseZip(zip);
  EXPECT_OK(archive);
  const ZipEntry* entry = archive->Find(name);
  EXPECT_NE(entry, nullptr) << name;
  const auto content = ReadEntry(*archive, *entry, kPlenty);
  EXPECT_OK(content);
  return *content;
}

// Local header, data and descriptor of an entry, byte by byte.
std::string Raw(const std::string& zip, const std::string& name) {
  const auto archive = ParseZip(zip);
  EXPECT_OK(archive);
  const ZipEntry* entry = archive->Find(name);
  return zip.substr(entry->begin, entry->end - entry->begin);
}

TEST(GcodeZip, HasItsPlatesByNumber) {
  const auto container = Open(MakeZip(Plates(), "a comment").bytes);

  ASSERT_OK(container);
  EXPECT_EQ((*container)->kind(), ContainerKind::kGcode3mf);
  ASSERT_EQ((*container)->parts().size(), 2u);
  EXPECT_EQ((*container)->parts()[0].plate, 1u);
  EXPECT_EQ(*(*container)->Text(0), kPlate1);
  EXPECT_EQ(*(*container)->Text(1), kPlate2);
  EXPECT_EQ(*(*container)->TextBytes(), kPlate1.size() + kPlate2.size());
  EXPECT_EQ(*FindPlate(**container, 2, kName), 1u);
  EXPECT_THAT(FindPlate(**container, 3, kName),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("no plate 3, only 1, 2")));
}

TEST(GcodeZip, ReplacesAPlateAndItsDigestAlone) {
  const std::string before = MakeZip(Plates(), "a comment").bytes;
  const auto container = Open(before);
  ASSERT_OK(container);

  const auto after = (*container)->WithParts({{0, {"; shorter\n", {}}}});

  ASSERT_OK(after);
  EXPECT_EQ(Content(*after, "Metadata/plate_1.gcode"), "; shorter\n");
  EXPECT_EQ(Content(*after, "Metadata/plate_1.gcode.md5"), Md5Hex("; shorter\n") + "\n");
  for (const MadeEntry& entry : Plates()) {
    if (entry.name.starts_with("Metadata/plate_1.gcode")) continue;
    EXPECT_EQ(Raw(*after, entry.name), Raw(before, entry.name)) << entry.name;
  }
  const auto was = ParseZip(before);
  const auto is = ParseZip(*after);
  for (size_t i = 0; i < was->entries.size(); ++i) {
    EXPECT_EQ(is->entries[i].name, was->entries[i].name);
    EXPECT_EQ(is->entries[i].method, was->entries[i].method);
    const std::string times = before.substr(was->entries[i].record + 12, 4);
    EXPECT_EQ(after->substr(is->entries[i].record + 12, 4), times);
  }
  EXPECT_TRUE(after->ends_with("a comment"));
  EXPECT_THAT(*after, HasSubstr("padding"));
}

TEST(GcodeZip, GivesTheSameBytesForTheSameTexts) {
  const std::string before = MakeZip(Plates()).bytes;
  const auto container = Open(before);
  ASSERT_OK(container);

  EXPECT_EQ(*(*container)->WithParts({}), before);
  // The second plate was streamed: its sizes are in its header now.
  const auto once = (*container)->WithParts({{0, {kPlate1, {}}}, {1, {kPlate2, {}}}});
  ASSERT_OK(once);
  const auto again = Open(*once);
  ASSERT_OK(again);
  EXPECT_EQ(*(*again)->WithParts({{0, {kPlate1, {}}}, {1, {kPlate2, {}}}}), *once);
}

TEST(GcodeZip, RestatesThePlatesPrediction) {
  const auto container = Open(MakeZip(Plates()).bytes);
  ASSERT_OK(container);

  const auto after = (*container)->WithParts({{0, {"; x\n", gcode::TimeScale{0.9, 0.5}}}});

  ASSERT_OK(after);
  const std::string info = Content(*after, "Metadata/slice_info.config");
  EXPECT_EQ(PlateValue(info, 1, "prediction"), "489");
  EXPECT_EQ(PlateValue(info, 1, "first_layer_time"), "68.988510");
  EXPECT_EQ(PlateValue(info, 2, "prediction"), "1000");
  EXPECT_EQ(RestatePlate(kSliceInfo, 1, {1, 1}), kSliceInfo);
}

TEST(GcodeZip, RefusesAWrongDigestUnlessTold) {
  std::vector<MadeEntry> entries = Plates();
  entries[4].content = Md5Hex("another text");
  const std::string bytes = MakeZip(entries).bytes;

  const auto container = Open(bytes);
  ASSERT_OK(container);
  EXPECT_THAT(
      (*container)->Text(0),
      StatusIs(absl::StatusCode::kInvalidArgument,
               HasSubstr("plates.gcode.3mf: entry Metadata/plate_1.gcode.md5: the MD5 of")));
  EXPECT_OK((*container)->Text(1));

  const auto trusting = Open(bytes, /*ignore_md5=*/true);
  ASSERT_OK(trusting);
  EXPECT_OK((*trusting)->Text(0));
  const auto written = (*trusting)->WithParts({{0, {kPlate1, {}}}});
  ASSERT_OK(written);
  EXPECT_EQ(Content(*written, "Metadata/plate_1.gcode.md5"), Md5Hex(kPlate1));
}

TEST(GcodeZip, ReadsPackagesOfUltimaker) {
  for (const char* slash : {"/", ""}) {
    const std::string model = slash + "3D/model.gcode"s;
    const std::string bytes = MakeZip({{.name = slash + "Metadata/thumbnail.png"s, .content = "x"},
                                       {.name = model, .content = kPlate1}})
                                  .bytes;
    const auto container = Open(bytes);
    ASSERT_OK(container);
    EXPECT_EQ((*container)->kind(), ContainerKind::kUfp);
    const auto after = (*container)->WithParts({{0, {"; x\n", {}}}});
    ASSERT_OK(after);
    EXPECT_EQ(Content(*after, model), "; x\n");
    EXPECT_EQ(*(*container)->Text(0), kPlate1);
  }
}

TEST(GcodeZip, RefusesArchivesWithoutGcode) {
  EXPECT_THAT(Open(MakeZip({{.name = "3D/3dmodel.model", .content = "<model/>"}}).bytes),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("without G-code")));
  EXPECT_THAT(Open(MakeZip({}).bytes),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("without G-code")));
  // No plates: nothing but their looks.
  EXPECT_THAT(Open(MakeZip({{.name = "Metadata/plate_0.gcode", .content = ""},
                            {.name = "Metadata/plate_1x.gcode", .content = ""},
                            {.name = "Metadata/plate_99999999999.gcode", .content = ""}})
                       .bytes),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("without G-code")));
}

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
                       HasSubstr("entry Metadata/plate_1.gcode: there are two of that name")));
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
                       HasSubstr("entry Metadata/plate_1.gcode: compression 93 is not known")));
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
                       HasSubstr("entry Metadata/plate_1.gcode: it announces 4026531840 bytes")));
  EXPECT_THAT(Open(lies(24, 22, 0xf0000000)),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("it announces 3840 MiB")));
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
                                    HasSubstr("announces 100 MiB, which makes 100 MiB of G-code")));
}

TEST(GcodeZip, RefusesPlatesThatAreTooMuchTogether) {
  const std::string text(size_t{1} << 20, ';');
  std::vector<MadeEntry> entries;
  for (int plate = 1; plate <= 3; ++plate) {
    entries.push_back(
        {.name = "Metadata/plate_" + std::to_string(plate) + ".gcode", .content = text});
  }
  ContainerOptions options;
  options.max_text_bytes = 3 * text.size();
  EXPECT_OK(OpenContainer(MakeZip(entries).bytes, kName, options));
  options.max_text_bytes -= 1;
  EXPECT_THAT(OpenContainer(MakeZip(entries).bytes, kName, options),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("plate_3.gcode")));

  entries.assign(1001, {.name = "", .content = ";"});
  for (size_t i = 0; i < entries.size(); ++i) {
    entries[i].name = "Metadata/plate_" + std::to_string(i + 1) + ".gcode";
  }
  EXPECT_THAT(Open(MakeZip(entries).bytes),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("more than 1000 plates")));
}

// Each of the tags once went through all that follows: minutes for these.
TEST(SliceInfo, IsReadInLinearTime) {
  std::string open = "<plate>";
  while (open.size() < (size_t{4} << 20)) open += "<metadata ";
  for (const char* end : {"", ">", " key=\"index\" value=\"1\">"}) {
    EXPECT_EQ(PlateValue(open + end, 1, "prediction"), "");
  }
}

TEST(Zip, RefusesEntriesThatLieOverEachOther) {
  const MadeZip zip = MakeZip({{.name = "Metadata/plate_1.gcode", .content = kPlate1},
                               {.name = "Metadata/plate_2.gcode", .content = kPlate1}});
  std::string bytes = zip.bytes;
  // The second record's data are the first one's.
  StoreU32(bytes, zip.record[1] + 42, static_cast<uint32_t>(zip.local[0]));
  EXPECT_THAT(Open(bytes), StatusIs(absl::StatusCode::kInvalidArgument,
                                    HasSubstr("its local header is not what the directory says")));
}

TEST(Zip, RefusesAFileThatIsCutShortAnywhere) {
  const std::string bytes = MakeZip(Plates()).bytes;
  for (size_t size = 4; size < bytes.size(); ++size) {
    EXPECT_THAT(Open(bytes.substr(0, size)),
                StatusIs(absl::StatusCode::kInvalidArgument, StartsWith(kName)))
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

TEST(DetectContainer, LooksAtTheFirstBytes) {
  EXPECT_EQ(DetectContainer("GCDE\x01"), ContainerKind::kBgcode);
  EXPECT_EQ(DetectContainer("PK\x03\x04"), ContainerKind::kGcode3mf);
  EXPECT_EQ(DetectContainer("G28\n"), ContainerKind::kText);
  EXPECT_EQ(ContainerByExtension("a/B.BGCODE"), ContainerKind::kBgcode);
  EXPECT_EQ(ContainerByExtension("part.gcode.3mf"), ContainerKind::kGcode3mf);
  EXPECT_EQ(ContainerByExtension("part.gcode"), ContainerKind::kText);
  EXPECT_EQ(ContainerByExtension("part.json"), std::nullopt);
}

}  // namespace
}  // namespace traverse::containers

// Zip archives that hold G-code: client/containers/zip/gcode_zip.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "client/containers/container.h"
#include "client/containers/zip/archive.h"
#include "client/containers/zip/slice_info.h"
#include "client/files/md5.h"
#include "tests/client/containers/zip/plates.h"
#include "tests/client/containers/zip_maker.h"
#include "tests/support/status_matchers.h"

namespace traverse::containers {
namespace {

using ::testing::HasSubstr;
using namespace std::string_literals;
using testing::MadeEntry;
using testing::MakeZip;
using testing::StatusIs;

std::string Content(const std::string& zip, const std::string& name) {
  const auto archive = ParseZip(zip);
  EXPECT_OK(archive);
  const ZipEntry* entry = archive->Find(name);
  EXPECT_NE(entry, nullptr) << name;
  const auto content = ReadEntry(*archive, *entry, kPlatesLimit);
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
  EXPECT_EQ((*container)->StatedBytes(), kPlate1.size() + kPlate2.size());
  std::map<size_t, std::string> texts;
  ASSERT_OK((*container)->VisitTexts([&texts](size_t index, std::string_view piece) {
    texts[index] += piece;
  }));
  EXPECT_EQ(texts, (std::map<size_t, std::string>{{0, kPlate1}, {1, kPlate2}}));
  EXPECT_EQ(*FindPlate(**container, 2, kPlatesName), 1u);
  EXPECT_THAT(FindPlate(**container, 3, kPlatesName),
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

TEST(GcodeZip, RefusesPlatesThatAreTooMuchTogether) {
  const std::string text(size_t{1} << 20, ';');
  std::vector<MadeEntry> entries;
  for (int plate = 1; plate <= 3; ++plate) {
    entries.push_back(
        {.name = "Metadata/plate_" + std::to_string(plate) + ".gcode", .content = text});
  }
  ContainerOptions options;
  options.max_text_bytes = 3 * text.size();
  EXPECT_OK(OpenContainer(MakeZip(entries).bytes, kPlatesName, options));
  options.max_text_bytes -= 1;
  EXPECT_THAT(OpenContainer(MakeZip(entries).bytes, kPlatesName, options),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("plate_3.gcode")));

  entries.assign(1001, {.name = "", .content = ";"});
  for (size_t i = 0; i < entries.size(); ++i) {
    entries[i].name = "Metadata/plate_" + std::to_string(i + 1) + ".gcode";
  }
  EXPECT_THAT(Open(MakeZip(entries).bytes),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("more than 1000 plates")));
}

}  // namespace
}  // namespace traverse::containers

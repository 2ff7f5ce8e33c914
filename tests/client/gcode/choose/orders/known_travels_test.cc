#include "client/gcode/choose/orders/known_travels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "client/gcode/choose/merged_orders.h"
#include "client/gcode/link/link_donors.h"
#include "client/gcode/plan/layer_freedom.h"
#include "client/gcode/read/reader.h"
#include "client/gcode/write/layer_writer.h"
#include "tests/client/gcode/support/sketch.h"

namespace traverse::gcode {
namespace {

using testing::Sketch;

// What is known of the travel in one order holds in the next, whose objects stand elsewhere: the
// head waits between objects.
TEST(KnownTravels, HoldWhereverObjectsStand) {
  std::string text = "M83\nG1 Z.2 F9000\n";
  for (const auto& [object, lines] : {std::pair(0, 6), {2, 3}, {1, 8}, {3, 4}}) {
    text += absl::StrFormat("EXCLUDE_OBJECT_START NAME=part_%d\n", object);
    for (int y = 0; y < lines; ++y) {
      text += absl::StrFormat("G1 X%d Y%d F9000\n;TYPE:Internal infill\nG1 X%d F1200 E.5\n",
                              40 * object, 5 * y, 40 * object + 10);
    }
    text += absl::StrFormat("EXCLUDE_OBJECT_END NAME=part_%d\nG4 P%d\n", object, 500 + object);
  }
  const std::shared_ptr<GcodeFile> file = *ReadGcode(text, "part.gcode");
  const RetractionHabit habit = LearnRetraction(*file);
  const LinkDonors donors(*file);
  const LayerWriter writer(*file, file->layers[0], habit, donors);
  const LayerOrder given = writer.GivenOrder();
  LayerOrder moved = given;
  std::rotate(moved.begin() + 6, moved.begin() + 9, moved.begin() + 17);
  KnownTravels travels(writer);
  for (const LayerOrder& order : {given, moved, given}) {
    const std::vector<uint32_t> places = writer.PlacesOf(order);
    for (size_t i = 1; i < order.size(); ++i) {
      EXPECT_DOUBLE_EQ(travels(places[i], order[i - 1], order[i]).seconds,
                       writer.EstimateTravel(places[i], order[i - 1], order[i]).seconds)
          << i;
    }
  }
}

// Twenty lines of infill, in an order that leads back and forth.
class KnownTravelsTest : public ::testing::Test {
 protected:
  KnownTravelsTest() {
    Sketch sketch;
    for (int i = 0; i < 20; ++i) sketch.GoRetracted(7 * i % 20, 3).Infill(7 * i % 20, 8);
    file_ = sketch.Read();
    habit_ = LearnRetraction(*file_);
    donors_ = std::make_unique<LinkDonors>(*file_);
    writer_ = std::make_unique<LayerWriter>(*file_, file_->layers[0], habit_, *donors_);
    rules_.freedom = FreedomOf(*file_, file_->layers[0], Policy::kSafe, {});
    rules_.polish = PolishLimit();
    found_ = writer_->GivenOrder();
    std::reverse(found_.begin() + 1, found_.end());
  }

  std::shared_ptr<GcodeFile> file_;
  RetractionHabit habit_;
  std::unique_ptr<LinkDonors> donors_;
  std::unique_ptr<LayerWriter> writer_;
  MergeRules rules_;
  LayerOrder found_;
};

// The same moves are asked for when the order that was chosen of the merged ones is improved. What
// is known changes no order.
TEST_F(KnownTravelsTest, AreEstimatedOnceForAllThatIsDoneToALayer) {
  KnownTravels travels(*writer_);
  const std::vector<LayerOrder> merged = LayerMerge(travels, rules_).Merge(found_);
  const size_t by_merging = travels.size();
  const LayerOrder kicked =
      LayerMerge(travels, rules_).Improve(merged.front(), LayerMerge::Effort::kKick);

  KnownTravels others(*writer_);
  EXPECT_EQ(LayerMerge(others, rules_).Improve(merged.front(), LayerMerge::Effort::kKick), kicked);
  EXPECT_NE(kicked, writer_->GivenOrder());
  EXPECT_GT(by_merging, 100u);
  EXPECT_LT(travels.size() - by_merging, others.size() / 2);
}

TEST_F(KnownTravelsTest, ForgetWhatTakesTooMuchMemory) {
  KnownTravels travels(*writer_);
  const std::vector<LayerOrder> merged = LayerMerge(travels, rules_).Merge(found_);
  const size_t known = travels.size();

  travels.Shrink(known);
  EXPECT_EQ(travels.size(), known);
  travels.Shrink(known / 2);
  EXPECT_EQ(travels.size(), known / 2);
  EXPECT_EQ(LayerMerge(travels, rules_).Merge(found_), merged);
}

}  // namespace
}  // namespace traverse::gcode

#include "client/gcode/choose/merged_orders.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "client/gcode/choose/orders/known_travels.h"
#include "client/gcode/link/link_donors.h"
#include "client/gcode/machine/motion_planner.h"
#include "client/gcode/read/reader.h"
#include "client/gcode/write/layer_writer.h"
#include "tests/client/gcode/support/sketch.h"

namespace traverse::gcode {
namespace {

using testing::Sketch;

LayerOrder OrderOf(const std::vector<uint32_t>& blocks) {
  LayerOrder order;
  for (const uint32_t block : blocks) order.push_back({block, 0, block == 0});
  return order;
}

// A wall with infill on both sides of it. With an open nozzle the head crosses it for 1.1 mm, from
// the first infill to the second.
class MergedOrdersTest : public ::testing::Test {
 protected:
  MergedOrdersTest() {
    Sketch sketch;
    sketch.Square(0, 0, 40).GoRetracted(38, 5).Infill(39.5, 5).Go(40.6, 5).Infill(45, 5);
    sketch.GoRetracted(38, 20).Infill(39.3, 20).GoRetracted(20, 20).Infill(21, 20);
    sketch.GoRetracted(40.7, 20).Infill(45, 20).GoRetracted(60, 60).Infill(61, 60);
    file_ = sketch.Read();
    habit_ = LearnRetraction(*file_);
    donors_ = std::make_unique<LinkDonors>(*file_);
    writer_ = std::make_unique<LayerWriter>(*file_, file_->layers[0], habit_, *donors_);
  }

  std::vector<TravelTotals> TravelsOf(const LayerOrder& order) const {
    std::vector<TravelTotals> travels;
    for (size_t i = 1; i < order.size(); ++i) {
      travels.push_back(writer_->EstimateTravel(i, order[i - 1], order[i]));
    }
    return travels;
  }

  std::shared_ptr<GcodeFile> file_;
  RetractionHabit habit_;
  std::unique_ptr<LinkDonors> donors_;
  std::unique_ptr<LayerWriter> writer_;
};

TEST_F(MergedOrdersTest, HaveNoOpenTravelAcrossWallsThatIsLongerThanTheFiles) {
  const LayerOrder found = OrderOf({0, 2, 1, 4, 3, 5, 6});
  const TravelTotals across = TravelsOf(found)[4];
  ASSERT_EQ(across.open, 1);
  ASSERT_NEAR(across.mm, 1.4, 1e-6);
  MergeRules rules;
  rules.policy = Policy::kFree;
  rules.crossings = Crossings::kAny;

  KnownTravels travels(*writer_);
  const std::vector<LayerOrder> merged = LayerMerge(travels, rules).Merge(found);

  ASSERT_FALSE(merged.empty());
  for (const LayerOrder& order : merged) {
    for (const TravelTotals& travel : TravelsOf(order)) {
      EXPECT_TRUE(travel.open == 0 || travel.mm <= 1.1 + 1e-6) << travel.mm;
    }
  }
}

// Infill inside a wall and outside of it, by turns in the file; one side after the other crosses
// the wall less often and goes further.
TEST_F(MergedOrdersTest, TheBestMayTravelFurtherThanTheFile) {
  Sketch sketch;
  sketch.Square(0, 0, 40).GoRetracted(38, 5).Infill(39, 5).GoRetracted(41, 5).Infill(42, 5);
  sketch.GoRetracted(39, 35).Infill(38, 35).GoRetracted(42, 35).Infill(43, 35);
  const std::shared_ptr<GcodeFile> file = sketch.Read();
  const RetractionHabit habit = LearnRetraction(*file);
  const LinkDonors donors(*file);
  const LayerWriter writer(*file, file->layers[0], habit, donors);
  const LayerOrder found = OrderOf({0, 1, 3, 2, 4});
  MergeRules rules;
  rules.crossings = Crossings::kFewer;
  KnownTravels travels(writer);
  const std::vector<LayerOrder> orders = LayerMerge(travels, rules).Merge(found);

  // Once as what only the whole file can tell to cross too many walls, and once as the best of all
  // that keep to the limits.
  EXPECT_EQ(std::count(orders.begin(), orders.end(), found), 2);
}

// What is found is quicker within the wall, and beside it for more travel moves across.
TEST_F(MergedOrdersTest, TakeFromAnOrderWhatNeedsNoMoreCrossings) {
  Sketch sketch;
  sketch.Square(0, 0, 100);
  for (const double y : {5.0, 8.0}) {
    sketch.GoRetracted(2, y).Infill(3, y).GoRetracted(95, y).Infill(94, y);
  }
  sketch.GoRetracted(98, 20).Infill(99, 20).GoRetracted(98, 90).Infill(99, 90);
  sketch.GoRetracted(101, 20).Infill(102, 20).GoRetracted(101, 90).Infill(102, 90);
  const std::shared_ptr<GcodeFile> file = sketch.Read();
  const RetractionHabit habit = LearnRetraction(*file);
  const LinkDonors donors(*file);
  const LayerWriter writer(*file, file->layers[0], habit, donors);
  const LayerOrder found = OrderOf({0, 1, 3, 2, 4, 5, 7, 6, 8});
  MergeRules rules;
  rules.policy = Policy::kBalanced;
  const auto has = [&](const LayerOrder& order) {
    KnownTravels travels(writer);
    const std::vector<LayerOrder> orders = LayerMerge(travels, rules).Merge(found);
    return std::count(orders.begin(), orders.end(), order) > 0;
  };
  const LayerOrder sparing = OrderOf({0, 1, 3, 2, 4, 5, 6, 7, 8});

  EXPECT_TRUE(has(sparing));
  EXPECT_TRUE(has(found));
  rules.crossings = Crossings::kAny;
  EXPECT_FALSE(has(sparing));
  EXPECT_TRUE(has(found));
}

// Neither the file nor what was found has the lines in their order.
TEST_F(MergedOrdersTest, AreMadeBetterBySmallChangesWhereThoseAreAskedFor) {
  Sketch sketch;
  sketch.Square(0, 0, 100);
  for (const double x : {10.0, 50.0, 30.0, 70.0, 20.0, 60.0, 40.0, 90.0}) {
    sketch.GoRetracted(x, 10).Infill(x, 20);
  }
  const std::shared_ptr<GcodeFile> file = sketch.Read();
  const RetractionHabit habit = LearnRetraction(*file);
  const LinkDonors donors(*file);
  const LayerWriter writer(*file, file->layers[0], habit, donors);
  const LayerOrder found = OrderOf({0, 1, 3, 2, 5, 6, 7, 4, 8});
  const LayerFreedom freedom = FreedomOf(*file, file->layers[0], Policy::kSafe, {});
  const PolishLimit limit;
  MergeRules rules;
  const auto shortest = [&] {
    double mm = std::numeric_limits<double>::infinity();
    KnownTravels travels(writer);
    for (const LayerOrder& order : LayerMerge(travels, rules).Merge(found)) {
      TravelTotals totals;
      for (size_t i = 1; i < order.size(); ++i) {
        totals += writer.EstimateTravel(i, order[i - 1], order[i]);
      }
      mm = std::min(mm, totals.mm);
    }
    return mm;
  };

  const double merged = shortest();
  rules.freedom = freedom;
  rules.polish = limit;

  EXPECT_LT(shortest(), merged - 20);
}

TEST_F(MergedOrdersTest, TravelsOfTheFileTakeWhatTheirBendsTake) {
  Sketch sketch;
  sketch.Infill(10, 0).Go(10, 20).Go(30, 20).Infill(30, 30).Go(50, 20).Infill(50, 30);
  const std::shared_ptr<GcodeFile> file = sketch.Read();
  const LayerWriter writer(*file, file->layers[0], habit_, *donors_);
  const LayerOrder given = writer.GivenOrder();

  const TravelTotals bent = writer.EstimateTravel(1, given[0], given[1]);

  EXPECT_NEAR(bent.mm, 40, 1e-4);
  EXPECT_GT(bent.seconds, StopToStopSeconds(40, 150, 1250) + 0.01);
  EXPECT_LT(bent.seconds, 2 * StopToStopSeconds(20, 150, 1250) + 0.01);
  const TravelTotals straight = writer.EstimateTravel(2, given[1], given[2]);
  EXPECT_NEAR(straight.seconds, StopToStopSeconds(std::hypot(20, 10), 150, 1250), .015);
}

// Straight on it would lead through the square.
TEST_F(MergedOrdersTest, AWayOfTheFileCrossesWhatItCrossesWithItsBends) {
  Sketch sketch;
  sketch.Square(0, 0, 10).Go(-5, 5).Infill(-2, 5).Go(-2, 15).Go(12, 15).Go(12, 5).Infill(15, 5);
  const std::shared_ptr<GcodeFile> file = sketch.Read();
  const LayerWriter writer(*file, file->layers[0], habit_, *donors_);
  const LayerOrder given = writer.GivenOrder();

  EXPECT_EQ(writer.EstimateTravel(2, given[1], given[2]).crossings, 0);
  EXPECT_EQ(writer.EstimateTravel(2, given[2], given[1]).crossings, 1);
}

// As it is written: from bend to bend.
TEST_F(MergedOrdersTest, NewTravelsAroundWallsTakeWhatTheirBendsTake) {
  Sketch sketch;
  sketch.Square(0, 0, 40).Go(15, 15).Square(15, 15, 10).Go(5, 5).Infill(5, 20);
  sketch.Go(20, 35).Infill(35, 35).Go(35, 20).Infill(35, 18);
  const std::shared_ptr<GcodeFile> file = sketch.Add("; avoid_crossing_perimeters = 1").Read();
  const RetractionHabit habit = LearnRetraction(*file);
  const LinkDonors donors(*file);
  const LayerWriter writer(*file, file->layers[0], habit, donors);
  const LayerOrder given = writer.GivenOrder();
  ASSERT_EQ(given.size(), 5u);

  const TravelTotals around = writer.EstimateTravel(3, given[2], given[4]);

  EXPECT_EQ(around.crossings, 0);
  EXPECT_GT(around.mm, 32);
  EXPECT_GT(around.seconds, StopToStopSeconds(around.mm, 150, 1000) + 0.05);
}

// Four squares in a row. What was found begins them at near corners, but with the second one; the
// file begins with the first one, at a corner that is far away.
TEST_F(MergedOrdersTest, UnderFreeWhatWasFoundIsTriedInTheOrderOfTheFile) {
  Sketch sketch;
  sketch.Square(0, 0, 10).Go(20, -10).Square(20, -10, 10).Go(40, 0).Square(40, 0, 10);
  sketch.Go(60, -10).Square(60, -10, 10);
  const std::shared_ptr<GcodeFile> file = sketch.Read();
  const RetractionHabit habit = LearnRetraction(*file);
  const LinkDonors donors(*file);
  const LayerWriter writer(*file, file->layers[0], habit, donors);
  const LayerOrder found = {{1, 3, true}, {0, 2, true}, {2, 0, true}, {3, 3, true}};
  MergeRules rules;
  rules.crossings = Crossings::kAny;
  const auto shortest_mm = [&](Policy policy) {
    rules.policy = policy;
    double least = 1e9;
    KnownTravels travels(writer);
    for (const LayerOrder& order : LayerMerge(travels, rules).Merge(found)) {
      double mm = 0;
      for (size_t i = 1; i < order.size(); ++i) {
        mm += writer.EstimateTravel(i, order[i - 1], order[i]).mm;
      }
      least = std::min(least, mm);
    }
    return least;
  };

  EXPECT_NEAR(shortest_mm(Policy::kFree), std::hypot(10, 10) + 40, 1e-3);
  EXPECT_GT(shortest_mm(Policy::kBalanced), 62);
}

// Infill inside a wall and outside of it; by turns it is retracted for at each crossing.
TEST_F(MergedOrdersTest, SparingOrdersRetractLess) {
  Sketch sketch;
  sketch.Square(0, 0, 40).GoRetracted(30, 10).Infill(31, 10).Go(30, 11).Infill(31, 11);
  sketch.Go(30, 12).Infill(31, 12).GoRetracted(50, 10).Infill(51, 10).Go(50, 11).Infill(51, 11);
  sketch.Go(50, 12).Infill(51, 12).GoRetracted(60, 60).Infill(61, 60);
  const std::shared_ptr<GcodeFile> file = sketch.Read();
  const RetractionHabit habit = LearnRetraction(*file);
  const LinkDonors donors(*file);
  const LayerWriter writer(*file, file->layers[0], habit, donors);
  const auto retractions = [&](const LayerOrder& order) {
    int64_t sum = 0;
    for (size_t i = 1; i < order.size(); ++i) {
      sum += writer.EstimateTravel(i, order[i - 1], order[i]).retractions;
    }
    return sum;
  };
  const LayerOrder often = OrderOf({0, 1, 4, 2, 5, 3, 6, 7});
  MergeRules rules;
  rules.policy = Policy::kFree;
  rules.freedom = FreedomOf(*file, file->layers[0], Policy::kFree, {});
  rules.polish = PolishLimit();

  KnownTravels travels(writer);
  const std::vector<LayerOrder> sparing = LayerMerge(travels, rules).Spare(often);

  const int64_t given = retractions(writer.GivenOrder());
  ASSERT_GT(retractions(often), given);
  ASSERT_FALSE(sparing.empty());
  for (const LayerOrder& order : sparing) EXPECT_LE(retractions(order), given);
}

}  // namespace
}  // namespace traverse::gcode

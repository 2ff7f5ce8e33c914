// Rows of choices: client/gcode/choose/rows/choice_row.h.

#include "client/gcode/choose/rows/choice_row.h"

#include <gtest/gtest.h>

namespace traverse::gcode {
namespace {

PrintTotals Totals(double seconds, int64_t crossings, double travel_mm = 10) {
  PrintTotals totals;
  totals.seconds = seconds;
  totals.crossings = crossings;
  totals.travel_mm = travel_mm;
  return totals;
}

// Travel moves between layers that take no time.
ChoiceColumn Column(const std::vector<PrintTotals>& inside, size_t choices_before) {
  ChoiceColumn column;
  column.inside = inside;
  column.no_choice.assign(inside.size(), false);
  column.travels.resize(choices_before * inside.size());
  column.no_travel.assign(column.travels.size(), false);
  return column;
}

std::vector<uint32_t> Best(const std::vector<ChoiceColumn>& columns,
                           Crossings crossings = Crossings::kKeep, int64_t fewer = 0) {
  std::vector<const ChoiceColumn*> pointers;
  for (const ChoiceColumn& column : columns) pointers.push_back(&column);
  return BestRow(pointers, crossings, fewer);
}

using Row = std::vector<uint32_t>;

TEST(BestRow, TheFileCrossesNoMoreWallsThoughALayerMay) {
  const std::vector<ChoiceColumn> columns = {
      Column({Totals(10, 4), Totals(9, 6)}, 0),
      Column({Totals(10, 4), Totals(9.5, 2)}, 2),
      Column({Totals(10, 4), Totals(9.8, 6)}, 2),
  };

  // What the second layer crosses less, the one of the others may that gains more.
  EXPECT_EQ(Best(columns), Row({1, 1, 0}));
  EXPECT_EQ(Best(columns, Crossings::kAny), Row({1, 1, 1}));
  EXPECT_EQ(Best(columns, Crossings::kKeep, 2), Row({0, 1, 0}));
  EXPECT_EQ(Best(columns, Crossings::kKeep, 3), Row({0, 0, 0}));
}

TEST(BestRow, NoTravelLeadsIntoWhatStandsHoweverFast) {
  PrintTotals into = Totals(5, 0);
  into.blocked = 1;
  ChoiceColumn second = Column({Totals(10, 0), Totals(9, 0)}, 2);
  second.travels[1].blocked = 1;  // from the file's order of the first

  EXPECT_EQ(Best({Column({Totals(10, 0), into}, 0), second}), Row({0, 0}));
}

TEST(BestRow, NoMoreIsGivenUpForCrossingsThanHasToBe) {
  for (const double gain : {0.6, 0.7, 0.8, 0.9, 1.1, 1.3}) {
    // One of the first two has to be given up: that which gains a tenth less.
    const std::vector<ChoiceColumn> columns = {
        Column({Totals(10, 4), Totals(10 - gain, 6)}, 0),
        Column({Totals(10, 4), Totals(10 - 0.9 * gain, 6)}, 2),
        Column({Totals(10, 4), Totals(9, 2)}, 2),
    };

    EXPECT_EQ(Best(columns), Row({1, 0, 1})) << gain;
  }
}

PrintTotals Retracting(double seconds, int64_t retractions, int64_t crossings = 0) {
  PrintTotals totals = Totals(seconds, crossings);
  totals.retractions = retractions;
  return totals;
}

TEST(BestRow, TheFileRetractsNoMoreThoughALayerMay) {
  const std::vector<ChoiceColumn> columns = {
      Column({Retracting(10, 4), Retracting(9, 6)}, 0),
      Column({Retracting(10, 4), Retracting(9.5, 2)}, 2),
      Column({Retracting(10, 4), Retracting(9.8, 6)}, 2),
  };

  for (const Crossings crossings : {Crossings::kKeep, Crossings::kFewer, Crossings::kAny}) {
    EXPECT_EQ(Best(columns, crossings), Row({1, 1, 0}));
  }
}

TEST(BestRow, FewerCrossingsDoNotMakeTheFileSlower) {
  // The second crossing less costs more time than the first one saves.
  const std::vector<ChoiceColumn> columns = {
      Column({Totals(10, 4), Totals(9.9, 3), Totals(10.2, 2)}, 0),
  };

  EXPECT_EQ(Best(columns, Crossings::kFewer), Row({1}));
  // Time that another layer saves may be spent.
  const std::vector<ChoiceColumn> more = {columns[0], Column({Totals(10, 4), Totals(9, 4)}, 3)};
  EXPECT_EQ(Best(more, Crossings::kFewer), Row({2, 1}));
}

TEST(BestRow, WhatRetractsLessMustNotCrossMoreWallsForIt) {
  const std::vector<ChoiceColumn> columns = {
      Column({Retracting(10, 4, 4), Retracting(9.4, 6, 4), Retracting(9.7, 5, 3)}, 0),
      Column({Retracting(10, 4, 4), Retracting(9.97, 1, 5)}, 3),
  };

  // Each of the first one's needs the second one's fewer retractions, and one crosses less instead.
  EXPECT_EQ(Best(columns), Row({2, 1}));
  EXPECT_EQ(Best(columns, Crossings::kAny), Row({1, 1}));
}

TEST(BestRow, RetractionsGiveWayWhereNoRowHasFewer) {
  std::vector<ChoiceColumn> columns = {Column({Retracting(10, 4), Retracting(9, 6)}, 0)};
  columns[0].no_choice[0] = true;

  EXPECT_EQ(Best(columns), Row({1}));
}

TEST(BestRow, ARetractionMoreHasToSaveThreeTenthsOfASecond) {
  const std::vector<ChoiceColumn> columns = {
      Column({Retracting(50, 4), Retracting(48.4, 9)}, 0),
      Column({Retracting(50, 4), Retracting(48.6, 9)}, 2),
  };

  EXPECT_EQ(Best(columns), Row({1, 0}));
}

TEST(BestRow, ALayerMayTravelFurtherThatTakesLessTime) {
  EXPECT_EQ(Best({Column({Totals(10, 0, 20), Totals(9, 0, 25)}, 0)}), Row({1}));
}

TEST(BestRow, WhatIsRuledOutIsNotChosen) {
  std::vector<ChoiceColumn> columns = {
      Column({Totals(10, 0), Totals(9, 0)}, 0),
      Column({Totals(10, 0), Totals(9, 0)}, 2),
  };

  columns[1].no_travel[3] = true;
  const Row one = Best(columns);
  columns[0].no_choice[1] = true;
  columns[1].no_choice[1] = true;

  EXPECT_EQ(one[0] + one[1], 1u);
  EXPECT_EQ(Best(columns), Row({0, 0}));
}

TEST(BestRow, OpenTravelsAcrossWallsAndPushedFilamentStayAsTheyAre) {
  PrintTotals open = Totals(9, 0);
  open.open_crossings = 1;
  PrintTotals pushed = Totals(9, 0);
  pushed.extra_mm = 0.1;

  EXPECT_EQ(Best({Column({Totals(10, 0), open}, 0)}, Crossings::kAny), Row({0}));
  EXPECT_EQ(Best({Column({Totals(10, 0), pushed}, 0)}, Crossings::kAny), Row({0}));
}

TEST(BestRow, NoOpenTravelAcrossWallsIsLongerThanInTheFile) {
  PrintTotals given = Totals(10, 1);
  given.open_crossings = 1;
  given.longest_open_mm = 2;
  PrintTotals longer = given;
  longer.seconds = 9;
  longer.longest_open_mm = 2.01;
  PrintTotals as_long = given;
  as_long.seconds = 9.5;

  EXPECT_EQ(Best({Column({given, longer, as_long}, 0)}), Row({2}));
}

}  // namespace
}  // namespace traverse::gcode

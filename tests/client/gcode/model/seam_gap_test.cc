#include "client/gcode/model/seam_gap.h"

#include <gtest/gtest.h>

#include <vector>

#include "client/gcode/model/positions.h"

namespace traverse::gcode {
namespace {

Position At(double x, double y) { return {RoundedWord(x, 1), RoundedWord(y, 1), 0}; }

// A square of 10 mm that ends `gap` short of its start, with .04 mm of filament per mm.
std::vector<BodySegment> Square(double gap) {
  const std::vector<Position> points = {At(0, 0), At(10, 0), At(10, 10), At(0, 10), At(0, gap)};
  std::vector<BodySegment> segments;
  for (size_t i = 1; i < points.size(); ++i) {
    BodySegment& segment = segments.emplace_back();
    segment.from = points[i - 1];
    segment.to = points[i];
    segment.filament = RoundedWord(.04 * LengthXy(segment.from, segment.to), 1);
    segment.feed = 1200 * kDecimalOne;
  }
  return segments;
}

Decimal FilamentOf(const std::vector<BodySegment>& segments) {
  Decimal sum = 0;
  for (const BodySegment& segment : segments) sum += segment.filament;
  return sum;
}

TEST(MoveGap, ClosesTheGapAndLeavesTheSameAtTheNewStart) {
  std::vector<BodySegment> segments = Square(.1);
  const Decimal filament = FilamentOf(segments);

  ASSERT_TRUE(MoveGap(2, segments));

  // The last side goes on to its corner.
  ASSERT_EQ(segments.size(), 4u);
  EXPECT_EQ(segments[3].from, At(0, 10));
  EXPECT_EQ(segments[3].to, At(0, 0));
  EXPECT_EQ(segments[3].filament, RoundedWord(.4, 1));
  EXPECT_EQ(segments[1].to, At(10, 9.9));
  EXPECT_EQ(segments[1].filament, RoundedWord(.396, 1));
  EXPECT_EQ(segments[2].from, At(10, 10));
  EXPECT_EQ(FilamentOf(segments), filament);
}

TEST(MoveGap, ClosesTheGapOfALoopThatBeginsWithItsLastSide) {
  std::vector<BodySegment> segments = Square(.1);
  const Decimal filament = FilamentOf(segments);

  ASSERT_TRUE(MoveGap(3, segments));

  ASSERT_EQ(segments.size(), 4u);
  EXPECT_EQ(segments[3].to, At(0, 0));
  EXPECT_EQ(segments[3].filament, RoundedWord(.4, 1));
  EXPECT_EQ(segments[2].to, At(.1, 10));
  EXPECT_EQ(FilamentOf(segments), filament);
}

// The loop ends beside its last side, or has no other side that stays as it is.
TEST(MoveGap, ClosesTheGapByASegmentOfItsOwnWhereTheLastOneCannotGoOn) {
  std::vector<BodySegment> there_and_back = Square(.1);
  there_and_back.erase(there_and_back.begin() + 1, there_and_back.begin() + 3);
  there_and_back[0].to = At(0, 10);
  ASSERT_TRUE(MoveGap(1, there_and_back));
  ASSERT_EQ(there_and_back.size(), 3u);
  EXPECT_EQ(there_and_back[1].to, At(0, .1));

  std::vector<BodySegment> segments = Square(.1);
  segments[3].to = At(.003, .1);
  const Decimal filament = FilamentOf(segments);
  ASSERT_TRUE(MoveGap(2, segments));
  ASSERT_EQ(segments.size(), 5u);
  EXPECT_EQ(segments[4].from, At(.003, .1));
  EXPECT_EQ(segments[4].to, At(0, 0));
  EXPECT_EQ(segments[4].filament, RoundedWord(.004, 1));
  EXPECT_EQ(segments[4].feed, segments[3].feed);
  EXPECT_EQ(segments[1].to, At(10, 9.9));
  EXPECT_EQ(segments[1].filament, RoundedWord(.396, 1));
  EXPECT_EQ(segments[2].from, At(10, 10));
  EXPECT_EQ(FilamentOf(segments), filament);
}

TEST(MoveGap, ChangesNothingWhereThePrintWouldNotBeTheSame) {
  const auto stays = [](std::vector<BodySegment> segments) {
    const std::vector<BodySegment> before = segments;
    const bool moved = MoveGap(2, segments);
    return !moved && segments.size() == before.size() && segments[1].to == before[1].to &&
           segments[1].filament == before[1].filament;
  };
  EXPECT_TRUE(stays(Square(0)));
  EXPECT_TRUE(stays(Square(.01)));
  EXPECT_FALSE(stays(Square(.02)));
  for (const size_t arc : {size_t{1}, size_t{3}}) {
    std::vector<BodySegment> segments = Square(.1);
    segments[arc].command = 3;
    EXPECT_TRUE(stays(segments)) << arc;
  }
  std::vector<BodySegment> narrow = Square(.1);
  narrow[1].filament = RoundedWord(.39, 1);
  EXPECT_TRUE(stays(narrow));
  std::vector<BodySegment> empty = Square(.1);
  empty[3].filament = 0;
  EXPECT_TRUE(stays(empty));
  std::vector<BodySegment> brief = Square(.1);
  brief[1].from = At(10, 9.82);
  brief[1].filament = RoundedWord(.007, 1);
  EXPECT_TRUE(stays(brief));
}

}  // namespace
}  // namespace traverse::gcode

#include "client/gcode/model/segment_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "engine/base/rng.h"

namespace traverse::gcode {
namespace {

// Paths of a few segments each, short ones and long ones, over `extent_mm`.
std::vector<Segment> RandomSegments(uint64_t seed, double extent_mm) {
  Rng rng(seed);
  const auto random = [&rng] { return static_cast<double>(rng.Next() % 100'000) / 100'000; };
  std::vector<Segment> segments;
  for (uint32_t path = 0; path < 25; ++path) {
    const double step = random() < 0.3 ? extent_mm / 2 : 1;
    Point at{random() * extent_mm, random() * extent_mm};
    for (int k = 0; k < 6; ++k) {
      const Point to{at.x + (random() - 0.5) * step, at.y + (random() - 0.5) * step};
      segments.push_back({at, to, path});
      at = to;
    }
  }
  return segments;
}

bool Always(uint32_t, uint32_t) { return true; }

std::set<std::pair<uint32_t, uint32_t>> NearPaths(const std::vector<Segment>& segments,
                                                  double reach) {
  std::set<std::pair<uint32_t, uint32_t>> pairs;
  for (const Segment& s : segments) {
    for (const Segment& t : segments) {
      if (s.path < t.path && SquaredDistance(s, t) <= reach * reach) pairs.insert({s.path, t.path});
    }
  }
  return pairs;
}

TEST(SegmentGridTest, FindsAllPathsThatComeNear) {
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    const double extent = seed % 3 == 0 ? 200 : 20;
    const double reach = 0.25 * static_cast<double>(1 + seed % 4);
    const std::vector<Segment> segments = RandomSegments(seed, extent);
    const SegmentGrid grid(segments, reach / 0.75);
    std::set<std::pair<uint32_t, uint32_t>> found;
    grid.ForEachNearPair([&](uint32_t, uint32_t) { return reach; }, Always,
                         [&](uint32_t s, uint32_t t) {
                           EXPECT_NE(segments[s].path, segments[t].path);
                           if (SquaredDistance(segments[s], segments[t]) > reach * reach) {
                             return true;
                           }
                           found.insert(std::minmax({segments[s].path, segments[t].path}));
                           return false;
                         });
    EXPECT_EQ(found, NearPaths(segments, reach));
  }
}

// Else a file of a few megabytes with loops around the whole plate takes gigabytes.
TEST(SegmentGridTest, LongSegmentsGetLargerCells) {
  std::vector<Segment> segments;
  for (uint32_t path = 0; path < 500; ++path) {
    segments.push_back({{0, 0.1 * path}, {1000, 0.1 * path}, path});
  }

  const SegmentGrid grid(segments, 0.5);

  EXPECT_LE(grid.entry_count(), SegmentGrid::kCellsPerSegment * (segments.size() + 16));
}

// A megabyte may have tens of thousands of lines across the plate.
TEST(SegmentGridTest, MoreThanAPrintHasTakesFewCellsEach) {
  std::vector<Segment> segments;
  for (uint32_t path = 0; path < 20'000; ++path) {
    segments.push_back({{0, 0.01 * path}, {200, 0.01 * path}, path});
  }

  const SegmentGrid grid(segments);

  EXPECT_LT(grid.entry_count(), 2'000'000u);
}

TEST(SegmentGridTest, LooksAtNoPathsThatAreNotWanted) {
  const SegmentGrid grid({{{0, 0}, {5, 0}, 0}, {{0, 0.1}, {5, 0.1}, 1}, {{0, 0.2}, {5, 0.2}, 2}});
  const auto first_two = [](uint32_t s, uint32_t t) {
    EXPECT_EQ(s + t, 1u);
    return true;
  };
  grid.ForEachNearPair([](uint32_t i, uint32_t j) { return i + j == 1 ? 0.5 : -1; }, Always,
                       first_two);
  grid.ForEachNearPair([](uint32_t, uint32_t) { return 0.5; },
                       [](uint32_t i, uint32_t j) { return i + j == 1; }, first_two);
}

TEST(SegmentGridTest, MeetsWhatAWayCrosses) {
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    const std::vector<Segment> segments = RandomSegments(seed, 30);
    const SegmentGrid grid(segments);
    const Point a{-1, static_cast<double>(seed % 30)};
    const Point b{31, static_cast<double>(seed * 7 % 30)};
    std::set<uint32_t> met;
    size_t looks = 100'000;
    size_t calls = 0;
    grid.ForEachOnTravel(a, b, looks, [&](uint32_t s) {
      met.insert(s);
      ++calls;
      return true;
    });
    EXPECT_EQ(looks, 100'000 - calls);
    for (uint32_t s = 0; s < segments.size(); ++s) {
      if (Cross(a, b, segments[s].a, segments[s].b)) {
        EXPECT_TRUE(met.contains(s)) << s;
      }
    }
  }
}

TEST(SegmentGridTest, LooksAtNoMoreThanItMay) {
  const SegmentGrid grid(RandomSegments(1, 30));
  size_t looks = 3;
  size_t calls = 0;
  const auto count = [&calls](uint32_t) {
    ++calls;
    return true;
  };

  grid.ForEachOnTravel({-1, 15}, {31, 15}, looks, count);
  grid.ForEachOnTravel({-1, 15}, {31, 15}, looks, count);

  EXPECT_EQ(calls, 3u);
  EXPECT_EQ(looks, 0u);
}

}  // namespace
}  // namespace traverse::gcode

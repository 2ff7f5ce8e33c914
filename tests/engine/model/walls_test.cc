#include "engine/model/walls.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/problems/instances.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

TEST(CheckWalls, AcceptsWhatItShould) {
  EXPECT_OK(CheckWalls({}, Plan{}));
  EXPECT_OK(CheckWalls({{{{{0, 0}, {0, 0}}, true, 1}}, {0, 1, 1}}, FlatPlan(2)));
}

TEST(CheckWalls, NamesThePlaceOfAFault) {
  const Wall good{{{0, 0}, {1, 1}}, false, -1};
  const auto fault = [&](LayerWalls walls) {
    return std::string(CheckWalls(walls, FlatPlan(2)).message());
  };

  EXPECT_EQ(fault({{good, {{{0, 0}}, false, -1}}, {}}),
            "walls[1].points: a wall needs at least two points, not 1");
  EXPECT_EQ(fault({{{{{0, 0}, {0, NAN}}, false, -1}}, {}}), "walls[0].points[1].y: not finite");
  EXPECT_EQ(fault({{{{{2e6, 0}, {0, 0}}, false, -1}}, {}}),
            "walls[0].points[0].x: beyond +-1e6 mm");
  EXPECT_EQ(fault({{{{{0, 0}, {1, 1}}, false, 2}}, {}}), "walls[0].path: there is no path 2");
  EXPECT_EQ(fault({{good}, {0, 2}}), "exposed_paths[1]: there is no path 2");
  EXPECT_EQ(fault({{}, {}, {0, -1}}), "retracted_paths[1]: there is no path -1");
  EXPECT_EQ(fault({{}, {}, {}, {{0, 2, 1}}}), "known_moves[0].to: there is no path 2");
  EXPECT_EQ(fault({{}, {}, {}, {{-1, 0, 1}}}), "known_moves[0].from: there is no path -1");
  EXPECT_EQ(fault({{}, {}, {}, {{0, 1, 1}, {0, 1, NAN}}}), "known_moves[1].seconds: not a time");
  EXPECT_EQ(fault({{}, {}, {}, {{0, 1, 1}, {1, 0, 1}, {0, 1, 1}}}),
            "known_moves: 3 are more than the plan has paths, 2");
}

}  // namespace
}  // namespace traverse

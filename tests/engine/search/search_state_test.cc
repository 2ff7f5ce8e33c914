#include "engine/search/search_state.h"

#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/cost/route_cost.h"
#include "engine/validator.h"
#include "tests/engine/search/searched.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

// What the move makes of a route, by its definition alone.
Route Moved(const Plan& plan, const Route& route, const SegmentMove& move, bool& possible) {
  Route result(route.begin(), route.begin() + move.first - 1);
  const auto order = move.NewOrder();
  possible = true;
  for (int s = 0; s < move.segment_count(); ++s) {
    const Segment& segment = order[static_cast<size_t>(s)];
    for (int i = 0; i < segment.size(); ++i) {
      Visit visit = route[static_cast<size_t>(segment.At(i) - 1)];
      const Path& path = plan.paths[static_cast<size_t>(visit.path)];
      if (segment.reversed && path.kind == Path::Kind::kOpen) {
        visit.entry = 1 - visit.entry;
        possible = possible && !path.one_way;
      }
      result.push_back(visit);
    }
  }
  result.insert(result.end(), route.begin() + move.last, route.end());
  return result;
}

TEST(SearchState, LoadsAndUnloads) {
  for (uint64_t seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Searched s(seed);

    EXPECT_EQ(s.state.Unload(), GivenRoute(s.owned.plan()));
    EXPECT_NEAR(s.state.TotalCost(), RouteCost(s.owned.problem, s.state.Unload()), 1e-9);
  }
}

// Moves on islands and the like may be forbidden although they happen to be legal, where the same
// move has another name; but nothing illegal is allowed, and nearly all that is legal is.
TEST(SearchState, AllowsWhatIsLegal) {
  int legal = 0;
  int allowed = 0;
  for (uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Searched s(seed);
    Rng rng(seed);
    for (int i = 0; i < 60; ++i) {
      const SegmentMove move = RandomMove(rng, s.tree.path_count());
      bool possible;
      const Route moved = Moved(s.owned.plan(), s.state.Unload(), move, possible);
      const bool is_legal = possible && ValidateRoute(s.owned.plan(), moved).ok();
      legal += is_legal;
      if (!s.state.Allows(move)) continue;
      ++allowed;
      ASSERT_TRUE(is_legal);

      s.state.Apply(move);

      ASSERT_EQ(s.state.Unload(), moved);
      ASSERT_NEAR(s.state.TotalCost(), RouteCost(s.owned.problem, moved), 1e-9);
    }
  }
  EXPECT_GT(allowed, 0.9 * legal);
}

TEST(SearchState, UndoRestoresEverything) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Searched s(seed);
    Rng rng(seed);
    std::vector<Route> routes;
    std::vector<size_t> marks;
    std::vector<uint64_t> numbers;
    for (int i = 0; i < 30; ++i) {
      routes.push_back(s.state.Unload());
      marks.push_back(s.state.Mark());
      numbers.push_back(s.state.route_number());
      const int leaf = static_cast<int>(rng.Below(static_cast<uint32_t>(s.tree.path_count())));
      s.state.SetEntry(leaf, s.entries.first(leaf) + rng.Between(0, s.entries.count(leaf) - 1));
      const SegmentMove move = RandomMove(rng, s.tree.path_count());
      if (s.state.Allows(move)) s.state.Apply(move);
    }

    for (size_t i = routes.size(); i-- > 0;) {
      s.state.UndoTo(marks[i]);

      ASSERT_EQ(s.state.Unload(), routes[i]);
      ASSERT_EQ(s.state.route_number(), numbers[i]);
      ASSERT_NEAR(s.state.TotalCost(), RouteCost(s.owned.problem, routes[i]), 1e-9);
      for (int p = 1; p < s.state.last_position(); ++p) {
        ASSERT_EQ(s.state.position(s.state.leaf_at(p)), p);
      }
    }
  }
}

TEST(SearchState, EqualNumbersMeanEqualRoutes) {
  for (uint64_t seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Searched s(seed);
    Rng rng(seed);
    std::map<uint64_t, Route> routes;
    for (int i = 0; i < 200; ++i) {
      const Route route = s.state.Unload();
      ASSERT_EQ(routes.try_emplace(s.state.route_number(), route).first->second, route);
      ASSERT_GT(s.state.route_number(), 0);
      const SegmentMove move = RandomMove(rng, s.tree.path_count());
      const int leaf = static_cast<int>(rng.Below(static_cast<uint32_t>(s.tree.path_count())));
      switch (rng.Below(6)) {
        case 0:
          s.state.UndoTo(s.state.Mark() / 2);
          break;
        case 1:
          s.state.Commit();
          break;
        case 2:
          s.state.Load(routes.begin()->second);
          break;
        case 3:
          s.state.SetEntry(leaf, s.entries.first(leaf) + rng.Between(0, s.entries.count(leaf) - 1));
          break;
        default:
          if (s.state.Allows(move)) s.state.Apply(move);
      }
    }
  }
}

}  // namespace
}  // namespace traverse

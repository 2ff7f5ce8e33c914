// Layers whose paths are left and come to in some time, and left elsewhere than at their exits:
// what answers state is computed again here, and the best routes are found by trying all.

#include "engine/model/links.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
#include "engine/cost/wall_cost.h"
#include "engine/strategy/registry.h"
#include "engine/validator.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/random_plan.h"
#include "tests/support/problems/walled_problem.h"
#include "tests/support/recording_sink.h"
#include "tests/support/status_matchers.h"
#include "tests/support/step_clock.h"
#include "tests/support/test_executor.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

LinkSeconds RandomSeconds(Rng& rng) {
  const double open = rng.Between(0, 2) == 0 ? 0 : 0.2 * rng.Unit();
  return {open, open + (rng.Between(0, 1) == 0 ? 0 : 0.5 * rng.Unit())};
}

size_t RandomCount(const Path& path, Rng& rng) {
  const int kind = rng.Between(0, 2);
  return kind == 2 ? path.points.size() : static_cast<size_t>(kind);
}

// None, one for all, or one for each end.
PathLinks RandomPathLinks(const Path& path, Rng& rng) {
  PathLinks links;
  links.departures.resize(RandomCount(path, rng));
  links.arrivals.resize(RandomCount(path, rng));
  for (LinkSeconds& arrival : links.arrivals) arrival = RandomSeconds(rng);
  for (size_t i = 0; i < links.departures.size(); ++i) {
    links.departures[i].seconds = RandomSeconds(rng);
    if (links.departures.size() != path.points.size() || rng.Between(0, 2) == 0) continue;
    const Point exit = path.points[i];
    links.departures[i].from = Point{exit.x + 8 * rng.Unit() - 4, exit.y + 8 * rng.Unit() - 4};
  }
  return links;
}

LayerLinks RandomLinks(const Plan& plan, uint64_t seed) {
  Rng rng(seed);
  LayerLinks links;
  for (const Path& path : plan.paths) links.push_back(RandomPathLinks(path, rng));
  return links;
}

// Of a layer from `start`, as plan.proto states it: by length, by time, or by time among walls.
class TrueCost {
 public:
  TrueCost(const JobLayer& layer, Point start, const LinkSeconds& before)
      : layer_(layer), start_(start), before_(before) {
    if (layer.walls.empty()) return;
    walls_ = std::make_unique<const WallCost>(layer.walls, layer.plan, *layer.cost);
  }

  double Of(const Route& route) const {
    double sum = 0;
    for (size_t i = 0; i < route.size(); ++i) {
      sum += i == 0 ? Link(nullptr, route[i]) : Link(&route[i - 1], route[i]);
    }
    return sum;
  }

  // The least of all legal routes.
  double Least() const {
    double least = std::numeric_limits<double>::infinity();
    for (const std::vector<int>& order : LegalOrders(layer_.plan)) {
      least = std::min(least, LeastOf(order));
    }
    return least;
  }

 private:
  std::vector<int> EntriesOf(int p) const {
    const Path& path = layer_.plan.paths[static_cast<size_t>(p)];
    if (path.one_way) return {0};
    if (!path.allowed.empty()) return path.allowed;
    std::vector<int> all(path.points.size());
    std::iota(all.begin(), all.end(), 0);
    return all;
  }

  double LeastOf(const std::vector<int>& order) const {
    std::vector<std::pair<Visit, double>> ends;  // what it costs to have done all up to there
    for (size_t i = 0; i < order.size(); ++i) {
      std::vector<std::pair<Visit, double>> next;
      for (const int entry : EntriesOf(order[i])) {
        const Visit visit{order[i], entry};
        double least = i == 0 ? Link(nullptr, visit) : std::numeric_limits<double>::infinity();
        for (const auto& [end, cost] : ends) least = std::min(least, cost + Link(&end, visit));
        next.emplace_back(visit, least);
      }
      ends = std::move(next);
    }
    if (ends.empty()) return 0;
    const auto less = [](const auto& a, const auto& b) { return a.second < b.second; };
    return std::min_element(ends.begin(), ends.end(), less)->second;
  }

  double Link(const Visit* from, const Visit& to) const {
    Point at = start_;
    LinkSeconds leaving = before_;
    if (from != nullptr) {
      const Path& path = layer_.plan.paths[static_cast<size_t>(from->path)];
      const int exit = path.kind == Path::Kind::kOpen ? 1 - from->entry : from->entry;
      const std::vector<Departure>& departures =
          layer_.links[static_cast<size_t>(from->path)].departures;
      at = path.points[static_cast<size_t>(exit)];
      leaving = {};
      if (!departures.empty()) {
        const size_t which = departures.size() == 1 ? 0 : static_cast<size_t>(exit);
        at = departures[which].from.value_or(at);
        leaving = departures[which].seconds;
      }
    }
    const std::vector<LinkSeconds>& arrivals = layer_.links[static_cast<size_t>(to.path)].arrivals;
    LinkSeconds arriving;
    if (!arrivals.empty()) {
      arriving = arrivals[arrivals.size() == 1 ? 0 : static_cast<size_t>(to.entry)];
    }
    return Move(at, to, {leaving.open + arriving.open, leaving.retracted + arriving.retracted});
  }

  double Move(Point at, const Visit& to, const LinkSeconds& ends) const {
    const Point entry =
        layer_.plan.paths[static_cast<size_t>(to.path)].points[static_cast<size_t>(to.entry)];
    const CostSpec& spec = *layer_.cost;
    if (spec.kind == CostSpec::Kind::kLength) return MoveCost(spec, at, entry);
    if (walls_) {
      const WallMove move = walls_->MoveOf(at, entry);
      return move.cost + (move.retracts ? ends.retracted : ends.open);
    }
    const bool retracts = Distance(at, entry) > spec.retraction_threshold_mm;
    return MoveCost(spec, at, entry) + (retracts ? ends.retracted : ends.open);
  }

  const JobLayer& layer_;
  const Point start_;
  const LinkSeconds before_;
  std::unique_ptr<const WallCost> walls_;
};

JobLayer RandomLayer(uint64_t seed, int max_paths) {
  JobLayer layer;
  if (seed % 4 == 0) {
    WalledProblem walled = RandomWalledProblem(seed, {.max_paths = max_paths}, seed % 8 == 0);
    layer.plan = walled.owned.plan();
    layer.cost = walled.problem().cost;
    layer.walls = std::move(walled.walls);
  } else {
    Rng rng(seed);
    layer.plan = RandomPlan(seed, {.max_paths = max_paths});
    layer.cost = RandomCost(rng);
  }
  layer.links = RandomLinks(layer.plan, seed + 1);
  EXPECT_TRUE(LinksFit(layer.links, layer.plan));
  return layer;
}

struct Method {
  std::string name;
  std::map<std::string, std::string> options = {};
};

const std::vector<Method>& Methods() {
  static const auto& methods = *new std::vector<Method>{{"none"},
                                                        {"greedy"},
                                                        {"ni2opt"},
                                                        {"ni2opt", {{"pure", "true"}}},
                                                        {"auto"},
                                                        {"tabu", {{"diversifications", "5"}}},
                                                        {"exact", {{"time_limit", "1000"}}}};
  return methods;
}

struct Answered {
  std::map<uint64_t, LayerOutcome> layers;
  std::optional<double> chain_bound;
};

Answered Answers(const Method& method, const std::vector<JobLayer>& layers, int threads = 1,
                 std::optional<int64_t> deadline = std::nullopt) {
  const StepClock clock;
  RecordingSink sink;
  TestExecutor executor(threads);
  JobSpec spec;
  spec.time = &clock;
  if (deadline) spec.deadline = StepClock::At(*deadline);
  auto job = Job::Start(spec, *MakeStrategy(method.name, method.options), executor, sink);
  for (const JobLayer& layer : layers) job->Add(layer);
  job->Close();
  sink.Wait();
  return {sink.ByIndex(), sink.chain_bound};
}

constexpr double kRounding = 1e-6;

TEST(Links, CostWhatTheyAreSaidTo) {
  for (const Method& method : Methods()) {
    for (uint64_t seed = 1; seed <= 15; ++seed) {
      SCOPED_TRACE(absl::StrCat(method.name, " seed ", seed));
      std::vector<JobLayer> layers;
      for (uint64_t i = 0; i < 3; ++i) layers.push_back(RandomLayer(10 * seed + i, 9));
      if (seed % 3 == 0) layers[2].start = Point{5, 5};
      const Answered answered = Answers(method, layers, seed % 2 == 0 ? 2 : 1);
      ASSERT_EQ(answered.layers.size(), layers.size());
      EXPECT_FALSE(answered.chain_bound);
      LinkSeconds before;
      for (const auto& [index, outcome] : answered.layers) {
        const JobLayer& layer = layers[index];
        EXPECT_EQ(outcome.invalid_route, "");
        ASSERT_OK(ValidateRoute(layer.plan, outcome.route));
        if (layer.start) before = {};
        const TrueCost cost(layer, outcome.start, before);
        EXPECT_NEAR(outcome.cost, cost.Of(outcome.route), kRounding);
        if (!outcome.route.empty()) {
          before = DepartureOf(layer.links, layer.plan, outcome.route.back()).seconds;
        }
      }
    }
  }
}

TEST(Links, AreNeverProvenCheaperThanTheyCanBe) {
  int proven = 0;
  int best = 0;
  int searched = 0;
  double over = 0;
  for (const Method& method : Methods()) {
    for (uint64_t seed = 1; seed <= 50; ++seed) {
      SCOPED_TRACE(absl::StrCat(method.name, " seed ", seed));
      const JobLayer layer = RandomLayer(seed, 6);
      const Answered answered = Answers(method, {layer});
      const LayerOutcome& outcome = answered.layers.at(0);
      const double least = TrueCost(layer, {0, 0}, {}).Least();
      EXPECT_GE(outcome.cost, least - kRounding);
      if (outcome.lower_bound) {
        EXPECT_LE(*outcome.lower_bound, least + kRounding);
      }
      if (outcome.stop == StopReason::kOptimal) {
        EXPECT_NEAR(outcome.cost, least, kRounding);
      }
      if (method.name == "exact") {
        EXPECT_EQ(outcome.stop, StopReason::kOptimal);
      }
      proven += outcome.stop == StopReason::kOptimal ? 1 : 0;
      if (method.name != "auto" || least == 0) continue;
      ++searched;
      best += outcome.cost <= least + kRounding ? 1 : 0;
      over += outcome.cost / least - 1;
    }
  }
  RecordProperty("auto_over_per_mille", static_cast<int>(1000 * over / searched));
  EXPECT_GT(proven, 30);
  EXPECT_GT(best, searched * 8 / 10);
  EXPECT_LT(over / searched, 0.01);
}

TEST(Links, AreNoDearerThanOnTheKnownRoute) {
  for (const Method& method : Methods()) {
    for (uint64_t seed = 1; seed <= 12; ++seed) {
      SCOPED_TRACE(absl::StrCat(method.name, " seed ", seed));
      JobLayer layer = RandomLayer(seed, 12);
      layer.initial_route = Answers({"auto"}, {layer}).layers.at(0).route;
      for (const std::optional<int64_t> deadline : {std::optional<int64_t>(), {200}, {0}}) {
        const LayerOutcome outcome = Answers(method, {layer}, 1, deadline).layers.at(0);
        const TrueCost cost(layer, outcome.start, {});
        EXPECT_LE(outcome.cost, cost.Of(layer.initial_route) + kRounding);
      }
    }
  }
}

// What a retraction takes may be stated as the price of all of them, or as the departure of each
// path; and known moves with it, or without. Both are searched alike.
TEST(Links, ThatStateARetractionAreSearchedAsOne) {
  constexpr double kRetraction = 0.25;
  int known_moves = 0;
  for (uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    WalledProblem walled = RandomWalledProblem(seed, {.max_paths = 12}, seed % 2 == 0);
    JobLayer priced;
    priced.plan = walled.owned.plan();
    priced.cost = walled.problem().cost;
    priced.cost->retraction_seconds = kRetraction;
    priced.walls = std::move(walled.walls);
    priced.walls.retracted.clear();
    JobLayer linked = priced;
    linked.cost->retraction_seconds = 0;
    linked.links.assign(priced.plan.paths.size(), PathLinks{{Departure{{}, {0, kRetraction}}}, {}});
    for (KnownMove& move : priced.walls.known) {
      known_moves += move.retracts ? 1 : 0;
      move.seconds = std::round(move.seconds * 8) / 8;
    }
    linked.walls.known = priced.walls.known;
    for (KnownMove& move : priced.walls.known) move.seconds += move.retracts ? kRetraction : 0;
    const Method pure = {"ni2opt", {{"pure", "true"}}};
    EXPECT_EQ(Answers(pure, {linked}).layers.at(0).route,
              Answers(pure, {priced}).layers.at(0).route);
  }
  EXPECT_GT(known_moves, 30);
}

// Where the way back is dear, the path is left at its other end.
TEST(Links, AreCheaperInOneDirection) {
  JobLayer layer;
  layer.plan.paths = {MakeOpenPath({0, 0}, {0, 10})};
  layer.plan.nodes = {PlanNode{}};
  layer.cost = CostSpec{.kind = CostSpec::Kind::kTime, .speed_mm_s = 10};
  EXPECT_EQ(Answers({"auto"}, {layer}).layers.at(0).route, (Route{{0, 0}}));
  layer.links = {PathLinks{{}, {LinkSeconds{5, 5}, LinkSeconds{}}}};
  const LayerOutcome outcome = Answers({"auto"}, {layer}).layers.at(0);
  EXPECT_EQ(outcome.route, (Route{{0, 1}}));
  EXPECT_DOUBLE_EQ(outcome.cost, 1);
  EXPECT_DOUBLE_EQ(outcome.cost_given, 5);
}

// The next layer begins where a wipe ended, and pays for it.
TEST(Links, LeadOnToTheNextLayer) {
  JobLayer layer;
  layer.plan.paths = {MakeContour({{0, 0}})};
  layer.plan.nodes = {PlanNode{}};
  layer.cost = CostSpec{.kind = CostSpec::Kind::kTime, .speed_mm_s = 10};
  layer.links = {PathLinks{{Departure{Point{30, 40}, {2, 2}}}, {}}};
  const Answered answered = Answers({"auto"}, {layer, layer});
  EXPECT_DOUBLE_EQ(answered.layers.at(0).cost, 0);
  EXPECT_EQ(answered.layers.at(1).start, (Point{30, 40}));
  EXPECT_DOUBLE_EQ(answered.layers.at(1).cost, 7);
  EXPECT_DOUBLE_EQ(answered.layers.at(1).cost_given, 7);
  EXPECT_DOUBLE_EQ(answered.layers.at(1).travel.total_mm(), 50);
}

// Also one that has no links itself, but pays for how the head comes to it; and one without paths.
TEST(Links, LeadToLayersWithoutAny) {
  JobLayer first;
  first.plan.paths = {MakeContour({{0, 0}})};
  first.plan.nodes = {PlanNode{}};
  first.cost = CostSpec{.kind = CostSpec::Kind::kTime, .speed_mm_s = 10};
  JobLayer second = first;
  first.links = {PathLinks{{Departure{Point{30, 40}, {2, 2}}}, {}}};
  JobLayer empty;
  empty.cost = first.cost;
  const Answered answered = Answers({"auto"}, {first, empty, second, second});
  EXPECT_DOUBLE_EQ(answered.layers.at(1).cost, 0);
  EXPECT_DOUBLE_EQ(answered.layers.at(2).cost, 7);
  EXPECT_EQ(answered.layers.at(2).invalid_route, "");
  EXPECT_DOUBLE_EQ(answered.layers.at(3).cost, 0);
}

}  // namespace
}  // namespace traverse

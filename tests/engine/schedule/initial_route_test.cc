// A layer whose caller knows a route: every strategy begins with it, and never answers a worse one.

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
#include "engine/cost/route_cost.h"
#include "engine/cost/wall_cost.h"
#include "engine/model/tree/plan_tree.h"
#include "engine/strategy/registry.h"
#include "engine/validator.h"
#include "tests/support/problems/walled_problem.h"
#include "tests/support/recording_sink.h"
#include "tests/support/status_matchers.h"
#include "tests/support/step_clock.h"
#include "tests/support/test_executor.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

// Any legal order, each path entered anywhere.
class RandomRoute {
 public:
  RandomRoute(const Plan& plan, Rng& rng) : plan_(plan), tree_(plan), rng_(rng) {}

  Route Build() {
    if (!plan_.nodes.empty()) Append(0);
    return std::move(route_);
  }

 private:
  void Append(int node) {
    if (tree_.is_leaf(node)) {
      const int path = tree_.node(node).path;
      route_.push_back({path, EntryOf(plan_.paths[static_cast<size_t>(path)])});
      return;
    }
    const absl::Span<const int> children = tree_.children(node);
    std::vector<int> ready;
    const auto note = [&](int slot) { ready.push_back(slot); };
    ReadySlots slots(tree_.precedence(node), static_cast<int>(children.size()), note);
    const bool in_order = tree_.node(node).kind == PlanNode::Kind::kInOrder;
    while (!ready.empty()) {
      const auto at =
          ready.begin() + (in_order ? 0 : rng_.Between(0, static_cast<int>(ready.size()) - 1));
      const int slot = *at;
      ready.erase(at);
      Append(children[static_cast<size_t>(slot)]);
      slots.Finish(slot, note);
    }
  }

  int EntryOf(const Path& path) {
    if (path.kind == Path::Kind::kOpen) return path.one_way ? 0 : rng_.Between(0, 1);
    if (path.allowed.empty()) return rng_.Between(0, static_cast<int>(path.points.size()) - 1);
    return path
        .allowed[static_cast<size_t>(rng_.Between(0, static_cast<int>(path.allowed.size()) - 1))];
  }

  const Plan& plan_;
  const PlanTree tree_;
  Rng& rng_;
  Route route_;
};

struct Method {
  std::string name;
  std::map<std::string, std::string> options = {};
};

const std::vector<Method>& Methods() {
  static const auto& methods = *new std::vector<Method>{
      {"none"},
      {"greedy"},
      {"greedy", {{"pure", "true"}}},
      {"ni2opt"},
      {"ni2opt", {{"point_release", "false"}}},
      {"ni2opt", {{"pure", "true"}}},
      {"auto"},
      {"auto", {{"effort", "0"}}},
      {"auto", {{"idle_speed", "130"}}},
      {"auto", {{"least_gain_each", "0.001"}}},
      {"tabu", {{"diversifications", "5"}}},
      {"tabu", {{"diversifications", "5"}, {"polish", "false"}}},
      {"tabu", {{"diversifications", "5"}, {"thesis", "true"}}},
      {"exact", {{"time_limit", "1000"}}},
      {"exact", {{"model", "framework"}}},
      {"exact", {{"model", "framework"}, {"start", "none"}}},
  };
  return methods;
}

std::string NameOf(const Method& method) {
  std::string name = method.name;
  for (const auto& [option, value] : method.options)
    absl::StrAppend(&name, ":", option, "=", value);
  return name;
}

// What is asked of one job.
struct Asked {
  Method method = {};
  std::vector<JobLayer> layers = {};
  std::optional<CleaningSpec> cleaning = std::nullopt;
  int threads = 1;
  std::optional<int64_t> deadline = std::nullopt;  // in readings of the clock
};

std::map<uint64_t, LayerOutcome> Answers(const Asked& asked) {
  const StepClock clock;
  RecordingSink sink;
  TestExecutor executor(asked.threads);
  JobSpec spec;
  spec.cleaning = asked.cleaning;
  spec.time = &clock;
  if (asked.deadline) spec.deadline = StepClock::At(*asked.deadline);
  auto job =
      Job::Start(spec, *MakeStrategy(asked.method.name, asked.method.options), executor, sink);
  for (const JobLayer& layer : asked.layers) job->Add(layer);
  job->Close();
  sink.Wait();
  return sink.ByIndex();
}

// Of `route` from where the layer began, with the move to the cleaning point.
double CostOf(const Asked& asked, const LayerOutcome& outcome, const Route& route) {
  const JobLayer& layer = asked.layers[outcome.index];
  LayerProblem problem{&layer.plan, outcome.start, std::nullopt, layer.cost.value_or(CostSpec()),
                       1};
  const bool is_last = outcome.index + 1 == asked.layers.size();
  if (asked.cleaning && !is_last &&
      (outcome.index + 1) % static_cast<uint64_t>(asked.cleaning->every_layers) == 0) {
    problem.finish = asked.cleaning->point;
  }
  std::unique_ptr<const WallCost> walls;
  if (problem.cost.kind == CostSpec::Kind::kTime && !layer.walls.empty()) {
    walls = std::make_unique<const WallCost>(layer.walls, layer.plan, problem.cost);
    problem.walls = walls.get();
  }
  return RouteCost(problem, route);
}

void ExpectWithinInitial(const Asked& asked) {
  const auto answers = Answers(asked);
  ASSERT_EQ(answers.size(), asked.layers.size());
  for (const auto& [index, outcome] : answers) {
    SCOPED_TRACE(absl::StrCat(NameOf(asked.method), " layer ", index));
    ASSERT_OK(ValidateRoute(asked.layers[index].plan, outcome.route));
    EXPECT_EQ(outcome.invalid_route, "");
    const Route& initial = asked.layers[index].initial_route;
    if (initial.empty()) continue;
    EXPECT_LE(CostOf(asked, outcome, outcome.route), CostOf(asked, outcome, initial));
  }
}

// Of trees with pairs and without; with walls, known moves and times; every third one by length;
// some begin at a given point.
std::vector<JobLayer> RandomLayers(uint64_t seed, int count, int max_paths) {
  Rng rng(seed);
  std::vector<JobLayer> layers;
  for (int i = 0; i < count; ++i) {
    const uint64_t own = seed * 1000 + static_cast<uint64_t>(i);
    JobLayer& layer = layers.emplace_back();
    if (i % 3 == 0) {
      layer.plan = RandomPlan(own, {.max_paths = max_paths});
    } else {
      WalledProblem walled = RandomWalledProblem(own, {.max_paths = max_paths}, i % 3 == 1);
      layer.plan = walled.owned.plan();
      layer.cost = walled.problem().cost;
      layer.walls = std::move(walled.walls);
    }
    if (i % 4 == 2) layer.start = Point{100 * rng.Unit(), 100 * rng.Unit()};
    layer.more_follows = seed % 2 == 0 && i + 1 < count;
  }
  return layers;
}

// Sets routes of chance, and in every other layer what ni2opt finds.
void SetRoutes(uint64_t seed, Asked& asked) {
  Rng rng(seed);
  Asked found = asked;
  found.method = {"ni2opt"};
  auto answers = Answers(found);
  for (size_t i = 0; i < asked.layers.size(); ++i) {
    JobLayer& layer = asked.layers[i];
    layer.initial_route = i % 2 == 0 ? RandomRoute(layer.plan, rng).Build() : answers[i].route;
  }
}

TEST(InitialRoute, IsNeverBetterThanTheAnswer) {
  for (uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Asked asked{.layers = RandomLayers(seed, 7, 9)};
    if (seed % 3 == 0) asked.cleaning = CleaningSpec{{90, 90}, 2, 0};
    SetRoutes(seed, asked);
    for (const Method& method : Methods()) {
      asked.method = method;
      ExpectWithinInitial(asked);
    }
  }
}

TEST(InitialRoute, IsNeverBetterThanTheAnswerHoweverShortTheTime) {
  for (uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Asked asked{.layers = RandomLayers(seed, 6, 25)};
    SetRoutes(seed, asked);
    for (const Method& method : Methods()) {
      for (const int64_t readings : {0, 20, 100, 1000}) {
        asked.method = method;
        asked.deadline = readings;
        ExpectWithinInitial(asked);
      }
    }
  }
}

// Layers that are one problem share what is found, but not what their callers know.
TEST(InitialRoute, OfEqualLayersMayDiffer) {
  for (const Method& method :
       {Method{"auto"}, Method{"ni2opt"}, Method{"auto", {{"effort", "0"}}}}) {
    for (uint64_t seed = 1; seed <= 3; ++seed) {
      SCOPED_TRACE(absl::StrCat("seed ", seed));
      Asked asked{.method = method, .layers = {}, .threads = 1};
      Rng rng(seed);
      const JobLayer one = RandomLayers(seed, 2, 12)[1];
      for (int i = 0; i < 60; ++i) {
        JobLayer& layer = asked.layers.emplace_back(one);
        layer.more_follows = i + 1 < 60;
        if (i % 3 > 0) layer.initial_route = RandomRoute(one.plan, rng).Build();
      }
      ExpectWithinInitial(asked);
    }
  }
}

TEST(InitialRoute, IsKeptByNone) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    Asked asked{.method = {"none"}, .layers = RandomLayers(seed, 5, 12)};
    SetRoutes(seed, asked);
    for (const auto& [index, outcome] : Answers(asked)) {
      EXPECT_EQ(outcome.route, asked.layers[index].initial_route);
    }
  }
}

TEST(InitialRoute, GivesTheSameRoutesOnAnyNumberOfThreads) {
  for (const char* name : {"auto", "ni2opt", "tabu"}) {
    for (uint64_t seed = 1; seed <= 2; ++seed) {
      SCOPED_TRACE(absl::StrCat(name, " seed ", seed));
      Asked asked{.method = {name}, .layers = RandomLayers(seed, 8, 20)};
      SetRoutes(seed, asked);
      const auto one = Answers(asked);
      asked.threads = 8;
      const auto eight = Answers(asked);
      for (const auto& [index, outcome] : one) EXPECT_EQ(eight.at(index).route, outcome.route);
    }
  }
}

double Iterations(const std::map<uint64_t, LayerOutcome>& answers) {
  double sum = 0;
  for (const auto& [index, outcome] : answers) sum += outcome.statistics.at("iterations");
  return sum;
}

// A search that begins near its end is short, and no worse.
TEST(InitialRoute, SparesMostOfTheSearch) {
  double cold = 0;
  double warm = 0;
  for (uint64_t seed = 1; seed <= 2; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Asked asked{.method = {"auto", {{"idle_speed", "130"}}}};
    JobLayer& layer = asked.layers.emplace_back();
    layer.plan = RandomPlan(seed, {PlanShape::kSequential, 150, 200});
    const auto found = Answers(asked);
    cold += Iterations(found);
    layer.initial_route = found.at(0).route;

    const auto again = Answers(asked);

    warm += Iterations(again);
    EXPECT_LE(again.at(0).cost, found.at(0).cost);
  }
  EXPECT_LT(warm, 0.6 * cold);
}

}  // namespace
}  // namespace traverse

// The hot kernels of `auto`, one by one, on a layer of rings: nanoseconds a call.
//
//   build/release/tests/bench/micro/engine_micro [--benchmark_filter=Kick]

#include <benchmark/benchmark.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "engine/base/rng.h"
#include "engine/cost/entry_choice.h"
#include "engine/search/end_groups.h"
#include "engine/search/greedy/greedy.h"
#include "engine/search/iterated_search.h"
#include "tests/bench/layers/bench_part.h"

namespace traverse::bench {
namespace {

// Everything that local search needs on a layer of `contours` rings and as many rasters.
struct Layer {
  explicit Layer(int contours, bool time = false)
      : plan(RandomRings(contours, 40, 1)),
        problem(ProblemOf(plan, time)),
        view(problem),
        tree(plan),
        entries(problem),
        groups(entries),
        state(problem, tree, entries) {
    Budget budget;
    state.Load(GreedyRoute(view, budget));
  }

  static LayerProblem ProblemOf(const Plan& plan, bool time) {
    LayerProblem problem;
    problem.plan = &plan;
    if (time) {
      problem.cost.kind = CostSpec::Kind::kTime;
      problem.cost.accel_mm_s2 = 1500;
      problem.cost.retraction_seconds = 0.08;
      problem.cost.retraction_threshold_mm = 2;
    }
    return problem;
  }

  Plan plan;
  LayerProblem problem;
  LayerView view;
  OrderTree tree;
  LeafEntries entries;
  EndGroups groups;
  SearchState state;
};

constexpr int kBreadth = ThreeOptOptions().first_breadth;

void BestEntryOf40(benchmark::State& loop) {
  const Layer layer(4, loop.range(0) != 0);
  const TravelCost cost(layer.problem.cost);
  const Point to{12, 3};
  for (auto _ : loop) {
    benchmark::DoNotOptimize(layer.entries.Best(0, {1, 20}, &to, cost));
  }
}
BENCHMARK(BestEntryOf40)->ArgName("time")->Arg(0)->Arg(1);

void Greedy(benchmark::State& loop) {
  const Layer layer(static_cast<int>(loop.range(0)));
  for (auto _ : loop) {
    Budget budget;
    benchmark::DoNotOptimize(GreedyRoute(layer.view, budget));
  }
}
BENCHMARK(Greedy)->Arg(50)->Arg(200)->Arg(1000)->Unit(benchmark::kMicrosecond);

void Neighbors(benchmark::State& loop) {
  const Layer layer(static_cast<int>(loop.range(0)));
  for (auto _ : loop) {
    Budget budget;
    benchmark::DoNotOptimize(FindNeighbors(layer.tree, layer.groups, kBreadth, budget));
  }
}
BENCHMARK(Neighbors)->Arg(50)->Arg(200)->Arg(1000)->Unit(benchmark::kMicrosecond);

// The best entries for the order of a whole layer.
void ChooseEntries(benchmark::State& loop) {
  const Layer layer(static_cast<int>(loop.range(0)));
  EntryChoice choice(layer.view.table, layer.view.cost);
  std::vector<int> paths;
  for (const Visit& visit : layer.state.Unload()) paths.push_back(visit.path);
  std::vector<int> entries(paths.size());
  for (auto _ : loop) {
    benchmark::DoNotOptimize(choice.Choose({}, paths, std::nullopt, absl::MakeSpan(entries)));
  }
}
BENCHMARK(ChooseEntries)->Arg(50)->Arg(200)->Unit(benchmark::kMicrosecond);

void Descend(benchmark::State& loop) {
  Layer layer(static_cast<int>(loop.range(0)));
  const Route route = layer.state.Unload();
  Budget budget;
  const NeighborLists lists = FindNeighbors(layer.tree, layer.groups, kBreadth, budget);
  for (auto _ : loop) {
    layer.state.Load(route);
    IteratedSearch(layer.state, lists, {}).Descend(budget);
  }
}
BENCHMARK(Descend)->Arg(50)->Arg(200)->Arg(1000)->Unit(benchmark::kMicrosecond);

// One kick with its repair, near a local optimum.
void Kick(benchmark::State& loop) {
  Layer layer(static_cast<int>(loop.range(0)), loop.range(1) != 0);
  Budget budget;
  const NeighborLists lists = FindNeighbors(layer.tree, layer.groups, kBreadth, budget);
  IteratedSearchOptions options;
  options.patience = 1;
  IteratedSearch search(layer.state, lists, options);
  search.Descend(budget);
  Rng rng(1);
  const int64_t before = search.iterations();
  for (auto _ : loop) search.Run(rng, budget);
  loop.counters["kicks/s"] = benchmark::Counter(static_cast<double>(search.iterations() - before),
                                                benchmark::Counter::kIsRate);
}
BENCHMARK(Kick)
    ->ArgNames({"contours", "time"})
    ->Args({50, 0})
    ->Args({50, 1})
    ->Args({200, 0})
    ->Args({1000, 0})
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace traverse::bench

BENCHMARK_MAIN();

// The tables of layers_bench. Each prints Markdown and returns whether what it checks holds.

#ifndef TRAVERSE_TESTS_BENCH_LAYERS_SECTIONS_H_
#define TRAVERSE_TESTS_BENCH_LAYERS_SECTIONS_H_

#include <string>
#include <vector>

#include "tests/bench/layers/bench_part.h"

namespace traverse::bench {

struct BenchOptions {
  bool quick = false;
  int seeds = 5;
  int threads = 1;
  int deadlines = 1000;
  std::vector<std::string> parts;  // empty: all
  std::vector<std::string> sections = {"routes", "time",   "tenth",    "threads",
                                       "growth", "memory", "deadlines"};
};

// Travel by strategy, how far `auto` is from the best route known, and its speed. False if a route
// was invalid or `auto` was longer than greedy.
bool PrintRoutes(const std::vector<BenchPart>& parts, const BenchOptions& options);

// How far `auto` is from the best routes known after 2 ms to 2 s a layer.
bool PrintTime(const std::vector<BenchPart>& parts, const BenchOptions& options);

// How much longer routes are after a tenth of their time than after all of it.
bool PrintFirstTenth(const std::vector<BenchPart>& parts, const BenchOptions& options);

// Layers a second on 1, 2, ... threads: of a part that repeats its layers, and of layers that are
// all different.
bool PrintThreads(const std::vector<BenchPart>& parts, const BenchOptions& options);

// From 200 to 5000 contours: time and memory by default, the time to come within 2 % of the route
// after a minute, and how that grows.
bool PrintGrowth(const BenchOptions& options);

// The most memory that one layer of 200,000 vertices takes. False if that is 1 GB or more.
bool PrintMemory(const BenchOptions& options);

// Jobs with random deadlines from 1 ms to 2 s: how many came late, were invalid, or longer than
// greedy where greedy takes no longer.
bool PrintDeadlines(const std::vector<BenchPart>& parts, const BenchOptions& options);

}  // namespace traverse::bench

#endif  // TRAVERSE_TESTS_BENCH_LAYERS_SECTIONS_H_

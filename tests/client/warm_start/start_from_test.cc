// A job that begins with an earlier one's routes, before and after its file was edited.

#include "client/warm_start/start_from.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "client/warm_start/layer_shape.h"

namespace traverse {
namespace {

using Random = std::mt19937;

int Below(Random& random, int bound) {
  return std::uniform_int_distribution<int>(0, bound - 1)(random);
}

double Anywhere(Random& random) { return std::uniform_real_distribution<double>(0, 200)(random); }

void AddPoint(double x, double y, google::protobuf::RepeatedField<double>& points) {
  points.Add(x);
  points.Add(y);
}

v1::Contour RandomContour(Random& random, uint64_t id) {
  v1::Contour contour;
  contour.set_id(id);
  const double x = Anywhere(random);
  const double y = Anywhere(random);
  AddPoint(x, y, *contour.mutable_points());
  AddPoint(x + 4, y, *contour.mutable_points());
  AddPoint(x + 2, y + 5, *contour.mutable_points());
  if (id % 4 == 3) contour.add_entries(2);
  return contour;
}

v1::OpenPath RandomOpenPath(Random& random, uint64_t id) {
  v1::OpenPath path;
  path.set_id(id);
  const double x = Anywhere(random);
  const double y = Anywhere(random);
  AddPoint(x, y, *path.mutable_points());
  AddPoint(x + 3, y + 3, *path.mutable_points());
  AddPoint(x + 6, y, *path.mutable_points());
  path.set_one_way(id % 3 == 2);
  return path;
}

v1::Layer IslandLayer(Random& random, uint64_t id) {
  v1::Layer layer;
  layer.set_id(id);
  for (uint64_t i = 0; i < 5; ++i) {
    v1::Island& island = *layer.add_islands();
    island.set_id(i + 1);
    for (uint64_t p = 0; p < 4; ++p) {
      *island.add_contours() = RandomContour(random, p);
      *island.add_rasters() = RandomOpenPath(random, p);
    }
  }
  return layer;
}

// any_order(in_order(path, any_order(paths, pairs)), paths...)
v1::Layer PlanLayer(Random& random, uint64_t id) {
  v1::Layer layer;
  layer.set_id(id);
  v1::Plan& plan = *layer.mutable_plan();
  for (int i = 0; i < 4; ++i) plan.add_nodes();
  const auto add_leaf = [&](uint64_t label) {
    v1::PlanPath& path = *plan.add_paths();
    if (label % 2 == 0) {
      *path.mutable_contour() = RandomContour(random, label);
    } else {
      *path.mutable_open_path() = RandomOpenPath(random, label);
    }
    plan.add_nodes()->set_path(static_cast<uint32_t>(plan.paths_size() - 1));
    return static_cast<uint32_t>(plan.nodes_size() - 1);
  };
  plan.mutable_nodes(0)->mutable_any_order()->add_children(1);
  plan.mutable_nodes(1)->mutable_in_order()->add_children(2);
  plan.mutable_nodes(1)->mutable_in_order()->add_children(3);
  plan.mutable_nodes(2)->mutable_any_order()->add_children(add_leaf(0));
  for (uint64_t p = 1; p < 9; ++p) {
    plan.mutable_nodes(3)->mutable_any_order()->add_children(add_leaf(p));
  }
  for (uint32_t p = 0; p + 2 < 8; p += 3) {
    v1::Precedence& pair = *plan.mutable_nodes(3)->mutable_any_order()->add_before();
    pair.set_first(p + 2);
    pair.set_second(p);
  }
  for (uint64_t p = 9; p < 16; ++p) {
    plan.mutable_nodes(0)->mutable_any_order()->add_children(add_leaf(p));
  }
  return layer;
}

InputJob RandomJob(uint64_t seed, bool interleaved) {
  Random random(static_cast<uint32_t>(seed));
  InputJob job;
  if (interleaved) job.options.set_deposition(v1::DEPOSITION_INTERLEAVED);
  for (uint64_t id = 1; id <= 3; ++id) {
    job.layers.push_back(IslandLayer(random, 2 * id));
    job.layers.push_back(PlanLayer(random, 2 * id + 1));
  }
  return job;
}

LayerShape ShapeIn(const InputJob& job, size_t layer) {
  return *ShapeOf(job.layers[layer], job.options.deposition() == v1::DEPOSITION_INTERLEAVED,
                  nullptr);
}

EarlierVisit Visited(const ShapePath& path, uint32_t entry) {
  EarlierVisit visit{path.contour, path.island, path.id, entry, {}, {}};
  visit.from = PlacedPoint{path.Enter(entry).first, path.Enter(entry).second};
  visit.to = PlacedPoint{path.Exit(entry).first, path.Exit(entry).second};
  return visit;
}

// A route of each layer, by chance: as --json has it, and as the API has it.
struct KnownJob {
  std::vector<EarlierLayer> earlier;
  std::vector<std::vector<v1::Visit>> routes;
};

KnownJob RandomRoutes(const InputJob& job, Random& random) {
  KnownJob known;
  for (size_t i = 0; i < job.layers.size(); ++i) {
    const LayerShape shape = ShapeIn(job, i);
    std::vector<double> ranks;
    for (size_t p = 0; p < shape.paths.size(); ++p) ranks.push_back(Anywhere(random));
    EarlierLayer& earlier = known.earlier.emplace_back();
    earlier.id = job.layers[i].id();
    known.routes.emplace_back();
    for (const int p : OrderByRanks(shape, ranks)) {
      const ShapePath& path = shape.paths[static_cast<size_t>(p)];
      const uint32_t entry =
          path.entries[static_cast<size_t>(Below(random, static_cast<int>(path.entries.size())))];
      earlier.route.push_back(Visited(path, entry));
      known.routes.back().push_back(path.VisitAt(entry));
    }
  }
  return known;
}

std::string Text(const v1::Visit& visit) { return visit.ShortDebugString(); }

// Which path of the shape a visit names.
int PathOf(const v1::Visit& visit, const LayerShape& shape) {
  for (size_t p = 0; p < shape.paths.size(); ++p) {
    v1::Visit name = visit;
    name.clear_entry();
    if (Text(name) == Text(shape.paths[p].name)) return static_cast<int>(p);
  }
  return -1;
}

// Each path once, at an entry that it has, in an order that stays as it is where the tree has its
// say.
void ExpectLegal(const InputJob& job, size_t layer) {
  const LayerShape shape = ShapeIn(job, layer);
  const auto& route = job.layers[layer].initial_route();
  ASSERT_EQ(static_cast<size_t>(route.size()), shape.paths.size());
  std::vector<double> ranks(shape.paths.size(), -1);
  std::vector<int> order;
  for (int i = 0; i < route.size(); ++i) {
    const int path = PathOf(route[i], shape);
    ASSERT_GE(path, 0) << Text(route[i]);
    const auto& entries = shape.paths[static_cast<size_t>(path)].entries;
    const uint32_t entry =
        route[i].has_vertex() ? route[i].vertex() : (route[i].reversed() ? 1 : 0);
    EXPECT_NE(std::find(entries.begin(), entries.end(), entry), entries.end());
    ranks[static_cast<size_t>(path)] = i;
    order.push_back(path);
  }
  EXPECT_EQ(OrderByRanks(shape, ranks), order);
}

TEST(StartFrom, KeepsTheRoutesOfAFileThatIsTheSame) {
  for (uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    InputJob job = RandomJob(seed, seed % 2 == 0);
    Random random(static_cast<uint32_t>(seed));
    const KnownJob known = RandomRoutes(job, random);

    const WarmStart start = StartFrom(known.earlier, job);

    EXPECT_EQ(start.layers, job.layers.size());
    EXPECT_EQ(start.known, start.paths);
    for (size_t i = 0; i < job.layers.size(); ++i) {
      ASSERT_EQ(static_cast<size_t>(job.layers[i].initial_route_size()), known.routes[i].size());
      for (size_t v = 0; v < known.routes[i].size(); ++v) {
        EXPECT_EQ(Text(job.layers[i].initial_route(static_cast<int>(v))), Text(known.routes[i][v]));
      }
    }
  }
}

// The labels of the paths of a route, in order.
std::vector<std::pair<uint64_t, uint64_t>> Labels(const InputJob& job, size_t layer) {
  const LayerShape shape = ShapeIn(job, layer);
  std::vector<std::pair<uint64_t, uint64_t>> labels;
  for (const v1::Visit& visit : job.layers[layer].initial_route()) {
    const ShapePath& path = shape.paths[static_cast<size_t>(PathOf(visit, shape))];
    labels.emplace_back(path.island, path.id * 2 + (path.contour ? 1 : 0));
  }
  return labels;
}

TEST(StartFrom, KeepsTheOrderOfWhatIsLeft) {
  for (uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    InputJob job = RandomJob(seed, seed % 2 == 0);
    Random random(static_cast<uint32_t>(seed));
    KnownJob known = RandomRoutes(job, random);
    InputJob whole = job;
    StartFrom(known.earlier, whole);
    // The file's numbering may change with what was removed; what it had stays in its place.
    for (size_t i = 0; i < job.layers.size(); i += 2) {
      job.layers[i].mutable_islands(2)->mutable_contours()->DeleteSubrange(1, 2);
      job.layers[i].mutable_islands(3)->mutable_rasters()->DeleteSubrange(0, 1);
      job.layers[i].mutable_islands()->DeleteSubrange(1, 1);
    }

    StartFrom(known.earlier, job);

    for (size_t i = 0; i < job.layers.size(); i += 2) {
      ExpectLegal(job, i);
      auto kept = Labels(job, i);
      auto all = Labels(whole, i);
      const std::set<std::pair<uint64_t, uint64_t>> left(kept.begin(), kept.end());
      std::erase_if(all, [&](const auto& label) { return !left.contains(label); });
      EXPECT_EQ(kept, all);
    }
  }
}

TEST(StartFrom, PutsNewPathsBesideTheirNeighbors) {
  Random random(3);
  InputJob job;
  v1::Layer& layer = job.layers.emplace_back();
  layer.set_id(1);
  v1::Island& island = *layer.add_islands();
  // A row of contours, known from left to right, and new ones between them.
  std::vector<EarlierLayer> earlier(1);
  earlier[0].id = 1;
  for (int i = 0; i < 20; ++i) {
    v1::Contour& contour = *island.add_contours();
    contour.set_id(static_cast<uint64_t>(i));
    AddPoint(10 * i, 0, *contour.mutable_points());
    if (i % 2 == 0) {
      earlier[0].route.push_back({true, 0, static_cast<uint64_t>(i), 0, PlacedPoint{10.0 * i, 0},
                                  PlacedPoint{10.0 * i, 0}});
    }
  }
  std::shuffle(island.mutable_contours()->begin(), island.mutable_contours()->end(), random);

  const WarmStart start = StartFrom(earlier, job);

  EXPECT_EQ(start.known, 10u);
  EXPECT_EQ(start.paths, 20u);
  ASSERT_EQ(job.layers[0].initial_route_size(), 20);
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(island.contours(static_cast<int>(job.layers[0].initial_route(i).contour())).points(0),
              10 * i);
  }
}

// Applies `edit` to every coordinate pair.
template <typename Edit>
void EditPoints(InputJob& job, Edit edit) {
  const auto each = [&](google::protobuf::RepeatedField<double>& points) {
    const auto [dx, dy] = edit();
    for (int i = 0; i < points.size(); i += 2) {
      points[i] += dx;
      points[i + 1] += dy;
    }
  };
  for (v1::Layer& layer : job.layers) {
    for (v1::Island& island : *layer.mutable_islands()) {
      for (v1::Contour& contour : *island.mutable_contours()) each(*contour.mutable_points());
      for (v1::OpenPath& raster : *island.mutable_rasters()) each(*raster.mutable_points());
    }
    if (!layer.has_plan()) continue;
    for (v1::PlanPath& path : *layer.mutable_plan()->mutable_paths()) {
      each(path.has_contour() ? *path.mutable_contour()->mutable_points()
                              : *path.mutable_open_path()->mutable_points());
    }
  }
}

void ExpectSameRoutes(const KnownJob& known, const InputJob& job) {
  for (size_t i = 0; i < job.layers.size(); ++i) {
    ASSERT_EQ(static_cast<size_t>(job.layers[i].initial_route_size()), known.routes[i].size());
    for (size_t v = 0; v < known.routes[i].size(); ++v) {
      EXPECT_EQ(Text(job.layers[i].initial_route(static_cast<int>(v))), Text(known.routes[i][v]));
    }
  }
}

TEST(StartFrom, FollowsWhatWasMoved) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const InputJob job = RandomJob(seed, seed % 2 == 0);
    Random random(static_cast<uint32_t>(seed));
    const KnownJob known = RandomRoutes(job, random);
    InputJob shifted = job;
    EditPoints(shifted, [] { return std::pair(31.25, -7.5); });
    StartFrom(known.earlier, shifted);
    ExpectSameRoutes(known, shifted);
    // A bit, each on its own. Points of several paths may be nearer than that.
    InputJob shaken = job;
    EditPoints(shaken, [&] { return std::pair(Anywhere(random) * 1e-4, Anywhere(random) * 1e-4); });
    const WarmStart start = StartFrom(known.earlier, shaken);
    EXPECT_EQ(start.known, start.paths);
    for (size_t i = 0; i < job.layers.size(); ++i) ExpectLegal(shaken, i);
  }
}

TEST(StartFrom, FindsLayersThatOthersWerePutBefore) {
  InputJob job = RandomJob(5, false);
  Random random(5);
  const KnownJob known = RandomRoutes(job, random);
  const InputJob other = RandomJob(6, false);
  InputJob longer = job;
  longer.layers.insert(longer.layers.begin(), other.layers.begin(), other.layers.begin() + 2);
  // Files number their layers anew.
  for (size_t i = 0; i < longer.layers.size(); ++i) longer.layers[i].set_id(i + 2);

  StartFrom(known.earlier, longer);

  longer.layers.erase(longer.layers.begin(), longer.layers.begin() + 2);
  ExpectSameRoutes(known, longer);
}

TEST(StartFrom, OfAnEarlierVersionGoesByLabels) {
  InputJob job = RandomJob(5, false);
  Random random(5);
  KnownJob known = RandomRoutes(job, random);
  for (EarlierLayer& layer : known.earlier) {
    for (EarlierVisit& visit : layer.route) visit.from = visit.to = std::nullopt;
  }

  StartFrom(known.earlier, job);

  ExpectSameRoutes(known, job);
}

TEST(StartFrom, LeavesAloneWhatTheServiceRefuses) {
  Random random(1);
  InputJob job = RandomJob(1, false);
  const KnownJob known = RandomRoutes(job, random);
  job.layers[0].mutable_islands(0)->mutable_contours(0)->add_points(1);
  job.layers[1].mutable_plan()->mutable_nodes(0)->mutable_any_order()->add_children(4'000'000'000);
  job.layers[2].mutable_islands(0)->mutable_rasters(0)->mutable_points()->Truncate(2);
  v1::AnyOrder& cycle = *job.layers[3].mutable_plan()->mutable_nodes(3)->mutable_any_order();
  cycle.add_before()->set_first(2);
  cycle.mutable_before(0)->set_second(2);
  job.layers[4].mutable_islands(1)->mutable_contours(1)->set_points(0, 1.0 / 0.0);
  job.layers[5].mutable_plan()->mutable_nodes(5)->set_path(9999);

  const WarmStart start = StartFrom(known.earlier, job);

  EXPECT_EQ(start.layers, 0u);
  for (const v1::Layer& layer : job.layers) EXPECT_EQ(layer.initial_route_size(), 0);
}

TEST(StartFrom, NeedsSomethingThatIsKnown) {
  InputJob job = RandomJob(1, false);
  EXPECT_EQ(StartFrom({}, job).layers, 0u);
  InputJob empty;
  EXPECT_EQ(StartFrom({}, empty).layers, 0u);
  empty.layers.resize(2);
  EXPECT_EQ(StartFrom(std::vector<EarlierLayer>(3), empty).layers, 0u);
}

}  // namespace
}  // namespace traverse

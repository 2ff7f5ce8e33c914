// Nothing that is done with one message goes on for long without asking: others have their turns
// meanwhile, and a cancel is seen. Messages of one layer, as large as the server takes them.

#include <gtest/gtest.h>
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "server/rpc/request_reader.h"
#include "server/translate/translate.h"
#include "tests/support/status_matchers.h"
#include "traverse/v1/route_optimizer_service.pb.h"

namespace traverse {
namespace {

double ThreadSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Wanted all the time; measures how long the thread works between two asks.
class MeasuringTurn : public Turn {
 public:
  MeasuringTurn() { SetWanted(true); }
  bool GiveWay(const CancelToken* /*cancel*/, std::optional<Clock::time_point> /*end*/) override {
    Ask();
    return false;
  }
  void Ask() {
    const double now = ThreadSeconds();
    longest = std::max(longest, now - last_);
    last_ = now;
    ++asks;
  }

  double longest = 0;  // seconds
  int asks = 0;

 private:
  double last_ = ThreadSeconds();
};

struct Shape {
  const char* name;
  std::function<void(int n, v1::Layer& layer)> fill;
  int most;
};

void AddDot(v1::Contour& contour, int i) {
  contour.add_points(0.001 * (i % 1000));
  contour.add_points(0.001 * (i / 1000));
}

const Shape kShapes[] = {
    {"empty islands",
     [](int n, v1::Layer& layer) {
       for (int i = 0; i < n; ++i) layer.add_islands();
     },
     4'000'000},
    {"dots in islands",
     [](int n, v1::Layer& layer) {
       for (int i = 0; i < n; ++i) AddDot(*layer.add_islands()->add_contours(), i);
     },
     1'000'000},
    {"dots in one island",
     [](int n, v1::Layer& layer) {
       v1::Island& island = *layer.add_islands();
       for (int i = 0; i < n; ++i) AddDot(*island.add_contours(), i);
     },
     1'000'000},
    {"one contour, all entries",
     [](int n, v1::Layer& layer) {
       v1::Contour& contour = *layer.add_islands()->add_contours();
       for (int i = 0; i < n; ++i) {
         AddDot(contour, i);
         contour.add_entries(static_cast<uint32_t>(i));
       }
     },
     1'000'000},
    {"a plan with pairs",
     [](int n, v1::Layer& layer) {
       v1::Plan& plan = *layer.mutable_plan();
       v1::AnyOrder& any_order = *plan.add_nodes()->mutable_any_order();
       for (int i = 0; i < n; ++i) {
         AddDot(*plan.add_paths()->mutable_contour(), i);
         plan.add_nodes()->set_path(static_cast<uint32_t>(i));
         any_order.add_children(static_cast<uint32_t>(i + 1));
         if (i == 0) continue;
         any_order.add_before()->set_first(static_cast<uint32_t>(i - 1));
         any_order.mutable_before(i - 1)->set_second(static_cast<uint32_t>(i));
       }
     },
     900'000},
    {"walls that name paths",
     [](int n, v1::Layer& layer) {
       v1::Island& island = *layer.add_islands();
       for (int i = 0; i < n; ++i) {
         AddDot(*island.add_contours(), i);
         layer.add_walls()->set_path(static_cast<uint32_t>(i));
         layer.add_exposed_paths(static_cast<uint32_t>(n - 1 - i));
       }
     },
     900'000},
    {"a route that is known",
     [](int n, v1::Layer& layer) {
       v1::Island& island = *layer.add_islands();
       for (int i = 0; i < n; ++i) {
         AddDot(*island.add_contours(), i);
         v1::Visit& visit = *layer.add_initial_route();
         visit.set_island(0);
         visit.set_contour(static_cast<uint32_t>(i == 0 ? 0 : n - i));  // the outer one first
         visit.set_vertex(0);
       }
     },
     900'000},
    {"moves that are known",
     [](int n, v1::Layer& layer) {
       v1::Island& island = *layer.add_islands();
       for (int i = 0; i < n; ++i) {
         AddDot(*island.add_contours(), i);
         layer.add_known_moves()->set_to(static_cast<uint32_t>(i));
         layer.add_retracted_paths(static_cast<uint32_t>(n - 1 - i));
       }
     },
     900'000},
};

void ReadAndTranslate(const Shape& shape, int n, MeasuringTurn& turn, double& longest_of_reader) {
  v1::OptimizeBatchRequest request;
  shape.fill(n, *request.add_layers());
  const grpc::Slice slice(request.SerializeAsString());
  grpc::ByteBuffer message(&slice, 1);
  request.Clear();
  RequestReader reader;
  MeasuringTurn of_reader;
  ASSERT_OK(reader.Open("a request", message, {}, [&] {
    of_reader.Ask();
    return true;
  }));
  double begun = 0;
  absl::StatusOr<LabelledLayer> translated;  // is not freed here
  ASSERT_OK(reader.Read(1, [&](const v1::Layer& layer) {
    of_reader.Ask();
    turn.Ask();
    turn.longest = 0;
    Budget budget(nullptr, std::nullopt, &turn);
    translated = LayerFromProto(layer, 0, true, &budget);
    turn.Ask();
    begun = of_reader.longest;
    of_reader.Ask();
    of_reader.longest = begun;
    return translated.status();
  }));
  of_reader.Ask();
  longest_of_reader = of_reader.longest;
}

class ReadingGaps : public ::testing::TestWithParam<size_t> {};

TEST_P(ReadingGaps, AreShort) {
  const Shape& shape = kShapes[GetParam()];
  MeasuringTurn turn;
  double of_reader = 0;
  ReadAndTranslate(shape, shape.most / 5, turn, of_reader);
  EXPECT_GE(turn.asks, 3) << shape.name;  // of which two are the test's
}

// Run by hand.
TEST_P(ReadingGaps, DISABLED_AreShortInTheLargestMessages) {
  const Shape& shape = kShapes[GetParam()];
  MeasuringTurn turn;
  double of_reader = 0;
  ReadAndTranslate(shape, shape.most, turn, of_reader);
  std::printf("%-26s %8d: %6.1f ms while it is read, %6.1f ms while it is translated\n", shape.name,
              shape.most, 1000 * of_reader, 1000 * turn.longest);
  EXPECT_LT(of_reader, 0.06) << shape.name;
  EXPECT_LT(turn.longest, 0.06) << shape.name;
}

INSTANTIATE_TEST_SUITE_P(All, ReadingGaps, ::testing::Range(size_t{0}, std::size(kShapes)));

}  // namespace
}  // namespace traverse

#include "client/api/optimizer_client.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netdb.h>

#include <string>
#include <vector>

#include "absl/strings/str_format.h"
#include "client/api/channel.h"
#include "tests/client/api/fake_service.h"

namespace traverse {
namespace {

using ::testing::ElementsAre;
using testing::FakeService;
using ::testing::HasSubstr;
using testing::KeepOrder;
using ::testing::SizeIs;

// Layers of one island with a contour of `vertices` vertices and a raster of `bends` points.
std::vector<v1::Layer> Layers(int count, int vertices = 3, int bends = 2) {
  std::vector<v1::Layer> layers;
  for (int i = 0; i < count; ++i) {
    v1::Layer& layer = layers.emplace_back();
    layer.set_id(static_cast<uint64_t>(100 + i));
    v1::Island& island = *layer.add_islands();
    v1::Contour& contour = *island.add_contours();
    for (int v = 0; v < 2 * vertices; ++v) contour.add_points(v);
    v1::OpenPath& raster = *island.add_rasters();
    for (int v = 0; v < 2 * bends; ++v) raster.add_points(v);
  }
  return layers;
}

TEST(OptimizerClient, AnswersComeInBuildOrderWhateverOrderTheyWereSentIn) {
  FakeService service;
  service.read_all_first = true;
  service.answer = [](const v1::Layer& layer, uint64_t index) {
    return KeepOrder(layer, index ^ 1);
  };
  OptimizerClient client(service.InProcessChannel());
  std::vector<uint64_t> seen;
  CallOptions call;
  call.on_layer = [&](const v1::LayerResult& layer) { seen.push_back(layer.index()); };

  const absl::StatusOr<JobResult> result = client.Optimize({}, Layers(4), call);

  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_THAT(seen, ElementsAre(1, 0, 3, 2));
  ASSERT_THAT(result->layers, SizeIs(4));
  for (size_t i = 0; i < 4; ++i) EXPECT_EQ(result->layers[i].index(), i);
  EXPECT_EQ(result->summary.layers(), 4u);
}

TEST(OptimizerClient, EmptyJobHasASummary) {
  FakeService service;
  OptimizerClient client(service.InProcessChannel());

  const absl::StatusOr<JobResult> result = client.Optimize({}, {});

  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_EQ(service.messages, 1);
}

// Where one message is all, the last layer of it has its whole time limit for itself.
TEST(OptimizerClient, SaysThatMoreFollowsOnlyIfThereIsMoreThanOneMessage) {
  FakeService service;
  OptimizerClient client(service.InProcessChannel());

  ASSERT_TRUE(client.Optimize({}, Layers(3)).ok());
  EXPECT_EQ(service.messages, 1);
  EXPECT_FALSE(service.options.look_ahead());

  ASSERT_TRUE(client.Optimize({}, Layers(3, 5000)).ok());
  EXPECT_GT(service.messages, 1);
  EXPECT_TRUE(service.options.look_ahead());
}

TEST(OptimizerClient, SendsOptionsOnceAndSmallLayersTogether) {
  FakeService service;
  OptimizerClient client(service.InProcessChannel());
  v1::JobOptions options;
  options.set_seed(7);

  const absl::StatusOr<JobResult> result = client.Optimize(options, Layers(10'000));

  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_EQ(service.options.seed(), 7u);
  EXPECT_THAT(service.layers, SizeIs(10'000));
  EXPECT_LT(service.messages, 100);
}

TEST(OptimizerClient, SendsTheEndsOfOpenPathsAlone) {
  FakeService service;
  OptimizerClient client(service.InProcessChannel());
  std::vector<v1::Layer> layers = Layers(1, 3, 5);
  v1::Layer& plan = layers.emplace_back();
  v1::OpenPath& path = *plan.mutable_plan()->add_paths()->mutable_open_path();
  for (int v = 0; v < 6; ++v) path.add_points(v);

  ASSERT_TRUE(client.Optimize({}, layers).ok());

  EXPECT_THAT(service.layers[0].islands(0).contours(0).points(), SizeIs(6));
  EXPECT_THAT(service.layers[0].islands(0).rasters(0).points(), ElementsAre(0, 1, 8, 9));
  EXPECT_THAT(service.layers[1].plan().paths(0).open_path().points(), ElementsAre(0, 1, 4, 5));
  EXPECT_FALSE(service.layers[0].has_plan());
}

// Both sides would wait for ever if the client sent everything before it read anything.
// Points that are not sent would be refused by nobody.
TEST(OptimizerClient, SendsAllOfAnOpenPathWithPointsThatTheServiceRefuses) {
  FakeService service;
  OptimizerClient client(service.InProcessChannel());
  std::vector<v1::Layer> layers = Layers(2, 3, 5);
  layers[0].mutable_islands(0)->mutable_rasters(0)->set_points(3, std::nan(""));
  layers[1].mutable_islands(0)->mutable_rasters(0)->set_points(4, -1.1e6);

  ASSERT_TRUE(client.Optimize({}, layers).ok());

  ASSERT_THAT(service.layers, SizeIs(2));
  for (const v1::Layer& layer : service.layers)
    EXPECT_THAT(layer.islands(0).rasters(0).points(), SizeIs(10));
}

// Half a point is for the service to refuse.
TEST(OptimizerClient, SendsOpenPathsThatAreNoneAsTheyAre) {
  FakeService service;
  OptimizerClient client(service.InProcessChannel());
  std::vector<v1::Layer> layers = Layers(3);
  const auto points = [&](size_t layer) {
    return layers[layer].mutable_islands(0)->mutable_rasters(0)->mutable_points();
  };
  points(0)->Truncate(2);
  points(1)->Truncate(3);
  points(2)->Add(7);

  ASSERT_TRUE(client.Optimize({}, layers).ok());

  ASSERT_THAT(service.layers, SizeIs(3));
  EXPECT_THAT(service.layers[0].islands(0).rasters(0).points(), ElementsAre(0, 1));
  EXPECT_THAT(service.layers[1].islands(0).rasters(0).points(), ElementsAre(0, 1, 2));
  EXPECT_THAT(service.layers[2].islands(0).rasters(0).points(), ElementsAre(0, 1, 2, 3, 7));
}

TEST(OptimizerClient, ReadsWhileItSends) {
  FakeService service;
  service.answer = [](const v1::Layer& layer, uint64_t index) {
    v1::LayerResult result = KeepOrder(layer, index);
    result.set_strategy(std::string(100'000, 'x'));
    return result;
  };
  OptimizerClient client(*ConnectTo({service.address()}));

  const absl::StatusOr<JobResult> result = client.Optimize({}, Layers(200, 5000));

  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_THAT(result->layers, SizeIs(200));
}

TEST(OptimizerClient, ErrorsAreTheServersOwn) {
  FakeService service;
  OptimizerClient client(service.InProcessChannel());
  for (const uint64_t before : {uint64_t{0}, uint64_t{3}}) {
    service.status = grpc::Status(grpc::StatusCode::INVALID_ARGUMENT, "layers[3].islands: bad");
    service.layers_before_status = before;

    const absl::StatusOr<JobResult> result = client.Optimize({}, Layers(2000, 1000));

    EXPECT_EQ(result.status(), absl::InvalidArgumentError("layers[3].islands: bad"));
  }
  EXPECT_EQ(client.ListStrategies().status().code(), absl::StatusCode::kInvalidArgument);
}

TEST(OptimizerClient, AnswersThatAreNoneAreInternal) {
  FakeService service;
  OptimizerClient client(service.InProcessChannel());
  const auto error = [&](auto answer) {
    service.answer = answer;
    const absl::StatusOr<JobResult> result = client.Optimize({}, Layers(2));
    EXPECT_EQ(result.status().code(), absl::StatusCode::kInternal);
    return std::string(result.status().message());
  };

  EXPECT_THAT(error([](const v1::Layer& layer, uint64_t) { return KeepOrder(layer, 0); }),
              HasSubstr("not asked for"));
  EXPECT_THAT(error([](const v1::Layer& layer, uint64_t) { return KeepOrder(layer, 2); }),
              HasSubstr("not asked for"));
  EXPECT_THAT(error([](const v1::Layer& layer, uint64_t index) {
                v1::LayerResult result = KeepOrder(layer, index);
                result.mutable_visits()->RemoveLast();
                return result;
              }),
              HasSubstr("layers[0] is not a route: visits: 1 paths are missing"));
  service.forget_summary = true;
  EXPECT_THAT(error(KeepOrder), HasSubstr("the server answered 2 of 2 layers"));
}

TEST(OptimizerClient, DeadlineEndsTheCall) {
  FakeService service;
  service.answer = [](const v1::Layer& layer, uint64_t index) {
    absl::SleepFor(absl::Milliseconds(300));
    return KeepOrder(layer, index);
  };
  OptimizerClient client(service.InProcessChannel());
  CallOptions call;
  call.deadline = absl::Milliseconds(50);

  EXPECT_EQ(client.Optimize({}, Layers(1), call).status().code(),
            absl::StatusCode::kDeadlineExceeded);
}

TEST(OptimizerClient, UnreachableServerIsUnavailable) {
  FakeService service;
  const std::string address = service.address();
  service.Shutdown();
  OptimizerClient client(*ConnectTo({address}));

  EXPECT_EQ(client.Optimize({}, Layers(1)).status().code(), absl::StatusCode::kUnavailable);
}

TEST(CheckVisits, FindsEachFault) {
  v1::Layer layer = Layers(1)[0];
  v1::Layer plan;
  plan.mutable_plan()->add_paths()->mutable_open_path()->add_points(0);
  const auto error = [](const v1::Layer& asked, auto change) {
    v1::LayerResult result = KeepOrder(asked, 0);
    change(result);
    return std::string(CheckVisits(asked, result).message());
  };

  EXPECT_EQ(error(layer, [](v1::LayerResult&) {}), "");
  EXPECT_EQ(error(plan, [](v1::LayerResult&) {}), "");
  EXPECT_EQ(error(layer, [](v1::LayerResult& r) { r.mutable_visits(0)->set_island(1); }),
            "visits[0]: no such island");
  EXPECT_EQ(error(layer, [](v1::LayerResult& r) { r.mutable_visits(0)->clear_island(); }),
            "visits[0]: no such island");
  EXPECT_EQ(error(layer, [](v1::LayerResult& r) { r.mutable_visits(0)->set_contour(1); }),
            "visits[0]: no such contour");
  EXPECT_EQ(error(layer, [](v1::LayerResult& r) { r.mutable_visits(0)->set_vertex(3); }),
            "visits[0]: no such vertex");
  EXPECT_EQ(error(layer, [](v1::LayerResult& r) { r.mutable_visits(0)->set_reversed(true); }),
            "visits[0]: no such vertex");
  EXPECT_EQ(error(layer, [](v1::LayerResult& r) { r.mutable_visits(1)->set_raster(7); }),
            "visits[1]: no such raster");
  EXPECT_EQ(error(layer, [](v1::LayerResult& r) { r.mutable_visits(1)->clear_entry(); }),
            "visits[1]: no direction");
  EXPECT_EQ(error(layer, [](v1::LayerResult& r) { r.mutable_visits(1)->clear_path(); }),
            "visits[1]: no path");
  EXPECT_EQ(error(layer, [](v1::LayerResult& r) { *r.add_visits() = r.visits(0); }),
            "visits[2]: a path visited twice");
  EXPECT_EQ(error(plan, [](v1::LayerResult& r) { r.mutable_visits(0)->set_plan_path(1); }),
            "visits[0]: no such path");
}

TEST(ParseAddresses, TakesNamesAndNumbers) {
  EXPECT_THAT(*ParseAddresses("farm-1:50051"), ElementsAre("farm-1:50051"));
  EXPECT_THAT(*ParseAddresses("10.0.0.1:1,[::1]:65535"), ElementsAre("10.0.0.1:1", "[::1]:65535"));
}

TEST(ParseAddresses, RefusesTheRest) {
  for (const char* text : {"", "farm", ":50051", "farm:", "farm:0", "farm:65536", "farm:http",
                           "::1:50051", "a:1,", "a:1,,b:2", "http://a:1", "a b:1", "[::1]"}) {
    EXPECT_EQ(ParseAddresses(text).status().code(), absl::StatusCode::kInvalidArgument) << text;
  }
}

// Not in a system without /etc/hosts, such as a bare debootstrap makes.
bool KnowsLocalhost() {
  addrinfo* found = nullptr;
  const bool known = getaddrinfo("localhost", nullptr, nullptr, &found) == 0;
  if (known) freeaddrinfo(found);
  return known;
}

TEST(ConnectTo, SpreadsCallsOverAllAddressesThatAnswer) {
  if (!KnowsLocalhost()) GTEST_SKIP() << "this system does not know localhost";
  FakeService one, two, dead;
  dead.Shutdown();
  const std::string second = "localhost" + two.address().substr(two.address().find(':'));
  OptimizerClient client(*ConnectTo({dead.address(), one.address(), second}));

  // Subchannels connect one after another: until both are there, calls go to the first.
  for (int i = 0; i < 100 && (one.messages == 0 || two.messages == 0); ++i) {
    EXPECT_TRUE(client.Optimize({}, Layers(1)).ok());
    absl::SleepFor(absl::Milliseconds(5));
  }

  EXPECT_GT(one.messages, 0);
  EXPECT_GT(two.messages, 0);
}

TEST(ConnectTo, NamesThatNobodyKnowsAreUnavailable) {
  EXPECT_EQ(ConnectTo({"no.such.host.invalid:1", "nor.this.invalid:1"}).status().code(),
            absl::StatusCode::kUnavailable);
}

}  // namespace
}  // namespace traverse

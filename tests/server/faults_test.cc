// Bad input and jobs over the limits: what is refused, and how.

#include <gmock/gmock.h>
#include <google/protobuf/text_format.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"
#include "tests/server/support/service_fixture.h"

namespace traverse::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(BadInput, NamesTheLayerInTheWholeJob) {
  TestService service;
  v1::OptimizeBatchRequest request = MakeBatch(4);
  request.mutable_layers(3)->mutable_islands(0)->mutable_contours(0)->set_points(
      4, std::numeric_limits<double>::quiet_NaN());

  for (const Answer& answer : {service.Batch(request), service.Stream(request, 1),
                               service.Stream(request, 3), service.Stream(request, 10)}) {
    EXPECT_EQ(answer.status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
    EXPECT_EQ(answer.status.error_message(),
              "layers[3].islands[0].contours[0].points[2].x: not finite");
    EXPECT_FALSE(answer.summary.has_value());
  }
}

TEST(BadInput, BatchIsRefusedBeforeAnyWork) {
  TestService service;
  v1::OptimizeBatchRequest request = MakeBatch(100);
  request.mutable_layers(99)->set_z_mm(std::numeric_limits<double>::infinity());

  const Answer answer = service.Batch(request);

  EXPECT_EQ(answer.status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_TRUE(answer.layers.empty());
}

TEST(BadInput, HugeCoordinatesAndOptions) {
  TestService service;
  v1::OptimizeBatchRequest request = MakeBatch(1);
  request.mutable_layers(0)->mutable_islands(1)->mutable_rasters(0)->set_points(3, 1e300);
  EXPECT_THAT(service.Batch(request).status.error_message(),
              StartsWith("layers[0].islands[1].rasters[0].points[1].y: "));

  request = MakeBatch(1, "no such strategy");
  const Answer unknown = service.Batch(request);
  EXPECT_EQ(unknown.status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_THAT(unknown.status.error_message(), StartsWith("options.strategy.name: "));
}

TEST(BadInput, OptionsComeFirst) {
  TestService service;
  grpc::ClientContext context;
  const auto stream = service.stub().Optimize(&context);
  v1::OptimizeRequest message;
  message.mutable_options()->mutable_strategy()->set_name("none");
  stream->Write(message);
  stream->Write(message);
  stream->WritesDone();
  v1::OptimizeResponse response;
  while (stream->Read(&response)) {
  }

  const grpc::Status status = stream->Finish();

  EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_THAT(status.error_message(), StartsWith("options: "));
}

TEST(BadInput, BytesThatAreNoMessageAreTheCallersFault) {
  TestService service;
  for (const char* method : {"OptimizeBatch", "Optimize", "ListStrategies"}) {
    for (const std::string& bytes :
         {std::string("garbage"), std::string(100, '\xff'), std::string("\x0a\x05zz", 4)}) {
      const grpc::Status status = service.Raw(method, bytes);
      EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT)
          << method << ": " << status.error_message();
      EXPECT_THAT(status.error_message(), HasSubstr("not a valid traverse.v1."));
    }
  }
}

TEST(BadInput, DeepPlanIsAnError) {
  TestService service;
  v1::OptimizeBatchRequest request = MakeBatch(0);
  v1::Plan& plan = *request.add_layers()->mutable_plan();
  for (uint32_t i = 0; i < 10'000; ++i) plan.add_nodes()->mutable_any_order()->add_children(i + 1);
  plan.add_nodes()->mutable_in_order();

  const Answer answer = service.Batch(request);

  EXPECT_EQ(answer.status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_THAT(answer.status.error_message(),
              StartsWith("layers[0].plan.nodes[99].any_order.children[0]: "));
}

// The fields that a status says are at fault.
std::vector<std::string> FaultyFields(const grpc::Status& status) {
  google::rpc::Status details;
  std::vector<std::string> fields;
  if (!details.ParseFromString(status.error_details())) return fields;
  for (const google::protobuf::Any& any : details.details()) {
    google::rpc::BadRequest faults;
    if (!any.UnpackTo(&faults)) continue;
    for (const auto& fault : faults.field_violations()) fields.push_back(fault.field());
  }
  return fields;
}

// Half a character in a status keeps clients from reading it; a colon in a name ends no field.
TEST(BadInput, TextOfCallersNeverSpoilsTheFaults) {
  TestService service;
  v1::OptimizeBatchRequest request = MakeBatch(1, "greedy");
  v1::Strategy& strategy = *request.mutable_options()->mutable_strategy();
  std::string accents(63, 'a');
  while (accents.size() < 150) accents += "\xc3\xa9";
  (*strategy.mutable_options())["pure"] = accents;

  EXPECT_THAT(FaultyFields(service.Batch(request).status),
              ::testing::ElementsAre("options.strategy.options[\"pure\"]"));

  strategy.clear_options();
  (*strategy.mutable_options())["pure: a"] = "1";
  EXPECT_THAT(FaultyFields(service.Batch(request).status),
              ::testing::ElementsAre("options.strategy.options[\"pure: a\"]"));

  strategy.clear_options();
  strategy.set_name(accents);
  const grpc::Status status = service.Batch(request).status;
  EXPECT_THAT(FaultyFields(status), ::testing::ElementsAre("options.strategy.name"));
  EXPECT_THAT(status.error_message(), HasSubstr("aaa...\" has 151 bytes, more than 64"));
}

TEST(BadInput, AllFaultsOfARequestAreToldAtOnce) {
  TestService service;
  v1::OptimizeBatchRequest request = MakeBatch(3);
  request.mutable_options()->mutable_strategy()->set_name("none such");
  request.mutable_options()->set_idle_speed_mm_s(0);
  request.mutable_layers(0)->mutable_islands(0)->mutable_contours(0)->add_points(1);
  request.mutable_layers(0)->mutable_islands(1)->mutable_rasters(0)->clear_points();
  request.mutable_layers(2)->set_z_mm(std::numeric_limits<double>::infinity());

  const Answer answer = service.Batch(request);

  EXPECT_EQ(answer.status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_THAT(FaultyFields(answer.status),
              ::testing::ElementsAre("options.strategy.name", "options.idle_speed_mm_s",
                                     "layers[0].islands[0].contours[0].points",
                                     "layers[0].islands[1].rasters[0].points", "layers[2].z_mm"));
}

TEST(BadInput, TwentyFaultsAreEnough) {
  TestService service;
  v1::OptimizeBatchRequest request = MakeBatch(50);
  for (v1::Layer& layer : *request.mutable_layers()) {
    layer.mutable_islands(0)->mutable_contours(0)->add_points(1);
  }
  EXPECT_EQ(FaultyFields(service.Batch(request).status).size(), 20u);
}

TEST(ValidateOnly, ChecksAndDoesNothing) {
  TestService service;
  v1::OptimizeBatchRequest request = MakeBatch(100);
  request.mutable_options()->set_validate_only(true);

  for (const Answer& answer : {service.Batch(request), service.Stream(request)}) {
    EXPECT_TRUE(answer.status.ok()) << answer.status.error_message();
    EXPECT_TRUE(answer.layers.empty());
    EXPECT_FALSE(answer.summary.has_value());
  }
  request.mutable_layers(7)->mutable_islands(0)->mutable_contours(0)->clear_points();
  EXPECT_THAT(service.Batch(request).status.error_message(), StartsWith("layers[7]"));
  EXPECT_EQ(service.server().core().queue_layers, 0);
  EXPECT_EQ(service.server().core().admission.held_bytes(), 0);
}

TEST(JobId, IsInTheInitialMetadata) {
  TestService service;
  for (const std::string id : {"plate 7", "", "\xc3\xa9"}) {
    grpc::ClientContext context;
    v1::OptimizeBatchRequest request = MakeBatch(1);
    request.mutable_options()->set_job_id(id);
    const auto reader = service.stub().OptimizeBatch(&context, request);
    v1::OptimizeBatchResponse response;
    while (reader->Read(&response)) {
    }
    ASSERT_TRUE(reader->Finish().ok());
    const auto& metadata = context.GetServerInitialMetadata();
    const auto found = metadata.find("job_id");
    ASSERT_NE(found, metadata.end());
    const std::string told(found->second.data(), found->second.size());
    const std::string summary = response.summary().job_id();
    EXPECT_EQ(told, id.empty() ? summary : id == "plate 7" ? "plate%207" : "%C3%A9");
  }
}

TEST(BadInput, VeryLongMessagesOfOursAreCut) {
  TestService service;
  const Answer answer = service.Batch(MakeBatch(1, std::string(100'000, '"')));

  EXPECT_EQ(answer.status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_THAT(answer.status.error_message(), StartsWith("options.strategy.name: \"\"\""));
}

TEST(Limits, JobsOverTheLimitsAreRefusedWithoutAdviceToRetry) {
  TestService service([](ServerOptions& options) {
    options.service.limits.max_points_per_layer = 100;
    options.service.limits.max_layers_per_message = 50;
    options.service.limits.max_layers_per_job = 60;
    options.service.limits.max_points_per_job = 1000;
  });
  v1::OptimizeBatchRequest large_layer = MakeBatch(1);
  *large_layer.add_layers() = MakeLayer(2, 20);

  const Answer layer = service.Batch(large_layer);
  const Answer message = service.Batch(MakeBatch(51));
  const Answer layers = service.Stream(MakeBatch(61));
  v1::OptimizeBatchRequest many_points = MakeBatch(0);
  for (uint64_t i = 0; i < 20; ++i) *many_points.add_layers() = MakeLayer(i, 10);
  const Answer points = service.Batch(many_points);

  EXPECT_THAT(layer.status.error_message(), StartsWith("layers[1]: 120 points, more than"));
  EXPECT_THAT(message.status.error_message(), StartsWith("layers: 51 layers in a message"));
  EXPECT_THAT(layers.status.error_message(), StartsWith("layers: 61 layers, more than"));
  EXPECT_THAT(points.status.error_message(), StartsWith("layers[16]: 1020 points up to here"));
  for (const Answer& answer : {layer, message, layers, points}) {
    EXPECT_EQ(answer.status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
    EXPECT_FALSE(RetryDelay(answer.status).has_value());
  }
}

TEST(Limits, EmptyPartsAreLimitedToo) {
  TestService service(
      [](ServerOptions& options) { options.service.limits.max_points_per_layer = 100; });
  v1::OptimizeBatchRequest request = MakeBatch(1);
  for (int i = 0; i < 1000; ++i) request.mutable_layers(0)->add_islands();

  EXPECT_EQ(service.Batch(request).status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
}

TEST(BadInput, ABatchWithoutAMessageIsTheCallersFault) {
  TestService service;
  grpc::GenericStub stub(service.shared_channel());
  grpc::CompletionQueue queue;
  grpc::ClientContext context;
  const auto call =
      stub.PrepareCall(&context, "/traverse.v1.RouteOptimizerService/OptimizeBatch", &queue);
  void* tag = nullptr;
  bool ok = false;
  call->StartCall(nullptr);
  queue.Next(&tag, &ok);
  call->WritesDone(nullptr);
  queue.Next(&tag, &ok);
  grpc::Status status;
  call->Finish(&status, nullptr);
  queue.Next(&tag, &ok);

  EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(status.error_message(), "the call ended without a message");
}

}  // namespace
}  // namespace traverse::testing

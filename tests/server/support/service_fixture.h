// A service over an in-process channel, and what its answers came to.

#ifndef TRAVERSE_TESTS_SERVER_SUPPORT_SERVICE_FIXTURE_H_
#define TRAVERSE_TESTS_SERVER_SUPPORT_SERVICE_FIXTURE_H_

#include <grpcpp/client_context.h>
#include <grpcpp/support/status.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/time/time.h"
#include "google/rpc/error_details.pb.h"
#include "server/server.h"
#include "traverse/v1/route_optimizer_service.grpc.pb.h"

namespace traverse::testing {

// What came back from a job.
struct Answer {
  std::vector<v1::LayerResult> layers;
  std::optional<v1::JobSummary> summary;
  grpc::Status status;
};

// The advice to try again of a refusal, or nothing.
std::optional<absl::Duration> RetryDelay(const grpc::Status& status);

// A layer of `islands` islands at different places, each one contour of `vertices` vertices and one
// raster. `id` is the layer's id.
v1::Layer MakeLayer(uint64_t id, int islands = 2, int vertices = 4);

// A batch of `layers` such layers.
v1::OptimizeBatchRequest MakeBatch(int layers, const std::string& strategy = "none");

// Runs jobs against one server.
class TestService {
 public:
  // Called in the same process; or through a socket, if `change` lets the server listen.
  explicit TestService(const std::function<void(ServerOptions&)>& change = {});

  Server& server() { return *server_; }
  v1::RouteOptimizerService::Stub& stub() { return *stub_; }
  grpc::Channel& channel() { return *channel_; }
  const std::shared_ptr<grpc::Channel>& shared_channel() { return channel_; }

  // Sends a whole job and reads all answers.
  Answer Batch(const v1::OptimizeBatchRequest& request,
               std::optional<absl::Duration> deadline = std::nullopt);

  // The same job through the stream, `layers_per_message` layers in a message.
  Answer Stream(const v1::OptimizeBatchRequest& request, int layers_per_message = 1);

  // Sends raw bytes to a method of the service and returns the status.
  grpc::Status Raw(const std::string& method, const std::string& bytes);

  // Waits until `condition` holds, for 5 s at most. Returns whether it does.
  static bool Eventually(const std::function<bool()>& condition);

 private:
  std::unique_ptr<Server> server_;
  std::shared_ptr<grpc::Channel> channel_;
  std::unique_ptr<v1::RouteOptimizerService::Stub> stub_;
};

}  // namespace traverse::testing

#endif  // TRAVERSE_TESTS_SERVER_SUPPORT_SERVICE_FIXTURE_H_

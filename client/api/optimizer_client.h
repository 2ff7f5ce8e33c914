// The client's end of the service: a job goes up and its answers come back on one stream.
//
//   absl::StatusOr<std::shared_ptr<grpc::Channel>> channel = ConnectTo({"farm-1:50051"});
//   OptimizerClient client(*channel);
//   absl::StatusOr<JobResult> result = client.Optimize(options, layers, {.deadline =
//   absl::Seconds(30)});
//
// Errors are the service's own statuses (route_optimizer_service.proto): InvalidArgument with a
// field path, ResourceExhausted, Unavailable and so on; DeadlineExceeded; Internal for answers that
// are no answers.

#ifndef TRAVERSE_CLIENT_API_OPTIMIZER_CLIENT_H_
#define TRAVERSE_CLIENT_API_OPTIMIZER_CLIENT_H_

#include <grpcpp/channel.h>

#include <functional>
#include <memory>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "absl/types/span.h"
#include "client/api/job_result.h"
#include "traverse/v1/options.pb.h"
#include "traverse/v1/route_optimizer_service.grpc.pb.h"

namespace traverse {

// How one call is made.
struct CallOptions {
  // The answer is due within this time; the service sends the best routes it has before it.
  absl::Duration deadline = absl::InfiniteDuration();

  // Called with each layer's answer as it comes, on the calling thread. May be empty.
  std::function<void(const v1::LayerResult&)> on_layer;
};

// Thread-safe: calls may overlap.
class OptimizerClient {
 public:
  explicit OptimizerClient(std::shared_ptr<grpc::Channel> channel);

  // Sends `layers` in build order on one stream while answers come back: neither side holds more
  // than its flow control window of what the other has not read. Of open paths the ends alone are
  // sent, for no other point matters to a route. Every answer was checked by CheckVisits.
  absl::StatusOr<JobResult> Optimize(const v1::JobOptions& options,
                                     absl::Span<const v1::Layer> layers,
                                     const CallOptions& call = {});

  // The server's strategies.
  absl::StatusOr<v1::ListStrategiesResponse> ListStrategies(
      absl::Duration deadline = absl::InfiniteDuration());

 private:
  std::unique_ptr<v1::RouteOptimizerService::Stub> stub_;
};

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_API_OPTIMIZER_CLIENT_H_

// The client of the service: sends a job and receives its answers on one stream.
//
//   absl::StatusOr<std::shared_ptr<grpc::Channel>> channel = ConnectTo({"farm-1:50051"});
//   OptimizerClient client(*channel);
//   absl::StatusOr<JobResult> result = client.Optimize(options, layers, {.deadline =
//   absl::Seconds(30)});
//
// Errors are the service's own statuses (route_optimizer_service.proto) with their details as
// payloads: InvalidArgument with a field path, ResourceExhausted, Unavailable and so on;
// DeadlineExceeded; Internal for invalid answers.

#ifndef TRAVERSE_CLIENT_API_OPTIMIZER_CLIENT_H_
#define TRAVERSE_CLIENT_API_OPTIMIZER_CLIENT_H_

#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>

#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "absl/types/span.h"
#include "client/api/job_result.h"
#include "traverse/v1/options.pb.h"
#include "traverse/v1/route_optimizer_service.grpc.pb.h"

namespace traverse {

// How often and when to resume a job whose call was lost: after UNAVAILABLE and other signs
// of a lost connection, and after RESOURCE_EXHAUSTED with the server's advice when to come
// back.
struct RetryPolicy {
  int max_attempts = 5;  // in a row that brought no layer; 1: never try again
  int max_refusals =
      20;  // the same if the last attempt was refused: a busy server is worth waiting for
  absl::Duration first_delay = absl::Milliseconds(100);  // doubles with each attempt
  absl::Duration max_delay = absl::Seconds(10);          // the server's advice may be longer
};

// How to do one job.
struct CallOptions {
  // Time for the whole answer. The service sends its best routes before it is over.
  absl::Duration deadline = absl::InfiniteDuration();

  RetryPolicy retry = {};

  // When stop is requested, the call ends within milliseconds with Cancelled.
  std::stop_token cancel = {};

  // Answers that are known, by layer; empty if none is. Only the other layers are asked for.
  absl::Span<const std::optional<v1::LayerResult>> known = {};

  // Called with each layer's answer when it arrives, on the calling thread. May be empty.
  std::function<void(const v1::LayerResult&)> on_layer = {};
};

// Thread-safe: calls may overlap.
class OptimizerClient {
 public:
  // If `token` is not empty, each call carries it as a bearer token. Others can read it on the way
  // unless the channel is encrypted.
  explicit OptimizerClient(std::shared_ptr<grpc::Channel> channel, std::string token = "");

  // Sends `layers` in build order on one stream while answers come back. Neither side holds more
  // unread data than its flow control window. Of open paths only the ends are sent, because no
  // other point matters to a route. Every answer has passed CheckVisits.
  //
  // If the call is lost, resumes it as `call.retry` says, on another address if there is one, for
  // the layers without an answer. The given order of the first of these is then measured from where
  // the route ended.
  absl::StatusOr<JobResult> Optimize(const v1::JobOptions& options,
                                     absl::Span<const v1::Layer> layers,
                                     const CallOptions& call = {});

  // Returns the server's strategies. When stop is requested, it ends within milliseconds with
  // Cancelled.
  absl::StatusOr<v1::ListStrategiesResponse> ListStrategies(
      absl::Duration deadline = absl::InfiniteDuration(), const std::stop_token& cancel = {});

 private:
  void Authorize(grpc::ClientContext& context) const;

  std::unique_ptr<v1::RouteOptimizerService::Stub> stub_;
  const std::string token_;
};

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_API_OPTIMIZER_CLIENT_H_

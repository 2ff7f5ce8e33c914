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
#include <grpcpp/client_context.h>

#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "absl/types/span.h"
#include "client/api/job_result.h"
#include "traverse/v1/options.pb.h"
#include "traverse/v1/route_optimizer_service.grpc.pb.h"

namespace traverse {

// How often and when a job whose call broke off is taken up again: after UNAVAILABLE and the other
// signs of a lost connection, and after RESOURCE_EXHAUSTED with the server's advice when to come
// back.
struct RetryPolicy {
  int max_attempts = 5;  // in a row that brought no layer; 1: never again
  int max_refusals =
      20;  // the same where the last of them was refused: a busy server is worth waiting for
  absl::Duration first_delay = absl::Milliseconds(100);  // doubles with each attempt
  absl::Duration max_delay = absl::Seconds(10);          // the server's advice may be longer
};

// How one job is done.
struct CallOptions {
  // The answer is due within this time; the service sends the best routes it has before it.
  absl::Duration deadline = absl::InfiniteDuration();

  RetryPolicy retry = {};

  // Asked to stop, the call ends within milliseconds with Cancelled.
  std::stop_token cancel = {};

  // Called with each layer's answer as it comes, on the calling thread. May be empty.
  std::function<void(const v1::LayerResult&)> on_layer = {};
};

// Thread-safe: calls may overlap.
class OptimizerClient {
 public:
  // `token`, if not empty, goes with each call as a bearer token. It can be read on the way unless
  // the channel is encrypted.
  explicit OptimizerClient(std::shared_ptr<grpc::Channel> channel, std::string token = "");

  // Sends `layers` in build order on one stream while answers come back: neither side holds more
  // than its flow control window of what the other has not read. Of open paths the ends alone are
  // sent, for no other point matters to a route. Every answer was checked by CheckVisits.
  //
  // A call that breaks off is taken up again as `call.retry` says, on another address if there is
  // one, for the layers that have not come back. The given order of the first of these is then
  // measured from where the route left off.
  absl::StatusOr<JobResult> Optimize(const v1::JobOptions& options,
                                     absl::Span<const v1::Layer> layers,
                                     const CallOptions& call = {});

  // The server's strategies.
  absl::StatusOr<v1::ListStrategiesResponse> ListStrategies(
      absl::Duration deadline = absl::InfiniteDuration());

 private:
  void Authorize(grpc::ClientContext& context) const;

  std::unique_ptr<v1::RouteOptimizerService::Stub> stub_;
  const std::string token_;
};

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_API_OPTIMIZER_CLIENT_H_

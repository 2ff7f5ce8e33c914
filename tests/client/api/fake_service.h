// A service that answers as a test wants it, for tests of the client alone.

#ifndef TRAVERSE_TESTS_CLIENT_API_FAKE_SERVICE_H_
#define TRAVERSE_TESTS_CLIENT_API_FAKE_SERVICE_H_

#include <grpcpp/server.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "traverse/v1/route_optimizer_service.grpc.pb.h"

namespace traverse::testing {

// The answer that keeps the order given: contours at their first vertex, open paths forward.
// Lengths are 1 mm a visit.
v1::LayerResult KeepOrder(const v1::Layer& layer, uint64_t index);

class FakeService : public v1::RouteOptimizerService::Service {
 public:
  FakeService();

  // A channel to this service, in the process or through a port of the loopback interface.
  std::shared_ptr<grpc::Channel> InProcessChannel();
  std::string address() const;

  // Ends the server; the port is free again.
  void Shutdown() { server_->Shutdown(); }

  // What the service does with each layer; by default KeepOrder. Layers are answered as they come.
  std::function<v1::LayerResult(const v1::Layer&, uint64_t index)> answer = KeepOrder;

  // Ends the call with this status, before the summary, once so many layers were answered.
  grpc::Status status;
  uint64_t layers_before_status = 0;

  // Called at the beginning of each call.
  std::function<void()> on_call = [] {};

  // True: the summary is left out.
  bool forget_summary = false;

  // True: all layers are read before the first answer.
  bool read_all_first = false;

  // What the last call sent.
  v1::JobOptions options;
  std::vector<v1::Layer> layers;
  int messages = 0;

  grpc::Status Optimize(
      grpc::ServerContext* context,
      grpc::ServerReaderWriter<v1::OptimizeResponse, v1::OptimizeRequest>* stream) override;

  grpc::Status ListStrategies(grpc::ServerContext* context,
                              const v1::ListStrategiesRequest* request,
                              v1::ListStrategiesResponse* response) override;

 private:
  int port_ = 0;
  std::unique_ptr<grpc::Server> server_;
};

}  // namespace traverse::testing

#endif  // TRAVERSE_TESTS_CLIENT_API_FAKE_SERVICE_H_

#include "tests/client/api/fake_service.h"

#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server_builder.h>
#include <grpcpp/support/channel_arguments.h>

#include <utility>

#include "absl/strings/str_format.h"

namespace traverse::testing {

v1::LayerResult KeepOrder(const v1::Layer& layer, uint64_t index) {
  v1::LayerResult result;
  result.set_index(index);
  result.set_id(layer.id());
  result.set_strategy("none");
  result.set_stop_reason(v1::STOP_REASON_LOCAL_OPTIMUM);
  for (int i = 0; i < layer.islands_size(); ++i) {
    for (int c = 0; c < layer.islands(i).contours_size(); ++c) {
      v1::Visit& visit = *result.add_visits();
      visit.set_island(static_cast<uint32_t>(i));
      visit.set_contour(static_cast<uint32_t>(c));
      visit.set_vertex(0);
    }
    for (int r = 0; r < layer.islands(i).rasters_size(); ++r) {
      v1::Visit& visit = *result.add_visits();
      visit.set_island(static_cast<uint32_t>(i));
      visit.set_raster(static_cast<uint32_t>(r));
      visit.set_reversed(false);
    }
  }
  for (int p = 0; p < layer.plan().paths_size(); ++p) {
    v1::Visit& visit = *result.add_visits();
    visit.set_plan_path(static_cast<uint32_t>(p));
    if (layer.plan().paths(p).has_contour()) {
      visit.set_vertex(0);
    } else {
      visit.set_reversed(false);
    }
  }
  result.mutable_travel()->set_total_mm(result.visits_size());
  result.mutable_given()->set_total_mm(result.visits_size());
  return result;
}

FakeService::FakeService() {
  grpc::ServerBuilder builder;
  builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port_);
  builder.RegisterService(this);
  builder.SetMaxReceiveMessageSize(-1);
  server_ = builder.BuildAndStart();
}

std::shared_ptr<grpc::Channel> FakeService::InProcessChannel() {
  return server_->InProcessChannel({});
}

std::string FakeService::address() const { return absl::StrFormat("127.0.0.1:%d", port_); }

grpc::Status FakeService::Optimize(
    grpc::ServerContext*,
    grpc::ServerReaderWriter<v1::OptimizeResponse, v1::OptimizeRequest>* stream) {
  on_call();
  layers.clear();
  messages = 0;
  uint64_t answered = 0;
  const auto answer_pending = [&] {
    for (; answered < layers.size(); ++answered) {
      if (!status.ok() && answered == layers_before_status) return false;
      v1::OptimizeResponse response;
      *response.mutable_layer() = answer(layers[answered], answered);
      if (!stream->Write(response)) return false;
    }
    return true;
  };

  v1::OptimizeRequest request;
  while (stream->Read(&request)) {
    if (messages++ == 0) options = request.options();
    for (v1::Layer& layer : *request.mutable_layers()) layers.push_back(std::move(layer));
    if (!read_all_first && !answer_pending()) return status;
  }
  answer_pending();
  if (!status.ok()) return status;
  if (forget_summary) return grpc::Status::OK;
  v1::OptimizeResponse response;
  response.mutable_summary()->set_strategy("none");
  response.mutable_summary()->set_layers(answered);
  stream->Write(response);
  return grpc::Status::OK;
}

grpc::Status FakeService::ListStrategies(grpc::ServerContext*, const v1::ListStrategiesRequest*,
                                         v1::ListStrategiesResponse* response) {
  response->add_strategies()->set_name("none");
  response->set_default_strategy("none");
  return status;
}

}  // namespace traverse::testing

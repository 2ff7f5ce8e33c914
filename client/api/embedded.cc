#include "client/api/embedded.h"

#include <grpcpp/support/channel_arguments.h>

#include <cassert>
#include <utility>

#include "server/server.h"

namespace traverse {
namespace {

class Embedded : public EmbeddedService {
 public:
  explicit Embedded(std::unique_ptr<Server> server) : server_(std::move(server)) {}

  std::shared_ptr<grpc::Channel> channel() override {
    grpc::ChannelArguments arguments;
    arguments.SetMaxReceiveMessageSize(-1);  // an answer is as large as the layer that was sent
    return server_->InProcessChannel(arguments);
  }

 private:
  const std::unique_ptr<Server> server_;
};

}  // namespace

absl::StatusOr<std::unique_ptr<EmbeddedService>> EmbeddedService::Start(int threads) {
  assert(threads >= 1);
  absl::StatusOr<std::unique_ptr<Server>> server = Server::Start(ServerOptions::Embedded(threads));
  if (!server.ok()) return server.status();
  return std::make_unique<Embedded>(*std::move(server));
}

}  // namespace traverse

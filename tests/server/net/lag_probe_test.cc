#include "server/net/lag_probe.h"

#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/server_builder.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <functional>
#include <memory>

#include "tests/server/support/service_fixture.h"

namespace traverse {
namespace {

using testing::TestService;

// A server without a port.
class OwnServer {
 public:
  explicit OwnServer(bool with_health) {
    grpc::EnableDefaultHealthCheckService(with_health);
    grpc::ServerBuilder builder;
    builder.RegisterCallbackGenericService(&generic_);
    server_ = builder.BuildAndStart();
    grpc::EnableDefaultHealthCheckService(true);
  }
  ~OwnServer() { server_->Shutdown(); }

  grpc::Server& get() { return *server_; }

 private:
  grpc::CallbackGenericService generic_;
  std::unique_ptr<grpc::Server> server_;
};

TEST(LagProbe, TellsHowLongACallTakes) {
  OwnServer server(/*with_health=*/true);
  LagProbe probe(server.get());
  for (int calls = 0; calls < 3; ++calls) {
    EXPECT_TRUE(TestService::Eventually([&] { return probe.Look().count() > 0; }));
  }
}

TEST(LagProbe, IsOfNoUseAndDoesNoHarmWhereNobodyAnswers) {
  OwnServer server(/*with_health=*/false);
  LagProbe probe(server.get());
  for (int looks = 0; looks < 20; ++looks) {
    probe.Look();
    usleep(2000);
  }
}

}  // namespace
}  // namespace traverse

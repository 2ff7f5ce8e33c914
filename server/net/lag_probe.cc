#include "server/net/lag_probe.h"

#include <grpcpp/create_channel_posix.h>
#include <grpcpp/server_posix.h>
#include <sys/socket.h>

namespace traverse {

LagProbe::~LagProbe() {
  if (call_ == nullptr) return;
  call_->context.TryCancel();
  MutexLock lock(mutex_);
  while (under_way_) done_.Wait(mutex_);
}

std::chrono::duration<double> LagProbe::Look() {
  Clock::duration lag{};
  {
    MutexLock lock(mutex_);
    if (under_way_) return Clock::now() - call_->begun;
    // The connection may have reached its greatest age.
    if (failed_) stub_.reset();
    if (call_ != nullptr && !failed_) lag = ended_ - call_->begun;
  }
  if (stub_ != nullptr || Connect()) Send();
  return lag;
}

// False for want of files: the next time there may be some.
bool LagProbe::Connect() {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends) != 0) return false;
  stub_ = std::make_unique<grpc::GenericStub>(grpc::CreateInsecureChannelFromFd("self", ends[0]));
  grpc::AddInsecureChannelFromFd(&server_, ends[1]);
  return true;
}

void LagProbe::Send() {
  {
    MutexLock lock(mutex_);
    under_way_ = true;
  }
  call_ = std::make_unique<Call>();
  call_->request = grpc::ByteBuffer(nullptr, 0);
  stub_->UnaryCall(&call_->context, "/grpc.health.v1.Health/Check", grpc::StubOptions(),
                   &call_->request, &call_->response, [this](const grpc::Status& status) {
                     MutexLock lock(mutex_);
                     under_way_ = false;
                     failed_ = !status.ok();
                     ended_ = Clock::now();
                     done_.NotifyAll();
                   });
}

}  // namespace traverse

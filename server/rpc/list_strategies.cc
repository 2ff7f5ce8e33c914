#include "server/rpc/list_strategies.h"

#include "absl/strings/str_cat.h"
#include "server/rpc/grpc_status.h"
#include "server/rpc/wire.h"
#include "server/translate/translate_result.h"

namespace traverse {
namespace {

// The request has no fields yet; a later version's may have some.
constexpr size_t kMaxRequestBytes = 4096;

}  // namespace

ListStrategiesReactor::ListStrategiesReactor(ServiceCore& core, const std::string& peer,
                                             const absl::Status& authorized)
    : core_(core), peer_(peer) {
  core_.OnCall(peer_);
  if (authorized.ok()) {
    StartRead(&request_);
  } else {
    End(authorized);
  }
}

ListStrategiesReactor::~ListStrategiesReactor() { core_.OnCallDone(peer_); }

absl::Status ListStrategiesReactor::Check(bool ok) const {
  if (!ok) return absl::CancelledError("the call ended without a message");
  if (request_.Length() > kMaxRequestBytes) {
    return absl::ResourceExhaustedError(absl::StrCat("the message has ", request_.Length(),
                                                     " bytes, more than ", kMaxRequestBytes));
  }
  v1::ListStrategiesRequest parsed;
  return ParseMessage(request_, parsed);
}

void ListStrategiesReactor::OnReadDone(bool ok) {
  if (absl::Status status = Check(ok); !status.ok()) return End(status);
  core_.metrics.CountRpc("ListStrategies", absl::StatusCode::kOk);
  response_ = ToByteBuffer(Serialize<v1::ListStrategiesResponse>(
      [](v1::ListStrategiesResponse& message) { ListStrategies(message); }));
  StartWriteAndFinish(&response_, grpc::WriteOptions(), grpc::Status::OK);
}

void ListStrategiesReactor::End(const absl::Status& status) {
  core_.metrics.CountRpc("ListStrategies", status.code());
  Finish(ToGrpcStatus(status));
}

}  // namespace traverse

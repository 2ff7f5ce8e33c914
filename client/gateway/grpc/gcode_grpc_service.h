// traverse.v1.GcodeService: files over gRPC.

#ifndef TRAVERSE_CLIENT_GATEWAY_GRPC_GCODE_GRPC_SERVICE_H_
#define TRAVERSE_CLIENT_GATEWAY_GRPC_GCODE_GRPC_SERVICE_H_

#include <string>

#include "absl/status/status.h"
#include "absl/time/time.h"
#include "client/gateway/core.h"
#include "client/gateway/grpc/live_calls.h"
#include "traverse/v1/gcode_service.grpc.pb.h"

namespace traverse::gateway {

// Thread-safe.
class GcodeGrpcService : public v1::GcodeService::CallbackService {
 public:
  // For the times see LiveCalls. `core` must outlive it.
  GcodeGrpcService(Core& core, absl::Duration idle_time, absl::Duration transfer_time)
      : core_(core), live_(idle_time, transfer_time) {}

  // Ends a call of `peer` (see PeerKey) that sends what is larger than any message may be. False if
  // there is none.
  bool EndOversizeCall(const std::string& peer) { return live_.EndOne(peer); }

  grpc::ServerBidiReactor<v1::RewriteRequest, v1::RewriteResponse>* Rewrite(
      grpc::CallbackServerContext* context) override;
  grpc::ServerReadReactor<v1::InspectRequest>* Inspect(grpc::CallbackServerContext* context,
                                                       v1::InspectResponse* response) override;
  grpc::ServerReadReactor<v1::VerifyRequest>* Verify(grpc::CallbackServerContext* context,
                                                     v1::VerifyResponse* response) override;
  grpc::ServerReadReactor<v1::CreateJobRequest>* CreateJob(
      grpc::CallbackServerContext* context, v1::CreateJobResponse* response) override;
  grpc::ServerUnaryReactor* GetJob(grpc::CallbackServerContext* context,
                                   const v1::GetJobRequest* request,
                                   v1::GetJobResponse* response) override;
  grpc::ServerWriteReactor<v1::WatchJobResponse>* WatchJob(
      grpc::CallbackServerContext* context, const v1::WatchJobRequest* request) override;
  grpc::ServerWriteReactor<v1::ReadJobResponse>* ReadJob(
      grpc::CallbackServerContext* context, const v1::ReadJobRequest* request) override;
  grpc::ServerUnaryReactor* CancelJob(grpc::CallbackServerContext* context,
                                      const v1::CancelJobRequest* request,
                                      v1::CancelJobResponse* response) override;

 private:
  Core& core_;
  LiveCalls live_;
};

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_GRPC_GCODE_GRPC_SERVICE_H_

#include "client/gateway/grpc/gcode_grpc_service.h"

#include <utility>

#include "absl/functional/function_ref.h"
#include "absl/strings/str_cat.h"
#include "client/gateway/api/rewrite_options.h"
#include "client/gateway/grpc/collect_reactor.h"
#include "client/gateway/grpc/job_reactors.h"
#include "client/gateway/grpc/rewrite_reactor.h"
#include "client/gateway/http/target.h"

namespace traverse::gateway {
namespace {

// A call of one message whose answer is at hand. Deletes itself.
class QuestionReactor : public grpc::ServerUnaryReactor {
 public:
  // `answer` makes the answer to a caller who may ask.
  using Answer = absl::FunctionRef<absl::Status(const std::string& caller)>;
  QuestionReactor(Core& core, LiveCalls& live, grpc::CallbackServerContext& context,
                  const std::string& method, Answer answer)
      : call_(core, live, context, method, Brings::kQuestion) {
    const absl::Status& may = call_.status();
    Finish(call_.End(may.ok() ? answer(call_.caller()) : may));
  }

  void OnDone() override { delete this; }

 private:
  FileCall call_;
};

absl::Status TakeInspect(const v1::InspectRequest& request, const FileCall& call,
                         Collected& collected) {
  if (request.has_data()) return call.Append(request.data(), collected.first);
  if (!request.has_name()) return absl::InvalidArgumentError("a message without data");
  if (!collected.name.empty() || collected.first != nullptr) {
    return absl::InvalidArgumentError("name: allowed only in the first message");
  }
  collected.name = request.name();
  const absl::Status status = CheckFileName(collected.name);
  return status.ok() ? status
                     : absl::InvalidArgumentError(absl::StrCat("name: ", status.message()));
}

absl::Status TakeVerify(const v1::VerifyRequest& request, const FileCall& call,
                        Collected& collected) {
  if (request.has_original()) return call.Append(request.original(), collected.first);
  if (request.has_optimised()) return call.Append(request.optimised(), collected.second);
  if (!request.has_options()) return absl::InvalidArgumentError("a message without data");
  if (collected.has_options || collected.first != nullptr || collected.second != nullptr) {
    return absl::InvalidArgumentError("options: in the first message alone");
  }
  collected.has_options = true;
  absl::StatusOr<std::optional<GivenPermissions>> permissions = PermissionsOf(request.options());
  if (permissions.ok()) collected.permissions = *permissions;
  return permissions.status();
}

}  // namespace

grpc::ServerBidiReactor<v1::RewriteRequest, v1::RewriteResponse>* GcodeGrpcService::Rewrite(
    grpc::CallbackServerContext* context) {
  return new RewriteReactor(core_, live_, *context);
}

grpc::ServerReadReactor<v1::InspectRequest>* GcodeGrpcService::Inspect(
    grpc::CallbackServerContext* context, v1::InspectResponse* response) {
  const auto check = [](const Collected& collected) -> absl::Status {
    if (collected.first == nullptr) return absl::InvalidArgumentError("data: the file is missing");
    return absl::OkStatus();
  };
  const auto work = [this, response](const Collected& collected, absl::Time finish_by,
                                     const std::stop_token& cancel) {
    FileRequest request;
    request.finish_by = finish_by;
    if (!collected.name.empty()) request.name = collected.name;
    absl::StatusOr<v1::InspectResponse> found =
        core_.worker->Inspect(*collected.first, request, cancel);
    if (found.ok()) *response = *std::move(found);
    return found.status();
  };
  return new CollectReactor<v1::InspectRequest>(core_, live_, *context, "Inspect",
                                                FileUse::kInspect, TakeInspect, check, work);
}

grpc::ServerReadReactor<v1::VerifyRequest>* GcodeGrpcService::Verify(
    grpc::CallbackServerContext* context, v1::VerifyResponse* response) {
  const auto check = [](const Collected& collected) -> absl::Status {
    if (collected.first == nullptr) return absl::InvalidArgumentError("original: missing");
    if (collected.second == nullptr) return absl::InvalidArgumentError("optimised: missing");
    return absl::OkStatus();
  };
  const auto work = [this, response](const Collected& collected, absl::Time finish_by,
                                     const std::stop_token& cancel) {
    absl::StatusOr<v1::VerifyResponse> found = core_.worker->Verify(
        *collected.first, *collected.second, collected.permissions, finish_by, cancel);
    if (found.ok()) *response = *std::move(found);
    return found.status();
  };
  return new CollectReactor<v1::VerifyRequest>(core_, live_, *context, "Verify", FileUse::kVerify,
                                               TakeVerify, check, work);
}

grpc::ServerReadReactor<v1::CreateJobRequest>* GcodeGrpcService::CreateJob(
    grpc::CallbackServerContext* context, v1::CreateJobResponse* response) {
  return new CreateJobReactor(core_, live_, *context, *response);
}

grpc::ServerUnaryReactor* GcodeGrpcService::GetJob(grpc::CallbackServerContext* context,
                                                   const v1::GetJobRequest* request,
                                                   v1::GetJobResponse* response) {
  const auto answer = [&](const std::string& caller) {
    const absl::StatusOr<std::shared_ptr<Job>> job = core_.jobs->Find(request->id(), caller);
    if (job.ok()) *response->mutable_job() = (*job)->Now();
    return job.status();
  };
  return new QuestionReactor(core_, live_, *context, "GetJob", answer);
}

grpc::ServerWriteReactor<v1::WatchJobResponse>* GcodeGrpcService::WatchJob(
    grpc::CallbackServerContext* context, const v1::WatchJobRequest* request) {
  return new WatchJobReactor(core_, live_, *context, *request);
}

grpc::ServerWriteReactor<v1::ReadJobResponse>* GcodeGrpcService::ReadJob(
    grpc::CallbackServerContext* context, const v1::ReadJobRequest* request) {
  return new ReadJobReactor(core_, live_, *context, *request);
}

grpc::ServerUnaryReactor* GcodeGrpcService::CancelJob(grpc::CallbackServerContext* context,
                                                      const v1::CancelJobRequest* request,
                                                      v1::CancelJobResponse*) {
  const auto answer = [&](const std::string& caller) {
    return core_.jobs->Cancel(request->id(), caller);
  };
  return new QuestionReactor(core_, live_, *context, "CancelJob", answer);
}

}  // namespace traverse::gateway

// A call that receives files in pieces and answers with one message.

#ifndef TRAVERSE_CLIENT_GATEWAY_GRPC_COLLECT_REACTOR_H_
#define TRAVERSE_CLIENT_GATEWAY_GRPC_COLLECT_REACTOR_H_

#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "absl/time/time.h"
#include "client/gateway/core.h"
#include "client/gateway/grpc/file_call.h"
#include "client/gateway/grpc/live_calls.h"
#include "client/gcode/verify/permissions.h"

namespace traverse::gateway {

// The received files.
struct Collected {
  std::string name;
  std::shared_ptr<SpoolFile> first;   // the file, or the original
  std::shared_ptr<SpoolFile> second;  // the optimised one
  bool has_options = false;
  std::optional<GivenPermissions> permissions;  // of Verify's options
};

// Deletes itself.
template <typename Request>
class CollectReactor : public grpc::ServerReadReactor<Request> {
 public:
  // Stores a message where it belongs. Errors are for the client.
  using Take = std::function<absl::Status(const Request&, const FileCall&, Collected&)>;
  // Whether everything has come. Errors are for the client.
  using Check = std::function<absl::Status(const Collected&)>;
  // Makes the answer by that time, unless the client leaves.
  using Work = std::function<absl::Status(const Collected&, absl::Time, const std::stop_token&)>;

  CollectReactor(Core& core, LiveCalls& live, grpc::CallbackServerContext& context,
                 const std::string& method, FileUse use, Take take, Check check, Work work)
      : core_(core),
        context_(context),
        call_(core, live, context, method),
        use_(use),
        take_(std::move(take)),
        check_(std::move(check)),
        work_(std::move(work)) {
    if (!call_.status().ok()) {
      End(call_.status());
      return;
    }
    Read();
  }

  void OnReadDone(bool ok) override {
    if (context_.IsCancelled()) return End(absl::CancelledError("cancelled"));
    if (!ok) return Submit();
    absl::Status status = call_.OnMessage(request_.ByteSizeLong());
    if (status.ok()) status = take_(request_, call_, collected_);
    if (!status.ok()) return End(status);
    Read();
  }

  void OnCancel() override { stop_.request_stop(); }

  void OnDone() override { delete this; }

 private:
  void Read() {
    call_.Waits();
    this->StartRead(&request_);
  }

  void Submit() {
    call_.Rests();
    call_.OnAllCame();
    if (absl::Status status = check_(collected_); !status.ok()) return End(status);
    std::vector<std::shared_ptr<const SpoolFile>> files = {collected_.first};
    if (collected_.second != nullptr) files.push_back(collected_.second);
    const absl::Time finish_by = call_.FinishBy();
    core_.Submit(
        call_.ticket(), std::move(files), {finish_by, stop_.get_token()},
        [this, finish_by](const absl::Status& may) {
          End(may.ok() ? work_(collected_, finish_by, stop_.get_token()) : may);
        },
        use_);
  }

  void End(const absl::Status& status) {
    collected_ = {};
    this->Finish(call_.End(status));
  }

  Core& core_;
  grpc::CallbackServerContext& context_;
  FileCall call_;
  const FileUse use_;
  const Take take_;
  const Check check_;
  const Work work_;
  Request request_;
  Collected collected_;
  std::stop_source stop_;
};

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_GRPC_COLLECT_REACTOR_H_

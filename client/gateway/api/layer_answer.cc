#include "client/gateway/api/layer_answer.h"

#include <utility>
#include <variant>

#include "absl/strings/str_cat.h"
#include "client/gateway/api/file_routes.h"
#include "client/gateway/api/service_problem.h"

namespace traverse::gateway {
namespace {

class Lines : public LayerAnswer {
 public:
  Lines(Spool& spool, std::string caller, std::shared_ptr<HttpReply> reply)
      : spool_(spool), caller_(std::move(caller)), reply_(std::move(reply)) {}

  absl::Status Add(const v1::OptimizeBatchResponse& message) override {
    if (!std::exchange(begun_, true)) Begin();
    std::string line = MessageJson(message) + "\n";
    if (behind_ == nullptr) {
      if (reply_->Write(line, /*optional=*/true)) return absl::OkStatus();
      absl::StatusOr<std::shared_ptr<SpoolFile>> file = spool_.NewFile(caller_);
      if (!file.ok()) return file.status();
      behind_ = *std::move(file);
    }
    if (absl::Status status = behind_->Append(line); !status.ok()) return status;
    if (reply_->Write(behind_, /*optional=*/true)) behind_ = nullptr;
    return absl::OkStatus();
  }

  void Finish(const absl::Status& status) override {
    if (!status.ok() && !begun_) return reply_->Send(ServiceProblem(status));
    if (!begun_) Begin();
    if (behind_ != nullptr) reply_->Write(std::move(behind_));
    if (!status.ok()) {
      const HttpResponse problem = ServiceProblem(status);
      std::string json = std::get<std::string>(problem.body);
      json.pop_back();  // the line break
      reply_->Write(absl::StrCat("{\"error\":", json, "}\n"));
    }
    reply_->End();
  }

 private:
  void Begin() {
    HttpResponse head;
    head.content_type = "application/x-ndjson";
    head.headers.emplace_back("Cache-Control", "no-store");
    head.headers.emplace_back("X-Accel-Buffering", "no");
    reply_->Begin(std::move(head));
  }

  Spool& spool_;
  const std::string caller_;
  const std::shared_ptr<HttpReply> reply_;
  bool begun_ = false;
  std::shared_ptr<SpoolFile> behind_;  // lines for a client who has not read those before
};

class Document : public LayerAnswer {
 public:
  Document(Spool& spool, std::string caller, std::shared_ptr<HttpReply> reply)
      : spool_(spool), caller_(std::move(caller)), reply_(std::move(reply)) {}

  absl::Status Add(const v1::OptimizeBatchResponse& message) override {
    const bool first = file_ == nullptr;
    if (first) {
      absl::StatusOr<std::shared_ptr<SpoolFile>> file = spool_.NewFile(caller_);
      if (!file.ok()) return file.status();
      file_ = *std::move(file);
    }
    return file_->Append(absl::StrCat(first ? "{\"results\":[\n" : ",\n", MessageJson(message)));
  }

  void Finish(const absl::Status& status) override {
    // There is a summary at least.
    const absl::Status end = status.ok() ? file_->Append("\n]}\n") : status;
    if (!end.ok()) return reply_->Send(ServiceProblem(end));
    HttpResponse response;
    response.content_type = "application/json";
    response.body = std::move(file_);
    reply_->Send(std::move(response));
  }

 private:
  Spool& spool_;
  const std::string caller_;
  const std::shared_ptr<HttpReply> reply_;
  std::shared_ptr<SpoolFile> file_;
};

}  // namespace

std::unique_ptr<LayerAnswer> AnswerInLines(Spool& spool, const std::string& caller,
                                           std::shared_ptr<HttpReply> reply) {
  return std::make_unique<Lines>(spool, caller, std::move(reply));
}

std::unique_ptr<LayerAnswer> AnswerAsDocument(Spool& spool, const std::string& caller,
                                              std::shared_ptr<HttpReply> reply) {
  return std::make_unique<Document>(spool, caller, std::move(reply));
}

}  // namespace traverse::gateway

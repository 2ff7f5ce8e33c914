#include "client/gateway/api/counting.h"

#include <atomic>
#include <memory>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"

namespace traverse::gateway {
namespace {

// Counts once, at the latest when it is destroyed.
class Count {
 public:
  Count(std::string route, GatewayMetrics& metrics)
      : route_(std::move(route)), metrics_(metrics), began_(absl::Now()) {}
  ~Count() { Once(400); }

  void Once(int status) {
    if (counted_.exchange(true)) return;
    metrics_.CountRequest(route_, absl::StrCat(status),
                          absl::ToDoubleSeconds(absl::Now() - began_));
  }

 private:
  const std::string route_;
  GatewayMetrics& metrics_;
  const absl::Time began_;
  std::atomic<bool> counted_ = false;
};

class CountingReply : public HttpReply {
 public:
  CountingReply(std::shared_ptr<HttpReply> reply, std::shared_ptr<Count> count)
      : reply_(std::move(reply)), count_(std::move(count)) {}
  ~CountingReply() override { count_->Once(499); }

  void Send(HttpResponse response) override {
    count_->Once(response.status);
    reply_->Send(std::move(response));
  }
  void Begin(HttpResponse head) override {
    status_ = head.status;
    reply_->Begin(std::move(head));
  }
  bool Write(HttpBody piece, bool optional) override {
    return reply_->Write(std::move(piece), optional);
  }
  void End() override {
    count_->Once(status_);
    reply_->End();
  }
  void OnGone(std::function<void()> on_gone) override {
    reply_->OnGone([count = count_, on_gone = std::move(on_gone)] {
      count->Once(499);
      on_gone();
    });
  }

 private:
  const std::shared_ptr<HttpReply> reply_;
  const std::shared_ptr<Count> count_;
  int status_ = 200;
};

class CountingSink : public BodySink {
 public:
  CountingSink(std::unique_ptr<BodySink> sink, std::shared_ptr<Count> count)
      : sink_(std::move(sink)), count_(std::move(count)) {}

  std::optional<HttpResponse> Take(std::string_view piece) override {
    std::optional<HttpResponse> refusal = sink_->Take(piece);
    if (refusal) count_->Once(refusal->status);
    return refusal;
  }
  void Done(std::shared_ptr<HttpReply> reply) override {
    sink_->Done(std::make_shared<CountingReply>(std::move(reply), std::move(count_)));
  }

 private:
  const std::unique_ptr<BodySink> sink_;
  std::shared_ptr<Count> count_;
};

}  // namespace

HttpDecision Counted(HttpDecision decision, const std::string& route, GatewayMetrics& metrics) {
  auto count = std::make_shared<Count>(route, metrics);
  if (const auto* response = std::get_if<HttpResponse>(&decision)) {
    count->Once(response->status);
    return decision;
  }
  return std::make_unique<CountingSink>(std::get<std::unique_ptr<BodySink>>(std::move(decision)),
                                        std::move(count));
}

}  // namespace traverse::gateway

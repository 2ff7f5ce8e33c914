#include "client/gateway/api/layer_routes.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <stop_token>
#include <utility>
#include <variant>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/time/clock.h"
#include "client/files/decompress.h"
#include "client/formats/message_json.h"
#include "client/gateway/api/answers.h"
#include "client/gateway/api/file_routes.h"
#include "client/gateway/api/layer_answer.h"
#include "client/gateway/api/parameters.h"
#include "client/gateway/api/service_problem.h"
#include "client/gateway/api/take_file.h"
#include "client/gateway/http/problem.h"
#include "client/gateway/work/guarded.h"
#include "server/jobs/retry_delay.h"

namespace traverse::gateway {
namespace {

// What is asked, and by whom.
struct LayerJob {
  TicketPtr ticket;
  std::shared_ptr<SpoolFile> file;
  std::string caller;
  std::string peer;
  bool as_document = false;
  absl::Time finish_by;
  ReplyPtr reply;
  std::stop_source stop;  // when the client has gone
};

absl::StatusOr<v1::OptimizeBatchRequest> ReadRequest(const SpoolFile& file, uint64_t max_bytes) {
  absl::StatusOr<std::string> json = file.ReadAll();
  if (!json.ok()) return json.status();
  const Compression compression = DetectCompression(*json);
  if (compression != Compression::kNone) json = Decompress(*json, compression, max_bytes);
  if (absl::IsResourceExhausted(json.status())) {
    return absl::OutOfRangeError(json.status().message());
  }
  if (!json.ok()) return json.status();
  v1::OptimizeBatchRequest request;
  if (absl::Status status = ReadMessageJson(*json, request); !status.ok()) return status;
  return request;
}

// What the gateway itself is short of is there again soon.
absl::Status WithPatience(const absl::Status& status) {
  constexpr absl::Duration kPatience = absl::Seconds(5);
  return absl::IsResourceExhausted(status) ? WithRetryDelay(status, kPatience) : status;
}

// Asks the service, and passes on what it answers. A client who sends the whole job waits for all
// of it, so that here, too, an answer is lost only with its servers.
absl::Status Ask(Core& core, const LayerJob& job, v1::OptimizeBatchRequest request,
                 LayerAnswer& answer, v1::JobSummary& summary) {
  const std::vector<v1::Layer> layers(std::make_move_iterator(request.mutable_layers()->begin()),
                                      std::make_move_iterator(request.mutable_layers()->end()));
  absl::Status added;
  std::stop_source stop = job.stop;
  CallOptions call;
  call.deadline = job.finish_by - absl::Now();
  call.retry.max_refusals = 1;  // the client hears when to come again
  call.cancel = stop.get_token();
  v1::OptimizeBatchResponse message;
  call.on_layer = [&](const v1::LayerResult& layer) {
    if (!added.ok()) return;
    added = Guarded([&] {  // the client's threads know nothing of memory that is short
      *message.mutable_layer() = layer;
      return answer.Add(message);
    });
    added = WithPatience(added);
    if (!added.ok()) stop.request_stop();
  };
  absl::StatusOr<JobResult> result = core.client->Optimize(request.options(), layers, call);
  if (!added.ok()) return added;
  if (!result.ok()) return result.status();
  summary = result->summary;
  *message.mutable_summary() = std::move(result->summary);
  return WithPatience(answer.Add(message));
}

void Record(Core& core, const LayerJob& job, const absl::Status& status,
            const v1::JobSummary& summary, absl::Duration took) {
  JobLog::Fields fields = {{"route", "/v1/optimize"},
                           {"caller", job.caller},
                           {"peer", job.peer},
                           {"job_id", summary.job_id()},
                           {"layers", absl::StrCat(summary.layers())},
                           {"bytes", absl::StrCat(job.file->size())},
                           {"seconds", absl::StrFormat("%.3f", absl::ToDoubleSeconds(took))},
                           {"code", absl::StatusCodeToString(status.code())}};
  if (!status.ok()) fields.emplace_back("message", std::string(status.message()));
  core.files.log->Event(status.ok() ? JobLog::Level::kInfo : JobLog::Level::kWarning, "layers",
                        fields);
}

// `may`: as of Core::Submit.
void Run(Core& core, const LayerJob& job, const absl::Status& may) {
  const absl::Time began = absl::Now();
  const std::unique_ptr<LayerAnswer> answer =
      job.as_document ? AnswerAsDocument(*core.spool, job.caller, job.reply)
                      : AnswerInLines(*core.spool, job.caller, job.reply);
  v1::JobSummary summary;
  const absl::Status status = Guarded([&]() -> absl::Status {
    if (!may.ok()) return WithPatience(may);
    if (began >= job.finish_by) return absl::DeadlineExceededError("the deadline has passed");
    if (job.stop.stop_requested()) return absl::CancelledError("the client has gone");
    absl::StatusOr<v1::OptimizeBatchRequest> request =
        ReadRequest(*job.file, core.options.max_file_bytes);
    if (!request.ok()) return request.status();
    return Ask(core, job, *std::move(request), *answer, summary);
  });
  Record(core, job, status, summary, absl::Now() - began);
  // Without memory for the end the connection ends without one.
  Guarded([&] {
    answer->Finish(status);
    return absl::OkStatus();
  }).IgnoreError();
}

bool IsJson(const HttpRequest& request) {
  const std::string type = request.Header("content-type");
  return absl::AsciiStrToLower(absl::StripAsciiWhitespace(type.substr(0, type.find(';')))) ==
         "application/json";
}

// The body of a request that has none.
class NoBody : public BodySink {
 public:
  explicit NoBody(std::function<void(ReplyPtr)> done) : done_(std::move(done)) {}
  std::optional<HttpResponse> Take(std::string_view) override {
    return Problem(400, "this request has no body");
  }
  void Done(ReplyPtr reply) override { done_(std::move(reply)); }

 private:
  const std::function<void(ReplyPtr)> done_;
};

}  // namespace

HttpDecision OptimizeRoute(const HttpRequest& request, const std::string& caller, Core& core) {
  const absl::StatusOr<absl::Duration> deadline = ParseDeadline(request.query);
  if (!deadline.ok()) return ProblemOf(deadline.status());
  if (!IsJson(request)) {
    return Problem(415, "send one OptimizeBatchRequest as application/json");
  }
  const bool as_document = absl::StrContains(request.Header("accept"), "application/json");
  const auto start = [&core, caller, peer = request.peer_host, deadline = *deadline, as_document](
                         const TicketPtr& ticket, Upload upload, const ReplyPtr& reply) {
    if (upload.files.empty()) return reply->Send(Problem(400, "there is no job in the request"));
    LayerJob job = {.ticket = ticket,
                    .file = upload.files[0].file,
                    .caller = caller,
                    .peer = peer,
                    .as_document = as_document,
                    .finish_by = absl::Now() + std::min(deadline, core.options.max_time),
                    .reply = reply,
                    .stop = StopWhenGone(*reply)};
    core.Submit(
        ticket, {job.file}, {job.finish_by, job.stop.get_token()},
        [&core, job](const absl::Status& may) { Run(core, job, may); }, FileUse::kOptimize);
  };
  return TakeFiles(request, {.max_file_bytes = core.options.max_file_bytes, .caller = caller}, core,
                   start);
}

HttpDecision StrategiesRoute(const std::string& caller, Core& core) {
  auto entered = EnterQueue(caller, core);
  if (auto* refusal = std::get_if<HttpResponse>(&entered)) return std::move(*refusal);
  return std::make_unique<NoBody>(
      [&core, ticket = std::get<TicketPtr>(std::move(entered))](const ReplyPtr& reply) {
        const std::stop_source stop = StopWhenGone(*reply);
        const gcode::WorkLimit limit(absl::InfiniteFuture(), stop.get_token());
        core.Submit(ticket, {}, limit, [&core, reply, stop](const absl::Status&) {
          constexpr absl::Duration kPatience = absl::Seconds(10);
          const auto found = core.client->ListStrategies(kPatience, stop.get_token());
          reply->Send(found.ok() ? JsonResponse(MessageJson(*found) + "\n")
                                 : ServiceProblem(found.status()));
        });
      });
}

}  // namespace traverse::gateway

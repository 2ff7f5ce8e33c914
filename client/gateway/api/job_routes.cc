#include "client/gateway/api/job_routes.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "client/gateway/api/answers.h"
#include "client/gateway/api/file_routes.h"
#include "client/gateway/api/take_file.h"
#include "client/gateway/http/problem.h"
#include "client/gateway/jobs/job_store.h"

namespace traverse::gateway {
namespace {

constexpr char kRoot[] = "/v1/jobs";

// Where there is no such job, or not here.
HttpResponse JobProblem(const absl::Status& status) {
  const int code = absl::IsFailedPrecondition(status) ? 421
                   : absl::IsAborted(status)          ? 410
                                                      : HttpStatusOf(status.code());
  return Problem(code, std::string(status.message()));
}

HttpResponse CreateProblem(const absl::Status& status) {
  const int code = absl::IsAlreadyExists(status)       ? 409
                   : absl::IsResourceExhausted(status) ? 429
                                                       : HttpStatusOf(status.code());
  return Problem(code, std::string(status.message()));
}

HttpResponse JobAnswer(const v1::Job& job) { return JsonResponse(MessageJson(job) + "\n"); }

HttpDecision CreateJob(const HttpRequest& request, const std::string& caller, Core& core) {
  const std::string key = request.Header("idempotency-key");
  if (!IsIdempotencyKey(key)) {
    return Problem(400, "Idempotency-Key: not at most 255 printable ASCII characters");
  }
  return TakeFile(request, caller, core, [&core, peer = request.peer_host, key](TakenFile taken) {
    const absl::StatusOr<std::shared_ptr<Job>> job =
        core.jobs->Create(taken.ticket, {.request = std::move(taken.wanted),
                                         .upload = std::move(taken.file),
                                         .key = key,
                                         .print = std::move(taken.print),
                                         .route = kRoot,
                                         .peer = peer});
    if (!job.ok()) return taken.reply->Send(CreateProblem(job.status()));
    HttpResponse response = JobAnswer((*job)->Now());
    response.status = 202;
    response.headers.emplace_back("Location", absl::StrCat(kRoot, "/", (*job)->id()));
    taken.reply->Send(std::move(response));
  });
}

// The body of a request that has none, whose answer comes over time.
class EventsSink : public BodySink {
 public:
  EventsSink(std::shared_ptr<Job> job, uint64_t known) : job_(std::move(job)), known_(known) {}

  std::optional<HttpResponse> Take(std::string_view) override {
    return Problem(400, "a request for events has no body");
  }

  void Done(std::shared_ptr<HttpReply> reply) override {
    HttpResponse head = EventsHead();
    head.only_watches = true;
    reply->Begin(std::move(head));
    const uint64_t reader = job_->Follow(
        known_,
        {.on_change =
             [reply](const v1::Job& now) {
               const bool ended = now.has_expires_at();
               const char* name = !ended ? "progress" : now.has_summary() ? "done" : "failed";
               reply->Write(Event(name, MessageJson(now), absl::StrCat(now.revision())),
                            /*optional=*/!ended);
             },
         .on_end =
             [reply](const absl::Status& why) {
               if (!why.ok()) reply->Write(ProblemEvent(JobProblem(why)), false);
               reply->End();
             }});
    reply->OnGone([job = job_, reader] { job->Unfollow(reader); });
  }

 private:
  const std::shared_ptr<Job> job_;
  const uint64_t known_;
};

HttpDecision Events(const HttpRequest& request, const std::shared_ptr<Job>& job) {
  uint64_t known = 0;
  const std::string last = request.Header("last-event-id");
  if (!last.empty() && !absl::SimpleAtoi(last, &known)) {
    return Problem(400, "Last-Event-ID: not one of this job's events");
  }
  if (const v1::Job now = job->Now(); now.has_expires_at() && now.revision() <= known) {
    HttpResponse nothing_more;  // after which browsers do not ask again
    nothing_more.status = 204;
    return nothing_more;
  }
  return std::make_unique<EventsSink>(job, known);
}

HttpResponse Made(const Job& job, bool report) {
  if (!job.ended()) {
    HttpResponse not_yet = Problem(409, "the job is under way");
    not_yet.headers.emplace_back("Retry-After", "1");
    return not_yet;
  }
  const absl::StatusOr<RewrittenFile> made = job.made();
  if (!made.ok()) return ProblemOf(made.status());
  HttpResponse response;
  if (report) {
    if (made->report == nullptr) return Problem(404, "no report was asked for: report=true");
    response.content_type = "text/html; charset=utf-8";
    response.body = made->report;
    return response;
  }
  response.headers = SummaryHeaders(made->summary);
  response.headers.emplace_back("Content-Disposition", AttachmentHeader(job.wish().request.name));
  response.content_type = ContentTypeOf(*made->file);
  response.body = made->file;
  return response;
}

}  // namespace

bool IsJobPath(const std::string& path) {
  return path == kRoot || absl::StartsWith(path, absl::StrCat(kRoot, "/"));
}

HttpDecision JobRoute(const HttpRequest& request, const std::string& caller, Core& core,
                      std::string& route) {
  route = kRoot;
  if (request.path == kRoot) {
    return request.method == "POST" ? CreateJob(request, caller, core) : NotAllowed("POST");
  }
  const std::string below = request.path.substr(sizeof(kRoot));
  const size_t slash = std::min(below.find('/'), below.size());
  const std::string id = below.substr(0, slash), part = below.substr(slash);
  if (!part.empty() && part != "/file" && part != "/report") {
    return Problem(404, "there is nothing at this path; see /openapi.json");
  }
  route = absl::StrCat(kRoot, "/{id}", part);
  if (!IsGet(request) && (request.method != "DELETE" || !part.empty())) {
    return NotAllowed(part.empty() ? "GET, DELETE" : "GET");
  }
  if (!IsGet(request)) {
    const absl::Status status = core.jobs->Cancel(id, caller);
    if (!status.ok()) return JobProblem(status);
    HttpResponse done;
    done.status = 204;
    return done;
  }
  const absl::StatusOr<std::shared_ptr<Job>> job = core.jobs->Find(id, caller);
  if (!job.ok()) return JobProblem(job.status());
  if (!part.empty()) return Made(**job, part == "/report");
  if (request.method == "GET" && WantsEvents(request)) return Events(request, *job);
  return JobAnswer((*job)->Now());
}

}  // namespace traverse::gateway

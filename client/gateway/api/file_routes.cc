#include "client/gateway/api/file_routes.h"

#include <algorithm>
#include <memory>
#include <stop_token>
#include <utility>

#include "absl/strings/escaping.h"
#include "absl/strings/match.h"
#include "absl/time/clock.h"
#include "client/gateway/api/answers.h"
#include "client/gateway/api/parameters.h"
#include "client/gateway/api/take_file.h"
#include "client/gateway/http/problem.h"

namespace traverse::gateway {
namespace {

// What was found, or why not.
template <typename Message>
void SendMessage(HttpReply& reply, const absl::StatusOr<Message>& found) {
  reply.Send(found.ok() ? JsonResponse(MessageJson(*found) + "\n") : ProblemOf(found.status()));
}

enum class AnswerKind { kFile, kJson, kEvents };

AnswerKind KindOf(const HttpRequest& request) {
  if (WantsEvents(request)) return AnswerKind::kEvents;
  if (absl::StrContains(request.Header("accept"), "application/json")) return AnswerKind::kJson;
  return AnswerKind::kFile;
}

// `file` as events `name` of base64. In the spool, as it may be long.
absl::StatusOr<std::shared_ptr<const SpoolFile>> FileEvents(Spool& spool, const std::string& caller,
                                                            const std::string& name,
                                                            const SpoolFile& file) {
  constexpr size_t kPiece = 49152;  // a multiple of three: pieces may be joined before decoding
  absl::StatusOr<std::shared_ptr<SpoolFile>> events = spool.NewFile(caller);
  if (!events.ok()) return events.status();
  absl::Status status = file.ForEachPiece(kPiece, [&](std::string_view piece) {
    return (*events)->Append(Event(name, absl::Base64Escape({piece.data(), piece.size()})));
  });
  if (!status.ok()) return status;
  return std::shared_ptr<const SpoolFile>(*std::move(events));
}

void SendEvents(Core& core, const std::string& caller, HttpReply& reply,
                const absl::StatusOr<RewrittenFile>& made) {
  absl::Status status = made.status();
  std::vector<std::shared_ptr<const SpoolFile>> files;
  if (made.ok()) {
    for (const auto& [name, file] :
         {std::make_pair("file", made->file), std::make_pair("report", made->report)}) {
      if (file == nullptr || !status.ok()) continue;
      auto events = FileEvents(*core.spool, caller, name, *file);
      status = events.status();
      if (events.ok()) files.push_back(*std::move(events));
    }
  }
  if (status.ok()) {
    for (auto& file : files) reply.Write(std::move(file));
    reply.Write(Event("summary", MessageJson(made->summary)));
  } else {
    reply.Write(ProblemEvent(ProblemOf(status)));
  }
  reply.End();
}

void SendFile(HttpReply& reply, const FileRequest& request, RewrittenFile made) {
  HttpResponse response;
  response.headers = SummaryHeaders(made.summary);
  if (made.report != nullptr) {
    response.content_type = "text/html; charset=utf-8";
    response.body = std::move(made.report);
  } else {
    response.content_type = ContentTypeOf(*made.file);
    response.headers.emplace_back("Content-Disposition", AttachmentHeader(request.name));
    response.body = std::move(made.file);
  }
  reply.Send(std::move(response));
}

void BeginEvents(HttpReply& reply) {
  reply.Begin(EventsHead());
  v1::RewriteProgress queued;
  queued.set_stage(v1::RewriteProgress::STAGE_QUEUED);
  reply.Write(Event("progress", MessageJson(queued)));
}

// `may`: as of Core::Submit.
void RunRewrite(Core& core, const absl::Status& may, const FileRequest& request,
                const FileRecord& record, AnswerKind kind, const SpoolFile& upload,
                HttpReply& reply, const std::stop_token& cancel) {
  const absl::Time began = absl::Now();
  ProgressSink progress;
  if (kind == AnswerKind::kEvents) {
    progress = [&reply](const v1::RewriteProgress& now) {
      reply.Write(Event("progress", MessageJson(now)), /*optional=*/true);
    };
  }
  absl::StatusOr<RewrittenFile> made =
      may.ok() ? core.worker->Rewrite(upload, request, progress, cancel) : may;
  FileRecord done = record;
  done.seconds = absl::ToDoubleSeconds(absl::Now() - began);
  RecordFile(core, done, made.status(), made.ok() ? &made->summary : nullptr);
  if (kind == AnswerKind::kEvents) return SendEvents(core, request.caller, reply, made);
  if (!made.ok()) return reply.Send(ProblemOf(made.status()));
  if (kind == AnswerKind::kFile) return SendFile(reply, request, *std::move(made));
  HttpResponse response = JsonResponse(MessageJson(made->summary) + "\n");
  response.headers = SummaryHeaders(made->summary);
  reply.Send(std::move(response));
}

}  // namespace

HttpDecision RewriteRoute(const HttpRequest& request, const std::string& caller, Core& core) {
  return TakeFile(request, caller, core, [&core, request](TakenFile taken) {
    const AnswerKind kind = KindOf(request);
    const FileRecord record = {request.path, taken.wanted.caller, request.peer_host,
                               taken.wanted.name, taken.file->size()};
    const std::stop_source stop = StopWhenGone(*taken.reply);
    if (kind == AnswerKind::kEvents) BeginEvents(*taken.reply);
    core.Submit(taken.ticket, {taken.file}, {taken.wanted.finish_by, stop.get_token()},
                [&core, taken, record, kind, stop](const auto& may) {
                  RunRewrite(core, may, taken.wanted, record, kind, *taken.file, *taken.reply,
                             stop.get_token());
                });
  });
}

HttpDecision InspectRoute(const HttpRequest& request, const std::string& caller, Core& core) {
  return TakeFile(request, caller, core, [&core](TakenFile taken) {
    const std::stop_source stop = StopWhenGone(*taken.reply);
    const auto work = [&core, taken, stop](const absl::Status& may) {
      if (!may.ok()) return taken.reply->Send(ProblemOf(may));
      SendMessage(*taken.reply, core.worker->Inspect(*taken.file, taken.wanted, stop.get_token()));
    };
    core.Submit(taken.ticket, {taken.file}, {taken.wanted.finish_by, stop.get_token()}, work,
                FileUse::kInspect);
  });
}

HttpDecision VerifyRoute(const HttpRequest& request, const std::string& caller, Core& core) {
  if (auto query = ParseVerifyParameters(request.query); !query.ok()) {
    return ProblemOf(query.status());
  }
  const auto start = [&core, request](const TicketPtr& ticket, Upload upload,
                                      const ReplyPtr& reply) {
    const auto permissions = ParseVerifyParameters(AllParameters(request, upload));
    if (!permissions.ok()) return reply->Send(ProblemOf(permissions.status()));
    std::shared_ptr<SpoolFile> original, optimised;
    for (Upload::File& file : upload.files) {
      if (file.field == "original") original = file.file;
      if (file.field == "optimised") optimised = file.file;
    }
    if (original == nullptr || optimised == nullptr) {
      return reply->Send(Problem(400, "send a form with the files original and optimised"));
    }
    const absl::Time finish_by = absl::Now() + core.options.max_time;
    const std::stop_source stop = StopWhenGone(*reply);
    const auto work = [&core, original, optimised, permissions = *permissions, finish_by, reply,
                       stop](const absl::Status& may) {
      if (!may.ok()) return reply->Send(ProblemOf(may));
      SendMessage(*reply, core.worker->Verify(*original, *optimised, permissions, finish_by,
                                              stop.get_token()));
    };
    core.Submit(ticket, {original, optimised}, {finish_by, stop.get_token()}, work,
                FileUse::kVerify);
  };
  const UploadLimits limits = {.max_file_bytes = core.options.max_file_bytes,
                               .max_files = 2,
                               .caller = caller,
                               .small_files = {}};
  return TakeFiles(request, limits, core, start);
}

}  // namespace traverse::gateway

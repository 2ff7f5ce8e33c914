#include "client/gateway/api/file_routes.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <stop_token>
#include <utility>
#include <variant>

#include "absl/strings/escaping.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "client/gateway/api/machine_text.h"
#include "client/gateway/api/parameters.h"
#include "client/gateway/api/upload.h"
#include "client/gateway/http/problem.h"
#include "client/gateway/http/target.h"

namespace traverse::gateway {
namespace {

// A place in the queue, or the refusal.
std::variant<HttpResponse, std::shared_ptr<WorkQueue::Ticket>> EnterQueue(const std::string& caller,
                                                                          Core& core) {
  absl::StatusOr<std::shared_ptr<WorkQueue::Ticket>> ticket = core.queue->Enter(caller);
  if (ticket.ok()) return *std::move(ticket);
  const int status = absl::IsResourceExhausted(ticket.status()) ? 429 : 503;
  return Problem(status, std::string(ticket.status().message()));
}

HttpResponse RefusalOf(const absl::Status& status) {
  if (absl::IsUnimplemented(status)) return Problem(415, std::string(status.message()));
  return ProblemOf(status);
}

HttpResponse JsonResponse(std::string json) {
  HttpResponse response;
  response.content_type = "application/json";
  response.body = std::move(json);
  return response;
}

// What was found, or why not.
template <typename Message>
void SendMessage(HttpReply& reply, const absl::StatusOr<Message>& found) {
  reply.Send(found.ok() ? JsonResponse(MessageJson(*found) + "\n") : RefusalOf(found.status()));
}

// When the work on a file that has come must be done.
absl::Time FinishBy(const Core& core, absl::Duration deadline = absl::InfiniteDuration()) {
  return absl::Now() + std::min(deadline, core.options.max_time);
}

// Is stopped when the client leaves.
std::stop_source StopWhenGone(HttpReply& reply) {
  std::stop_source stop;
  reply.OnGone([stop]() mutable { stop.request_stop(); });
  return stop;
}

// Of the query and of the form.
Parameters AllParameters(const HttpRequest& request, const Upload& upload) {
  Parameters parameters = request.query;
  parameters.insert(parameters.end(), upload.fields.begin(), upload.fields.end());
  return parameters;
}

absl::StatusOr<FileRequest> WholeRequest(const HttpRequest& request, Upload& upload) {
  const Parameters parameters = AllParameters(request, upload);
  absl::StatusOr<FileRequest> parsed = ParseParameters(parameters);
  if (!parsed.ok()) return parsed;
  const bool named = std::any_of(parameters.begin(), parameters.end(),
                                 [](const auto& pair) { return pair.first == "name"; });
  auto machine = TakeMachine(upload);
  if (!machine.ok()) return machine.status();
  parsed->gcode.machine = *std::move(machine);
  if (upload.files.empty()) return absl::InvalidArgumentError("there is no file in the request");
  if (!named && !upload.files[0].name.empty()) {
    if (absl::Status status = CheckFileName(upload.files[0].name); !status.ok()) return status;
    parsed->name = upload.files[0].name;
  }
  return parsed;
}

enum class AnswerKind { kFile, kJson, kEvents };

AnswerKind KindOf(const HttpRequest& request) {
  const std::string accept = request.Header("accept");
  if (absl::StrContains(accept, "text/event-stream")) return AnswerKind::kEvents;
  if (absl::StrContains(accept, "application/json")) return AnswerKind::kJson;
  return AnswerKind::kFile;
}

std::string Event(const std::string& name, const std::string& data) {
  return absl::StrCat("event: ", name, "\ndata: ", data, "\n\n");
}

// `file` as events `name` of base64. In the spool, as it may be long.
absl::StatusOr<std::shared_ptr<const SpoolFile>> FileEvents(Spool& spool, const std::string& caller,
                                                            const std::string& name,
                                                            const SpoolFile& file) {
  constexpr size_t kPiece = 49152;  // a multiple of three: pieces may be joined before decoding
  absl::StatusOr<std::shared_ptr<SpoolFile>> events = spool.NewFile(caller);
  if (!events.ok()) return events.status();
  std::string piece;
  for (uint64_t at = 0; at < file.size(); at += piece.size()) {
    piece.resize(std::min<uint64_t>(kPiece, file.size() - at));
    const absl::StatusOr<size_t> got = file.ReadAt(at, piece.data(), piece.size());
    if (!got.ok()) return got.status();
    absl::Status status = (*events)->Append(Event(name, absl::Base64Escape(piece)));
    if (!status.ok()) return status;
  }
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
    std::string json = std::get<std::string>(RefusalOf(status).body);
    json.pop_back();  // the line break
    reply.Write(Event("problem", json));
  }
  reply.End();
}

// By its first bytes: G-code is text, containers are not.
std::string ContentTypeOf(const SpoolFile& file) {
  char first[4] = {};
  const absl::StatusOr<size_t> got = file.ReadAt(0, first, sizeof(first));
  const std::string_view bytes(first, got.value_or(0));
  return DetectContainer(bytes) == ContainerKind::kText ? "text/x.gcode"
                                                        : "application/octet-stream";
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
  HttpResponse head;
  head.content_type = "text/event-stream";
  head.headers.emplace_back("Cache-Control", "no-store");
  head.headers.emplace_back("X-Accel-Buffering", "no");
  reply.Begin(std::move(head));
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
  if (!made.ok()) return reply.Send(RefusalOf(made.status()));
  if (kind == AnswerKind::kFile) return SendFile(reply, request, *std::move(made));
  HttpResponse response = JsonResponse(MessageJson(made->summary) + "\n");
  response.headers = SummaryHeaders(made->summary);
  reply.Send(std::move(response));
}

FileRecord RecordOf(const HttpRequest& request, const std::string& caller,
                    const FileRequest& wanted, const SpoolFile& upload) {
  return {request.path, caller, request.peer_host, wanted.name, upload.size()};
}

using TicketPtr = std::shared_ptr<WorkQueue::Ticket>;
using ReplyPtr = std::shared_ptr<HttpReply>;

// Lets `caller` wait in line, and takes his files; `start` is called when they are there.
HttpDecision TakeFiles(const HttpRequest& request, const std::string& caller,
                       const UploadLimits& limits, Core& core,
                       std::function<void(const TicketPtr&, Upload, const ReplyPtr&)> start) {
  auto entered = EnterQueue(caller, core);
  if (auto* refusal = std::get_if<HttpResponse>(&entered)) return std::move(*refusal);
  return TakeUpload(
      request, *core.spool, limits,
      [ticket = std::get<TicketPtr>(std::move(entered)), start = std::move(start)](
          Upload upload, const ReplyPtr& reply) { start(ticket, std::move(upload), reply); });
}

using FilePtr = std::shared_ptr<SpoolFile>;
using Work = std::function<void(const TicketPtr&, FileRequest, const FilePtr&, const ReplyPtr&)>;

// The same for one file and what is asked of it.
HttpDecision TakeFile(const HttpRequest& request, const std::string& caller, Core& core,
                      Work start) {
  // What is wrong with the query is said before the file is sent.
  if (absl::StatusOr<FileRequest> query = ParseParameters(request.query); !query.ok()) {
    return ProblemOf(query.status());
  }
  const UploadLimits limits = {.max_file_bytes = core.options.max_file_bytes,
                               .caller = caller,
                               .small_files = {{"machine", kMostMachineBytes}}};
  return TakeFiles(request, caller, limits, core,
                   [request, caller, start = std::move(start)](
                       const TicketPtr& ticket, Upload upload, const ReplyPtr& reply) {
                     absl::StatusOr<FileRequest> wanted = WholeRequest(request, upload);
                     if (!wanted.ok()) return reply->Send(ProblemOf(wanted.status()));
                     wanted->caller = caller;
                     start(ticket, *std::move(wanted), upload.files[0].file, reply);
                   });
}

}  // namespace

HttpDecision RewriteRoute(const HttpRequest& request, const std::string& caller, Core& core) {
  const auto start = [&core, request, caller](const TicketPtr& ticket, FileRequest wanted,
                                              const FilePtr& file, const ReplyPtr& reply) {
    wanted.finish_by = FinishBy(core, wanted.deadline);
    const AnswerKind kind = KindOf(request);
    const FileRecord record = RecordOf(request, caller, wanted, *file);
    const std::stop_source stop = StopWhenGone(*reply);
    if (kind == AnswerKind::kEvents) BeginEvents(*reply);
    core.Submit(ticket, {file},
                [&core, wanted, record, kind, file, reply, stop](const absl::Status& may) {
                  RunRewrite(core, may, wanted, record, kind, *file, *reply, stop.get_token());
                });
  };
  return TakeFile(request, caller, core, start);
}

HttpDecision InspectRoute(const HttpRequest& request, const std::string& caller, Core& core) {
  const auto start = [&core](const TicketPtr& ticket, FileRequest wanted, const FilePtr& file,
                             const ReplyPtr& reply) {
    wanted.finish_by = FinishBy(core, wanted.deadline);
    const std::stop_source stop = StopWhenGone(*reply);
    core.Submit(
        ticket, {file},
        [&core, wanted, file, reply, stop](const absl::Status& may) {
          if (!may.ok()) return reply->Send(RefusalOf(may));
          SendMessage(*reply, core.worker->Inspect(*file, wanted, stop.get_token()));
        },
        FileUse::kInspect);
  };
  return TakeFile(request, caller, core, start);
}

HttpDecision VerifyRoute(const HttpRequest& request, const std::string& caller, Core& core) {
  if (auto query = ParseVerifyParameters(request.query); !query.ok()) {
    return ProblemOf(query.status());
  }
  const auto start = [&core, request](const TicketPtr& ticket, Upload upload,
                                      const ReplyPtr& reply) {
    const auto permissions = ParseVerifyParameters(AllParameters(request, upload));
    if (!permissions.ok()) return reply->Send(ProblemOf(permissions.status()));
    FilePtr original, optimised;
    for (Upload::File& file : upload.files) {
      if (file.field == "original") original = file.file;
      if (file.field == "optimised") optimised = file.file;
    }
    if (original == nullptr || optimised == nullptr) {
      return reply->Send(Problem(400, "send a form with the files original and optimised"));
    }
    const absl::Time finish_by = FinishBy(core);
    const std::stop_source stop = StopWhenGone(*reply);
    const auto work = [&core, original, optimised, permissions = *permissions, finish_by, reply,
                       stop](const absl::Status& may) {
      if (!may.ok()) return reply->Send(RefusalOf(may));
      SendMessage(*reply, core.worker->Verify(*original, *optimised, permissions, finish_by,
                                              stop.get_token()));
    };
    core.Submit(ticket, {original, optimised}, work, FileUse::kVerify);
  };
  const UploadLimits limits = {.max_file_bytes = core.options.max_file_bytes,
                               .max_files = 2,
                               .caller = caller,
                               .small_files = {}};
  return TakeFiles(request, caller, limits, core, start);
}

}  // namespace traverse::gateway

#include "client/gateway/api/take_file.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "client/gateway/api/machine_text.h"
#include "client/gateway/http/problem.h"
#include "client/gateway/http/target.h"

namespace traverse::gateway {
namespace {

absl::StatusOr<FileRequest> WholeRequest(const Parameters& parameters, Upload& upload) {
  absl::StatusOr<FileRequest> parsed = ParseParameters(parameters);
  if (!parsed.ok()) return parsed;
  const bool named = std::any_of(parameters.begin(), parameters.end(),
                                 [](const auto& pair) { return pair.first == "name"; });
  auto machine = TakeMachine(upload);
  if (!machine.ok()) return machine.status();
  parsed->gcode.machine = *std::move(machine);
  if (upload.files.empty() || upload.files[0].file->size() == 0) {
    return absl::InvalidArgumentError("there is no file in the request, or it is empty");
  }
  if (!named && !upload.files[0].name.empty()) {
    if (absl::Status status = CheckFileName(upload.files[0].name); !status.ok()) return status;
    parsed->name = upload.files[0].name;
  }
  return parsed;
}

// Of everything that decides about the answer but time.
std::string PrintOf(const Upload& upload, Parameters parameters) {
  std::sort(parameters.begin(), parameters.end());
  std::string print;
  for (const auto& [name, value] : parameters) {
    if (name == "deadline") continue;  // who sends a file again has less time left
    absl::StrAppend(&print, name, "=", value.size(), ":", value, "\n");
  }
  for (const Upload::File& file : upload.files) {
    const bool small = !file.field.empty() && file.field != "file";
    absl::StrAppend(&print, small ? file.field : "file", " ", file.file->size(), " ",
                    file.file->checksum(), "\n");
  }
  return print;
}

}  // namespace

std::variant<HttpResponse, TicketPtr> EnterQueue(const std::string& caller, Core& core) {
  absl::StatusOr<TicketPtr> ticket = core.queue->Enter(caller);
  if (ticket.ok()) return *std::move(ticket);
  const int status = absl::IsResourceExhausted(ticket.status()) ? 429 : 503;
  return Problem(status, std::string(ticket.status().message()));
}

Parameters AllParameters(const HttpRequest& request, const Upload& upload) {
  Parameters parameters = request.query;
  parameters.insert(parameters.end(), upload.fields.begin(), upload.fields.end());
  return parameters;
}

HttpDecision TakeFiles(const HttpRequest& request, const UploadLimits& limits, Core& core,
                       FilesTaken start) {
  auto entered = EnterQueue(limits.caller, core);
  if (auto* refusal = std::get_if<HttpResponse>(&entered)) return std::move(*refusal);
  return TakeUpload(
      request, *core.spool, limits,
      [ticket = std::get<TicketPtr>(std::move(entered)), start = std::move(start)](
          Upload upload, const ReplyPtr& reply) { start(ticket, std::move(upload), reply); });
}

HttpDecision TakeFile(const HttpRequest& request, const std::string& caller, Core& core,
                      std::function<void(TakenFile)> start) {
  // What is wrong with the query is said before the file is sent.
  if (absl::StatusOr<FileRequest> query = ParseParameters(request.query); !query.ok()) {
    return ProblemOf(query.status());
  }
  const UploadLimits limits = {.max_file_bytes = core.options.max_file_bytes,
                               .caller = caller,
                               .small_files = {{"machine", kMostMachineBytes}}};
  return TakeFiles(
      request, limits, core,
      [request, caller, &core, start = std::move(start)](const TicketPtr& ticket, Upload upload,
                                                         const ReplyPtr& reply) {
        const Parameters parameters = AllParameters(request, upload);
        std::string print = PrintOf(upload, parameters);
        absl::StatusOr<FileRequest> wanted = WholeRequest(parameters, upload);
        if (!wanted.ok()) return reply->Send(ProblemOf(wanted.status()));
        wanted->caller = caller;
        wanted->finish_by = absl::Now() + std::min(wanted->deadline, core.options.max_time);
        start({ticket, *std::move(wanted), upload.files[0].file, std::move(print), reply});
      });
}

}  // namespace traverse::gateway

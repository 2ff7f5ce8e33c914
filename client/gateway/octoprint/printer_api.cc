#include "client/gateway/octoprint/printer_api.h"

#include <algorithm>
#include <future>
#include <optional>
#include <stop_token>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/time/clock.h"
#include "client/gateway/api/file_routes.h"
#include "client/gateway/http/problem.h"
#include "client/gateway/http/target.h"

namespace traverse::gateway {
namespace {

// Takes no body.
class NoBody : public BodySink {
 public:
  explicit NoBody(std::function<void(std::shared_ptr<HttpReply>)> done) : done_(std::move(done)) {}
  std::optional<HttpResponse> Take(std::string_view /*piece*/) override {
    return Problem(400, "this request has no body");
  }
  void Done(std::shared_ptr<HttpReply> reply) override { done_(std::move(reply)); }

 private:
  const std::function<void(std::shared_ptr<HttpReply>)> done_;
};

// The folder of a form: names of folders with slashes between them.
absl::Status CheckFolder(const std::string& folder) {
  const std::vector<std::string> segments = absl::StrSplit(folder, '/', absl::SkipEmpty());
  for (const std::string& segment : segments) {
    if (absl::Status status = CheckFileName(segment); !status.ok()) {
      return absl::InvalidArgumentError(absl::StrCat("path: ", status.message()));
    }
  }
  return absl::OkStatus();
}

absl::StatusOr<PrinterUpload> UploadOf(const Upload& upload, const std::string& storage) {
  if (upload.files.size() != 1 || upload.files[0].field != "file") {
    return absl::InvalidArgumentError("send a form with one file, named file");
  }
  PrinterUpload out;
  out.storage = storage;
  out.name = upload.files[0].name;
  if (absl::Status status = CheckFileName(out.name); !status.ok()) return status;
  for (const auto& [name, value] : upload.fields) {
    if (name == "path") {
      if (absl::Status status = CheckFolder(value); !status.ok()) return status;
    }
    if (name == "print") {
      out.print = absl::EqualsIgnoreCase(value, "true");
    } else {
      out.fields.emplace_back(name, value);
    }
  }
  return out;
}

// "late", "refused", ...: few, for metrics.
std::string ReasonKind(const absl::Status& status) {
  switch (status.code()) {
    case absl::StatusCode::kAlreadyExists:
      return "optimised_before";
    case absl::StatusCode::kDeadlineExceeded:
    case absl::StatusCode::kCancelled:
      return "late";
    case absl::StatusCode::kInvalidArgument:
    case absl::StatusCode::kUnimplemented:
    case absl::StatusCode::kOutOfRange:
      return "not_understood";
    case absl::StatusCode::kFailedPrecondition:
      return "not_the_same";
    default:
      return "failed";
  }
}

// One line of printable ASCII, as a header allows.
std::string HeaderText(const std::string& text) {
  constexpr size_t kMost = 500;
  std::string out = text.substr(0, kMost);
  std::replace_if(
      out.begin(), out.end(), [](char c) { return c < 0x20 || c > 0x7e; }, '?');
  return out;
}

}  // namespace

struct PrinterApi::Delivery {
  const Printer& printer;
  PrinterUpload upload;
  std::string api_key;
  std::shared_ptr<SpoolFile> original;
  FileRecord record;
  std::shared_ptr<WorkQueue::Ticket> ticket;
  std::shared_ptr<HttpReply> reply;
  absl::Status optimised = absl::UnknownError("");  // OK, or why the original is passed on
  std::optional<RewrittenFile> made = std::nullopt;
};

PrinterApi::~PrinterApi() {
  MutexLock lock(mutex_);
  while (threads_ > 0) ended_.Wait(mutex_);
}

void PrinterApi::Spawn(HttpReply& reply, std::function<void()> work) {
  const auto add = [this](int threads) {
    MutexLock lock(mutex_);
    threads_ += threads;
    ended_.NotifyAll();
  };
  add(1);
  try {
    std::thread([add, work = std::move(work)]() mutable {
      work();
      work = nullptr;
      add(-1);
    }).detach();
  } catch (const std::system_error&) {
    add(-1);
    reply.Send(Problem(503, "this gateway has no thread for it now"));
  }
}

HttpDecision PrinterApi::Handle(const HttpRequest& request, const std::string& caller) {
  const std::vector<std::string> parts = absl::StrSplit(request.path.substr(1), '/');
  const bool named = parts[0] == "printers" && parts.size() >= 2;
  const std::string name = named ? parts[1] : options_.printers.default_name;
  const Printer* printer = options_.printers.Find(name);
  if (printer == nullptr) {
    return Problem(404, named ? absl::StrCat("there is no printer \"", name, "\"")
                              : "there is no default printer; see /printers/NAME/api");
  }
  const std::vector<std::string> rest(parts.begin() + (named ? 2 : 0), parts.end());
  if (rest == std::vector<std::string>{"api", "version"}) {
    if (request.method == "GET") return HandleVersion(request, caller, *printer);
    return Problem(405, "only GET is allowed for this path");
  }
  const bool files = rest.size() == 3 && rest[0] == "api" && rest[1] == "files" &&
                     (rest[2] == "local" || rest[2] == "sdcard");
  if (!files)
    return Problem(404, "of OctoPrint's API only version and the upload of files are supported");
  if (request.method != "POST") return Problem(405, "only POST is allowed for this path");
  return HandleUpload(request, caller, *printer, rest[2]);
}

// A caller's token for the gateway stays here: a printer's server could use it against us.
std::string PrinterApi::KeyFor(const Printer& printer, const HttpRequest& request) {
  if (!printer.api_key.empty()) return printer.api_key;
  std::string key = request.Header("x-api-key");
  return core_.files.auth->IsToken(key) ? "" : key;
}

HttpDecision PrinterApi::HandleVersion(const HttpRequest& request, const std::string& caller,
                                       const Printer& printer) {
  absl::StatusOr<std::shared_ptr<WorkQueue::Ticket>> ticket = core_.queue->Enter(caller);
  if (!ticket.ok()) return Problem(503, std::string(ticket.status().message()));
  const std::string key = KeyFor(printer, request);
  return std::make_unique<NoBody>(
      [this, &printer, key, ticket = *ticket](std::shared_ptr<HttpReply> reply) {
        Spawn(*reply, [this, &printer, key, ticket, reply] {
          const absl::StatusOr<UpstreamAnswer> answer = AskVersion(printer, key, options_.upstream);
          if (!answer.ok()) {
            reply->Send(Problem(absl::IsDeadlineExceeded(answer.status()) ? 504 : 502,
                                std::string(answer.status().message())));
            return;
          }
          HttpResponse response;
          response.status = answer->status;
          response.content_type = answer->content_type;
          response.body = answer->body;
          reply->Send(std::move(response));
        });
      });
}

HttpDecision PrinterApi::HandleUpload(const HttpRequest& request, const std::string& caller,
                                      const Printer& printer, const std::string& storage) {
  absl::StatusOr<std::shared_ptr<WorkQueue::Ticket>> ticket = core_.queue->Enter(caller);
  if (!ticket.ok()) return Problem(503, std::string(ticket.status().message()));
  const UploadLimits limits = {
      .max_file_bytes = core_.options.max_file_bytes, .caller = caller, .small_files = {}};
  const std::string key = KeyFor(printer, request);
  const auto start = [this, &printer, storage, key, caller, peer = request.peer_host,
                      ticket = *ticket](Upload upload, std::shared_ptr<HttpReply> reply) {
    absl::StatusOr<PrinterUpload> wanted = UploadOf(upload, storage);
    if (!wanted.ok()) return reply->Send(ProblemOf(wanted.status()));
    const std::shared_ptr<SpoolFile> file = upload.files[0].file;
    const FileRecord record = {"printers", caller, peer, wanted->name, file->size()};
    auto delivery = std::make_shared<Delivery>(
        Delivery{printer, *std::move(wanted), key, file, record, ticket, std::move(reply)});
    Spawn(*delivery->reply, [this, delivery] { Deliver(*delivery); });
  };
  return TakeUpload(request, *core_.spool, limits, start);
}

// Sets `optimised`, and `made` if it is OK. The work may go on for a moment after its deadline:
// nobody waits for it.
void PrinterApi::Optimise(Delivery& delivery) {
  FileRequest request;
  request.name = delivery.upload.name;
  request.caller = delivery.record.caller;
  request.gcode.policy = delivery.printer.policy;
  request.gcode.machine = delivery.printer.machine;
  request.only_new = true;
  request.finish_by = absl::Now() + options_.upload_deadline;
  auto result = std::make_shared<std::promise<absl::StatusOr<RewrittenFile>>>();
  std::future<absl::StatusOr<RewrittenFile>> future = result->get_future();
  std::stop_source stop;
  core_.Submit(delivery.ticket, {delivery.original}, {request.finish_by, stop.get_token()},
               [&core = core_, result, request, original = delivery.original,
                record = delivery.record, stop](const absl::Status& may) {
                 const absl::Time began = absl::Now();
                 absl::StatusOr<RewrittenFile> made =
                     may.ok() ? core.worker->Rewrite(*original, request, {}, stop.get_token())
                              : may;
                 FileRecord done = record;
                 done.seconds = absl::ToDoubleSeconds(absl::Now() - began);
                 RecordFile(core, done, made.status(), made.ok() ? &made->summary : nullptr);
                 result->set_value(std::move(made));
               });
  if (future.wait_until(absl::ToChronoTime(request.finish_by)) != std::future_status::ready) {
    stop.request_stop();
    delivery.optimised = absl::DeadlineExceededError(
        absl::StrCat("not done within ", absl::FormatDuration(options_.upload_deadline)));
    return;
  }
  absl::StatusOr<RewrittenFile> made = future.get();
  delivery.optimised = made.status();
  if (made.ok()) delivery.made = *std::move(made);
}

void PrinterApi::Deliver(Delivery& delivery) {
  Optimise(delivery);
  const absl::Status& why = delivery.optimised;
  const std::string kind = why.ok() ? "" : ReasonKind(why);
  const std::string& printer = delivery.printer.name;
  JobLog::Fields fields = {{"printer", printer},
                           {"name", delivery.upload.name},
                           {"caller", delivery.record.caller},
                           {"sent", why.ok() ? "optimised" : "original"}};
  if (!why.ok()) fields.emplace_back("reason", std::string(why.message()));
  if (!why.ok() && !absl::IsAlreadyExists(why) && delivery.printer.refuse_on_failure) {
    core_.metrics.CountUpload(printer, "refused", kind);
    fields[3].second = "nothing";
    core_.files.log->Event(JobLog::Level::kWarning, "upload", fields);
    return delivery.reply->Send(
        Problem(422, absl::StrCat("not sent to the printer, which accepts only optimised files: ",
                                  why.message())));
  }
  const SpoolFile& file = why.ok() ? *delivery.made->file : *delivery.original;
  const absl::StatusOr<UpstreamAnswer> answer =
      SendToPrinter(delivery.printer, delivery.api_key, delivery.upload, file, options_.upstream);
  const bool taken = answer.ok() && answer->status / 100 == 2;
  core_.metrics.CountUpload(printer,
                            !taken     ? "upstream_failed"
                            : why.ok() ? "optimised"
                                       : "original",
                            kind);
  fields.emplace_back("upstream", answer.ok() ? absl::StrCat(answer->status)
                                              : std::string(answer.status().message()));
  const bool well = taken && (why.ok() || absl::IsAlreadyExists(why));
  core_.files.log->Event(well ? JobLog::Level::kInfo : JobLog::Level::kWarning, "upload", fields);
  Answer(delivery, answer);
}

void PrinterApi::Answer(Delivery& delivery, const absl::StatusOr<UpstreamAnswer>& answer) {
  HttpResponse response;
  if (answer.ok()) {
    response.status = answer->status;
    response.content_type = answer->content_type;
    response.body = answer->body;
    if (!answer->location.empty()) {
      response.headers.emplace_back("Location", HeaderText(answer->location));
    }
  } else {
    response = Problem(absl::IsDeadlineExceeded(answer.status()) ? 504 : 502,
                       std::string(answer.status().message()));
  }
  const absl::Status& why = delivery.optimised;
  response.headers.emplace_back("Traverse-Sent", why.ok() ? "optimised" : "original");
  if (why.ok()) {
    for (auto& header : SummaryHeaders(delivery.made->summary)) {
      response.headers.push_back(std::move(header));
    }
  } else {
    response.headers.emplace_back("Traverse-Reason", HeaderText(std::string(why.message())));
  }
  delivery.reply->Send(std::move(response));
}

}  // namespace traverse::gateway

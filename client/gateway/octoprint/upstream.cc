#include "client/gateway/octoprint/upstream.h"

#include <curl/curl.h>

#include <cstdio>
#include <memory>
#include <mutex>
#include <optional>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/time/clock.h"
#include "client/files/json.h"
#include "server/version.h"

namespace traverse::gateway {
namespace {

constexpr size_t kMaxAnswerBytes = size_t{1} << 20;

void InitCurl() {
  static std::once_flag once;
  std::call_once(once, [] { curl_global_init(CURL_GLOBAL_DEFAULT); });
}

struct CloseCurl {
  void operator()(CURL* curl) const { curl_easy_cleanup(curl); }
};
struct FreeList {
  void operator()(curl_slist* list) const { curl_slist_free_all(list); }
};
struct FreeMime {
  void operator()(curl_mime* mime) const { curl_mime_free(mime); }
};

// One request.
class Call {
 public:
  Call(const Printer& printer, const std::string& path, const std::string& api_key,
       const UpstreamLimits& limits)
      : curl_((InitCurl(), curl_easy_init())), idle_{limits.idle_time} {
    Set(CURLOPT_URL, absl::StrCat(printer.url, path).c_str());
    // Follows no redirects and connects only where the configuration says.
    Set(CURLOPT_PROTOCOLS_STR, "http,https");
    Set(CURLOPT_FOLLOWLOCATION, 0L);
    Set(CURLOPT_PROXY, "");
    Set(CURLOPT_NOSIGNAL, 1L);
    Set(CURLOPT_CONNECTTIMEOUT_MS,
        static_cast<long>(absl::ToInt64Milliseconds(limits.connect_time)));
    // libcurl's own speed limit uses an average, which stays high after a large file was sent.
    Set(CURLOPT_NOPROGRESS, 0L);
    Set(CURLOPT_XFERINFOFUNCTION, &Watch);
    Set(CURLOPT_XFERINFODATA, &idle_);
    if (!printer.tls_ca.empty()) Set(CURLOPT_CAINFO, printer.tls_ca.c_str());
    Set(CURLOPT_WRITEFUNCTION, &TakeBody);
    Set(CURLOPT_WRITEDATA, &answer_);
    Set(CURLOPT_HEADERFUNCTION, &TakeHeader);
    Set(CURLOPT_HEADERDATA, &answer_);
    if (!api_key.empty()) AddHeader(absl::StrCat("X-Api-Key: ", api_key));
    AddHeader("Expect:");
    AddHeader(absl::StrCat("User-Agent: traverse-gateway/", kVersion));
  }

  template <typename T>
  void Set(CURLoption option, T value) {
    curl_easy_setopt(curl_.get(), option, value);
  }
  void AddHeader(const std::string& line) {
    headers_.reset(curl_slist_append(headers_.release(), line.c_str()));
  }
  CURL* get() { return curl_.get(); }

  absl::StatusOr<UpstreamAnswer> Run(const Printer& printer) {
    Set(CURLOPT_HTTPHEADER, headers_.get());
    const CURLcode code = curl_easy_perform(curl_.get());
    if (code == CURLE_OPERATION_TIMEDOUT || code == CURLE_ABORTED_BY_CALLBACK) {
      return absl::DeadlineExceededError(absl::StrCat("printer ", printer.name, " is too slow"));
    }
    if (code != CURLE_OK) {
      return absl::UnavailableError(
          absl::StrCat("printer ", printer.name, " cannot be reached: ", curl_easy_strerror(code)));
    }
    long status = 0;
    curl_easy_getinfo(curl_.get(), CURLINFO_RESPONSE_CODE, &status);
    answer_.status = static_cast<int>(status);
    const char* type = nullptr;
    curl_easy_getinfo(curl_.get(), CURLINFO_CONTENT_TYPE, &type);
    if (type != nullptr) answer_.content_type = type;
    return std::move(answer_);
  }

 private:
  // When the last byte was sent. What is received does not count: a server that sends its answer
  // byte by byte would be waited for without end.
  struct Idle {
    absl::Duration most;
    curl_off_t sent = 0;
    absl::Time since = absl::Now();
    absl::Time began = absl::Now();
  };

  // Called about once a second; a result other than 0 ends the call.
  static int Watch(void* self, curl_off_t, curl_off_t, curl_off_t, curl_off_t sent) {
    constexpr curl_off_t kLeastBytesPerSecond = 1024;
    Idle& idle = *static_cast<Idle*>(self);
    const absl::Time now = absl::Now();
    if (sent != idle.sent) {
      idle.sent = sent;
      idle.since = now;
    }
    const bool slow = now - idle.began > idle.most + absl::Seconds(sent / kLeastBytesPerSecond);
    return slow || now - idle.since > idle.most ? 1 : 0;
  }

  static size_t TakeBody(char* data, size_t size, size_t count, void* answer) {
    std::string& body = static_cast<UpstreamAnswer*>(answer)->body;
    body.append(data, std::min(size * count, kMaxAnswerBytes - body.size()));
    return size * count;
  }

  static size_t TakeHeader(char* data, size_t size, size_t count, void* answer) {
    const std::string line(data, size * count);
    constexpr char kLocation[] = "location:";
    if (absl::AsciiStrToLower(line.substr(0, sizeof(kLocation) - 1)) == kLocation) {
      static_cast<UpstreamAnswer*>(answer)->location =
          std::string(absl::StripAsciiWhitespace(line.substr(sizeof(kLocation) - 1)));
    }
    return size * count;
  }

  std::unique_ptr<CURL, CloseCurl> curl_;
  std::unique_ptr<curl_slist, FreeList> headers_;
  UpstreamAnswer answer_;
  Idle idle_;
};

// The file as libcurl reads it.
struct Reading {
  const SpoolFile* file;
  uint64_t at = 0;

  static size_t Read(char* out, size_t size, size_t count, void* self) {
    auto* reading = static_cast<Reading*>(self);
    const absl::StatusOr<size_t> got = reading->file->ReadAt(reading->at, out, size * count);
    if (!got.ok()) return CURL_READFUNC_ABORT;
    reading->at += *got;
    return *got;
  }
  static int Seek(void* self, curl_off_t offset, int origin) {
    if (origin != SEEK_SET) return CURL_SEEKFUNC_CANTSEEK;
    static_cast<Reading*>(self)->at = static_cast<uint64_t>(offset);
    return CURL_SEEKFUNC_OK;
  }
};

// Whether to pass on a field of the caller's form: only those that OctoPrint documents. Other
// fields are the servers' own, such as the path of a file that OctoPrint has stored, the root of a
// Moonraker, or the checksum of the file as it arrived.
bool GoesOn(const std::string& field, PrinterKind kind) {
  if (field == "path") return true;
  return kind == PrinterKind::kOctoPrint && (field == "select" || field == "userdata" ||
                                             field == "foldername" || field == "noOverwrite");
}

void AddField(curl_mime* form, const std::string& name, const std::string& value) {
  curl_mimepart* part = curl_mime_addpart(form);
  curl_mime_name(part, name.c_str());
  curl_mime_data(part, value.data(), value.size());
}

absl::StatusOr<UpstreamAnswer> SendForm(const Printer& printer, const std::string& path,
                                        const std::string& api_key, const PrinterUpload& upload,
                                        const SpoolFile& file, const UpstreamLimits& limits) {
  Call call(printer, path, api_key, limits);
  const std::unique_ptr<curl_mime, FreeMime> form(curl_mime_init(call.get()));
  for (const auto& [name, value] : upload.fields) {
    if (GoesOn(name, printer.kind)) AddField(form.get(), name, value);
  }
  AddField(form.get(), "print", upload.print ? "true" : "false");
  if (printer.kind == PrinterKind::kMoonraker) AddField(form.get(), "root", "gcodes");
  Reading reading{&file};
  curl_mimepart* part = curl_mime_addpart(form.get());
  curl_mime_name(part, "file");
  curl_mime_filename(part, upload.name.c_str());
  curl_mime_type(part, "application/octet-stream");
  curl_mime_data_cb(part, static_cast<curl_off_t>(file.size()), &Reading::Read, &Reading::Seek,
                    nullptr, &reading);
  call.Set(CURLOPT_MIMEPOST, form.get());
  return call.Run(printer);
}

std::string EscapedPath(CURL* curl, const std::string& path) {
  std::string out;
  const std::vector<std::string> segments = absl::StrSplit(path, '/', absl::SkipEmpty());
  for (const std::string& segment : segments) {
    char* escaped = curl_easy_escape(curl, segment.data(), static_cast<int>(segment.size()));
    absl::StrAppend(&out, "/", escaped);
    curl_free(escaped);
  }
  return out;
}

std::string FolderOf(const PrinterUpload& upload) {
  for (const auto& [name, value] : upload.fields) {
    if (name == "path") return value;
  }
  return "";
}

absl::StatusOr<UpstreamAnswer> PutFile(const Printer& printer, const std::string& api_key,
                                       const PrinterUpload& upload, const SpoolFile& file,
                                       const UpstreamLimits& limits) {
  InitCurl();
  const std::string place = EscapedPath(nullptr, absl::StrCat(FolderOf(upload), "/", upload.name));
  Call call(printer, absl::StrCat("/api/v1/files/", printer.storage, place), api_key, limits);
  Reading reading{&file};
  call.AddHeader("Content-Type: application/octet-stream");
  call.AddHeader("Overwrite: ?1");
  call.AddHeader(upload.print ? "Print-After-Upload: ?1" : "Print-After-Upload: ?0");
  call.Set(CURLOPT_UPLOAD, 1L);
  call.Set(CURLOPT_READFUNCTION, &Reading::Read);
  call.Set(CURLOPT_READDATA, &reading);
  call.Set(CURLOPT_SEEKFUNCTION, &Reading::Seek);
  call.Set(CURLOPT_SEEKDATA, &reading);
  call.Set(CURLOPT_INFILESIZE_LARGE, static_cast<curl_off_t>(file.size()));
  return call.Run(printer);
}

// Whether the print that `upload` asks for has begun. A Moonraker says so, and accepts files while
// its printer is offline or busy; a PrusaLink does not say.
bool PrintBegan(const PrinterUpload& upload, const UpstreamAnswer& answer) {
  const std::optional<Json> said = ParseJson(answer.body);
  const Json* const started = said ? said->Find("print_started") : nullptr;
  if (started == nullptr) return upload.print;
  return upload.print && started->Bool() != nullptr && *started->Bool();
}

// What OctoPrint answers to an upload.
void SayAsOctoPrint(const PrinterUpload& upload, UpstreamAnswer& answer) {
  const std::string folder = FolderOf(upload);
  const std::string path = folder.empty() ? upload.name : absl::StrCat(folder, "/", upload.name);
  const Json file = JsonObject{{"name", upload.name}, {"path", path}, {"origin", upload.storage}};
  const Json json = JsonObject{{"files", JsonObject{{upload.storage, file}}},
                               {"done", true},
                               {"effectivePrint", PrintBegan(upload, answer)}};
  answer.status = 201;
  answer.content_type = "application/json";
  answer.body = JsonText(json) + "\n";
}

}  // namespace

absl::StatusOr<UpstreamAnswer> SendToPrinter(const Printer& printer, const std::string& api_key,
                                             const PrinterUpload& upload, const SpoolFile& file,
                                             const UpstreamLimits& limits) {
  if (printer.kind == PrinterKind::kOctoPrint) {
    return SendForm(printer, "/api/files/" + upload.storage, api_key, upload, file, limits);
  }
  absl::StatusOr<UpstreamAnswer> answer =
      printer.kind == PrinterKind::kMoonraker
          ? SendForm(printer, "/server/files/upload", api_key, upload, file, limits)
          : PutFile(printer, api_key, upload, file, limits);
  if (answer.ok() && answer->status / 100 == 2) SayAsOctoPrint(upload, *answer);
  return answer;
}

absl::StatusOr<UpstreamAnswer> AskVersion(const Printer& printer, const std::string& api_key,
                                          const UpstreamLimits& limits) {
  const bool moonraker = printer.kind == PrinterKind::kMoonraker;
  Call call(printer, moonraker ? "/server/info" : "/api/version", api_key, limits);
  absl::StatusOr<UpstreamAnswer> answer = call.Run(printer);
  if (!answer.ok() || answer->status != 200 || !moonraker) return answer;
  const Json json = JsonObject{{"api", "0.1"},
                               {"server", "1.9.0"},
                               {"text", absl::StrCat("OctoPrint 1.9.0 (traverse-gateway ", kVersion,
                                                     " before a Moonraker)")}};
  answer->content_type = "application/json";
  answer->body = JsonText(json) + "\n";
  return answer;
}

}  // namespace traverse::gateway

#include "client/gateway/api/upload.h"

#include <algorithm>
#include <optional>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_format.h"
#include "client/gateway/http/multipart.h"
#include "client/gateway/http/problem.h"

namespace traverse::gateway {
namespace {

constexpr size_t kMaxFieldBytes = 4096;
constexpr uint64_t kMaxFormBytes = 65536;  // of a form, besides its files

HttpResponse TooLong(uint64_t max_bytes) {
  return Problem(413, absl::StrFormat("the file is longer than %d bytes", max_bytes));
}

// The status tells a full spool from a malformed form.
HttpResponse FaultOf(const absl::Status& status) {
  if (absl::IsResourceExhausted(status)) return Problem(507, std::string(status.message()));
  return ProblemOf(status);
}

// The base of both kinds of body, which puts files into the spool.
class UploadSink : public BodySink {
 public:
  UploadSink(Spool& spool, const UploadLimits& limits, UploadDone done)
      : spool_(spool), limits_(limits), done_(std::move(done)) {}

 protected:
  absl::Status BeginFile(std::string field, std::string name) {
    if (absl::Status status = CountFile(field); !status.ok()) return status;
    absl::StatusOr<std::shared_ptr<SpoolFile>> file = spool_.NewFile(limits_.caller);
    if (!file.ok()) return file.status();
    upload_.files.push_back({std::move(field), std::move(name), *std::move(file)});
    return absl::OkStatus();
  }

  absl::Status Append(std::string_view bytes) {
    const Upload::File& upload = upload_.files.back();
    const uint64_t size = upload.file->size() + bytes.size();
    const auto small = limits_.small_files.find(upload.field);
    if (small != limits_.small_files.end()) {
      if (size > small->second) {
        return absl::InvalidArgumentError(
            absl::StrFormat("%s: longer than %d bytes", upload.field, small->second));
      }
    } else if (size > limits_.max_file_bytes) {
      return absl::OutOfRangeError(
          absl::StrFormat("the file is longer than %d bytes", limits_.max_file_bytes));
    }
    return upload.file->Append(bytes);
  }

  Spool& spool_;
  const UploadLimits limits_;
  const UploadDone done_;
  Upload upload_;

 private:
  absl::Status CountFile(const std::string& field) {
    if (limits_.small_files.contains(field)) {
      const bool twice = std::any_of(upload_.files.begin(), upload_.files.end(),
                                     [&](const Upload::File& file) { return file.field == field; });
      return twice ? absl::InvalidArgumentError(absl::StrFormat("%s: given twice", field))
                   : absl::OkStatus();
    }
    if (++large_files_ <= limits_.max_files) return absl::OkStatus();
    return absl::InvalidArgumentError(absl::StrFormat("more than %d file%s", limits_.max_files,
                                                      limits_.max_files == 1 ? ": send one" : "s"));
  }

  size_t large_files_ = 0;
};

uint64_t MaxFormBytes(const UploadLimits& limits) {
  uint64_t most = limits.max_files * limits.max_file_bytes + kMaxFormBytes;
  for (const auto& [field, bytes] : limits.small_files) most += bytes;
  return most;
}

// The body is the file.
class RawSink : public UploadSink {
 public:
  using UploadSink::UploadSink;

  std::optional<HttpResponse> Take(std::string_view piece) override {
    if (upload_.files.empty()) {
      if (absl::Status status = BeginFile("", ""); !status.ok()) return FaultOf(status);
    }
    if (absl::Status status = Append(piece); !status.ok()) return FaultOf(status);
    return std::nullopt;
  }

  void Done(std::shared_ptr<HttpReply> reply) override {
    done_(std::move(upload_), std::move(reply));
  }
};

// The body is a form.
class FormSink : public UploadSink, private PartSink {
 public:
  FormSink(const std::string& boundary, Spool& spool, const UploadLimits& limits, UploadDone done)
      : UploadSink(spool, limits, std::move(done)), reader_(boundary, *this) {}

  std::optional<HttpResponse> Take(std::string_view piece) override {
    received_ += piece.size();
    if (absl::Status status = reader_.Feed(piece); !status.ok()) return FaultOf(status);
    // Limits the bytes between the parts too.
    if (received_ > MaxFormBytes(limits_)) {
      return TooLong(limits_.max_file_bytes);
    }
    return std::nullopt;
  }

  void Done(std::shared_ptr<HttpReply> reply) override {
    if (absl::Status status = reader_.Finish(); !status.ok()) {
      reply->Send(FaultOf(status));
      return;
    }
    done_(std::move(upload_), std::move(reply));
  }

 private:
  absl::Status BeginPart(const PartHead& head) override {
    in_file_ = head.filename.has_value();
    if (in_file_) return BeginFile(head.name, *head.filename);
    upload_.fields.emplace_back(head.name, "");
    return absl::OkStatus();
  }

  absl::Status TakePart(std::string_view bytes) override {
    if (in_file_) return Append(bytes);
    auto& [name, value] = upload_.fields.back();
    if (value.size() + bytes.size() > kMaxFieldBytes) {
      return absl::InvalidArgumentError(
          absl::StrFormat("field \"%s\" is longer than %d bytes", name, kMaxFieldBytes));
    }
    value.append(bytes);
    return absl::OkStatus();
  }

  absl::Status EndPart() override { return absl::OkStatus(); }

  MultipartReader reader_;
  bool in_file_ = false;
  uint64_t received_ = 0;
};

}  // namespace

HttpDecision TakeUpload(const HttpRequest& request, Spool& spool, const UploadLimits& limits,
                        UploadDone done) {
  const std::string encoding = absl::AsciiStrToLower(request.Header("content-encoding"));
  if (!encoding.empty() && encoding != "identity" && encoding != "gzip" && encoding != "x-gzip") {
    HttpResponse refusal = Problem(415, "the body's encoding is neither identity nor gzip");
    refusal.headers.emplace_back("Accept-Encoding", "gzip, identity");
    return refusal;
  }
  const std::string type = request.Header("content-type");
  const bool form = absl::StartsWithIgnoreCase(type, "multipart/");
  if (form && !encoding.empty() && encoding != "identity") {
    return Problem(415, "a form may not be encoded as a whole; a file in it may be gzip");
  }
  const uint64_t most = form ? MaxFormBytes(limits) : limits.max_file_bytes;
  if (request.content_length && *request.content_length > most) {
    return TooLong(limits.max_file_bytes);
  }
  if (!form) return std::make_unique<RawSink>(spool, limits, std::move(done));
  const absl::StatusOr<std::string> boundary = BoundaryOf(type);
  if (!boundary.ok()) return ProblemOf(boundary.status());
  return std::make_unique<FormSink>(*boundary, spool, limits, std::move(done));
}

}  // namespace traverse::gateway

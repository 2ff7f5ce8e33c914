#include "client/gateway/http/multipart.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/str_format.h"

namespace traverse::gateway {
namespace {

constexpr size_t kMaxBoundary = 70;  // RFC 2046
constexpr size_t kMaxPadding = 256;  // blanks after a boundary

absl::Status Fault(std::string what) {
  return absl::InvalidArgumentError("multipart body: " + std::move(what));
}

// Parameters of a header: `form-data; name="a"; filename="b"`. Names are in small letters.
// Backslashes before quotes are removed; others stay, because browsers escape quotes as %22 and
// leave the backslashes of Windows alone.
struct HeaderValue {
  std::string value;  // before the first semicolon, in small letters
  std::vector<std::pair<std::string, std::string>> parameters;

  const std::string* Find(const std::string& name) const {
    for (const auto& [key, value] : parameters) {
      if (key == name) return &value;
    }
    return nullptr;
  }
};

// The quoted string that begins at `at`; moves `at` past it. Nothing if the string does not end.
std::optional<std::string> Quoted(std::string_view text, size_t& at) {
  std::string out;
  for (++at; at < text.size(); ++at) {
    if (text[at] == '"') {
      ++at;
      return out;
    }
    const bool escape = text[at] == '\\' && at + 1 < text.size() && text[at + 1] == '"';
    if (escape) ++at;
    out += text[at];
  }
  return std::nullopt;
}

std::string Trimmed(std::string_view text) {
  return std::string(absl::StripAsciiWhitespace(std::string(text)));
}

std::optional<HeaderValue> ParseHeaderValue(std::string_view text) {
  HeaderValue out;
  size_t at = std::min(text.find(';'), text.size());
  out.value = absl::AsciiStrToLower(Trimmed(text.substr(0, at)));
  while (at < text.size()) {
    ++at;  // the semicolon
    const size_t end = std::min(text.find_first_of("=;", at), text.size());
    const std::string name = absl::AsciiStrToLower(Trimmed(text.substr(at, end - at)));
    at = end;
    if (at >= text.size() || text[at] == ';') {
      if (!name.empty()) return std::nullopt;
      continue;
    }
    ++at;  // the equals sign
    while (at < text.size() && text[at] == ' ') ++at;
    std::string value;
    if (at < text.size() && text[at] == '"') {
      std::optional<std::string> quoted = Quoted(text, at);
      if (!quoted) return std::nullopt;
      value = *std::move(quoted);
      if (!Trimmed(text.substr(at, std::min(text.find(';', at), text.size()) - at)).empty()) {
        return std::nullopt;
      }
      at = std::min(text.find(';', at), text.size());
    } else {
      const size_t stop = std::min(text.find(';', at), text.size());
      value = Trimmed(text.substr(at, stop - at));
      at = stop;
    }
    if (out.Find(name) != nullptr) return std::nullopt;  // nobody knows which of the two counts
    out.parameters.emplace_back(name, std::move(value));
  }
  return out;
}

absl::StatusOr<PartHead> ParsePartHead(std::string_view head) {
  std::optional<HeaderValue> disposition;
  while (!head.empty()) {
    const size_t end = std::min(head.find("\r\n"), head.size());
    const std::string_view line = head.substr(0, end);
    head.remove_prefix(std::min(end + 2, head.size()));
    const size_t colon = line.find(':');
    if (colon == std::string_view::npos) return Fault("a line of a part's head has no colon");
    const std::string name = absl::AsciiStrToLower(Trimmed(line.substr(0, colon)));
    if (name == "content-transfer-encoding") {
      const std::string encoding = absl::AsciiStrToLower(Trimmed(line.substr(colon + 1)));
      if (encoding != "binary" && encoding != "8bit" && encoding != "7bit") {
        return Fault("a part has a transfer encoding");
      }
    }
    if (name != "content-disposition") continue;
    if (disposition) return Fault("a part has two dispositions");
    disposition = ParseHeaderValue(line.substr(colon + 1));
    if (!disposition) return Fault("a part's disposition cannot be read");
  }
  if (!disposition || disposition->value != "form-data") return Fault("a part is not form data");
  const std::string* name = disposition->Find("name");
  if (name == nullptr) return Fault("a part has no name");
  PartHead out;
  out.name = *name;
  if (const std::string* filename = disposition->Find("filename")) out.filename = *filename;
  return out;
}

}  // namespace

absl::StatusOr<std::string> BoundaryOf(const std::string& content_type) {
  const std::optional<HeaderValue> value = ParseHeaderValue(content_type);
  const std::string* boundary = value ? value->Find("boundary") : nullptr;
  if (!value || value->value != "multipart/form-data" || boundary == nullptr) {
    return Fault("its Content-Type has no boundary");
  }
  const bool printable = std::all_of(boundary->begin(), boundary->end(), [](char c) {
    return absl::ascii_isprint(static_cast<unsigned char>(c)) && c != '"';
  });
  if (boundary->empty() || boundary->size() > kMaxBoundary || !printable) {
    return Fault("its boundary is not of 1 to 70 printable characters");
  }
  return *boundary;
}

// The first boundary may be at the very beginning: pretends that a line break came before it.
MultipartReader::MultipartReader(const std::string& boundary, PartSink& sink)
    : boundary_("\r\n--" + boundary), sink_(sink), buffered_("\r\n") {}

absl::Status MultipartReader::Feed(std::string_view bytes) {
  if (state_ == State::kEpilogue) return absl::OkStatus();
  buffered_.append(bytes);
  while (true) {
    absl::StatusOr<bool> more = Step();
    if (!more.ok()) return more.status();
    if (!*more) return absl::OkStatus();
  }
}

absl::Status MultipartReader::Finish() const {
  if (state_ == State::kEpilogue) return absl::OkStatus();
  return Fault("cut short, its last boundary is missing");
}

absl::StatusOr<bool> MultipartReader::Step() {
  switch (state_) {
    case State::kPreamble: {
      const size_t at = buffered_.find(boundary_);
      if (at == std::string::npos) {
        if (buffered_.size() > kMaxHeadBytes) return Fault("no boundary at its beginning");
        return false;
      }
      buffered_.erase(0, at + boundary_.size());
      state_ = State::kAfterBoundary;
      return true;
    }
    case State::kAfterBoundary:
      return StepAfterBoundary();
    case State::kHead:
      return StepHead();
    case State::kBody:
      return StepBody();
    case State::kEpilogue:
      break;
  }
  buffered_.clear();
  return false;
}

// "--" ends the body; blanks and a line break begin a part.
absl::StatusOr<bool> MultipartReader::StepAfterBoundary() {
  if (buffered_.size() < 2) return false;
  if (buffered_.compare(0, 2, "--") == 0) {
    state_ = State::kEpilogue;
    return true;
  }
  const size_t end = buffered_.find("\r\n");
  const size_t blanks = buffered_.find_first_not_of(" \t");
  if (blanks != std::string::npos && buffered_[blanks] != '\r') return Fault("a bad boundary");
  if (end == std::string::npos) {
    if (buffered_.size() > kMaxPadding) return Fault("a bad boundary");
    return false;
  }
  if (end != blanks) return Fault("a bad boundary");
  if (++parts_ > kMaxParts) return Fault(absl::StrFormat("more than %d parts", kMaxParts));
  buffered_.erase(0, end);  // the line break stays: an empty head is "\r\n\r\n" too
  state_ = State::kHead;
  return true;
}

absl::StatusOr<bool> MultipartReader::StepHead() {
  const size_t end = buffered_.find("\r\n\r\n");
  if (std::min(end, buffered_.size()) > kMaxHeadBytes) {
    return Fault(absl::StrFormat("the head of a part is longer than %d bytes", kMaxHeadBytes));
  }
  if (end == std::string::npos) return false;
  if (end == 0) return Fault("a part is not form data");
  absl::StatusOr<PartHead> head = ParsePartHead(std::string_view(buffered_).substr(2, end - 2));
  if (!head.ok()) return head.status();
  if (absl::Status status = sink_.BeginPart(*head); !status.ok()) return status;
  buffered_.erase(0, end + 4);
  state_ = State::kBody;
  return true;
}

absl::StatusOr<bool> MultipartReader::StepBody() {
  const size_t at = buffered_.find(boundary_);
  if (at == std::string::npos) {
    // Keeps the bytes that may begin a boundary.
    const size_t keep = boundary_.size() - 1;
    if (buffered_.size() <= keep) return false;
    const size_t sure = buffered_.size() - keep;
    absl::Status status = sink_.TakePart(std::string_view(buffered_).substr(0, sure));
    buffered_.erase(0, sure);
    if (!status.ok()) return status;
    return false;
  }
  if (at > 0) {
    absl::Status status = sink_.TakePart(std::string_view(buffered_).substr(0, at));
    if (!status.ok()) return status;
  }
  if (absl::Status status = sink_.EndPart(); !status.ok()) return status;
  buffered_.erase(0, at + boundary_.size());
  state_ = State::kAfterBoundary;
  return true;
}

}  // namespace traverse::gateway

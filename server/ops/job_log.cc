#include "server/ops/job_log.h"

#include <spdlog/async.h>
#include <spdlog/async_logger.h>

#include <nlohmann/json.hpp>
#include <string_view>

#include "absl/strings/str_format.h"
#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "server/ops/log_file.h"

namespace traverse {
namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kQueuedLines = 8192;

Json NewLine(const char* level, const std::string& event) {
  Json line;
  line["time"] = absl::FormatTime("%Y-%m-%dT%H:%M:%E3SZ", absl::Now(), absl::UTCTimeZone());
  line["level"] = level;
  line["event"] = event;
  return line;
}

// Characters that JSON may hold as they are, but that a terminal takes for commands (U+007F to
// U+009F), some readers for the end of a line (U+2028, U+2029), or that turn the direction of the
// text behind them, so that a line seems to say something else (the rest).
struct Escape {
  std::string_view prefix;  // of their UTF-8
  unsigned char first;      // the last byte
  unsigned char last;
  unsigned code_of_first;
};
constexpr Escape kEscapes[] = {{"", 0x7f, 0x7f, 0x7f},           {"\xc2", 0x80, 0x9f, 0x80},
                               {"\xd8", 0x9c, 0x9c, 0x061c},     {"\xe2\x80", 0x8e, 0x8f, 0x200e},
                               {"\xe2\x80", 0xa8, 0xae, 0x2028}, {"\xe2\x81", 0xa6, 0xa9, 0x2066}};

std::string Escaped(const std::string& json) {
  std::string text;
  text.reserve(json.size());
  for (size_t i = 0; i < json.size(); ++i) {
    text.push_back(json[i]);
    const auto last = static_cast<unsigned char>(json[i]);
    for (const Escape& escape : kEscapes) {
      if (last < escape.first || last > escape.last) continue;
      const size_t size = escape.prefix.size() + 1;
      if (text.size() < size || text.compare(text.size() - size, size - 1, escape.prefix) != 0) {
        continue;
      }
      text.resize(text.size() - size);
      text += absl::StrFormat("\\u%04x", escape.code_of_first + last - escape.first);
      break;
    }
  }
  return text;
}

// All of these characters are inside strings, because only there JSON leaves ASCII.
std::string Dump(const Json& json) {
  return Escaped(json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

// What a caller sent may be part of a message.
constexpr size_t kMaxMessageBytes = 512;

std::string Shortened(std::string text) {
  if (text.size() <= kMaxMessageBytes) return text;
  text.resize(kMaxMessageBytes);  // half a character is replaced when it is written
  return text + "...";
}

const char* LevelName(JobLog::Level level) {
  switch (level) {
    case JobLog::Level::kInfo:
      return "info";
    case JobLog::Level::kWarning:
      return "warning";
    case JobLog::Level::kError:
      return "error";
  }
  return "info";
}

// A fault of ours, or one that needs somebody's attention, stands out.
JobLog::Level LevelOf(const JobRecord& record) {
  if (record.status.code() == absl::StatusCode::kInternal || record.invalid_routes > 0) {
    return JobLog::Level::kError;
  }
  return record.status.ok() ? JobLog::Level::kInfo : JobLog::Level::kWarning;
}

}  // namespace

std::string FormatJobLine(const JobRecord& record) {
  Json line = NewLine(LevelName(LevelOf(record)), "job");
  line["job_id"] = record.job_id;
  line["method"] = record.method;
  line["caller"] = record.caller;
  line["peer"] = record.peer;
  if (!record.trace_id.empty()) line["trace_id"] = record.trace_id;
  line["strategy"] = record.strategy;
  line["code"] = absl::StatusCodeToString(record.status.code());
  if (!record.status.ok()) line["message"] = Shortened(std::string(record.status.message()));
  line["layers_received"] = record.layers_received;
  line["layers"] = record.layers;
  line["points"] = record.points;
  line["queue_seconds"] = record.queue_seconds;
  line["compute_seconds"] = record.compute_seconds;
  line["wall_seconds"] = record.wall_seconds;
  line["travel_given_mm"] = record.travel_given_mm;
  line["travel_mm"] = record.travel_mm;
  line["idle_seconds_saved"] = record.idle_seconds_saved;
  if (record.invalid_routes > 0) line["invalid_routes"] = record.invalid_routes;
  return Dump(line);
}

JobLog::JobLog(const std::string& path) {
  writer_ = std::make_shared<spdlog::details::thread_pool>(kQueuedLines, 1);
  file_ = std::make_shared<LogFile>(path);
  logger_ = std::make_shared<spdlog::async_logger>("traverse", file_, writer_,
                                                   spdlog::async_overflow_policy::overrun_oldest);
  logger_->set_pattern("%v");
  logger_->flush_on(spdlog::level::info);
}

JobLog::~JobLog() {
  if (file_ != nullptr) file_->End();
}

void JobLog::Job(const JobRecord& record) {
  if (logger_ == nullptr) return;
  Write(LevelOf(record), FormatJobLine(record));
}

void JobLog::Event(Level level, const std::string& event, const Fields& fields) {
  if (logger_ == nullptr) return;
  Json line = NewLine(LevelName(level), event);
  for (const auto& [key, value] : fields) line[key] = value;
  Write(level, Dump(line));
}

bool JobLog::Reopen() { return file_ == nullptr || file_->Reopen(); }

uint64_t JobLog::lost_lines() const {
  return logger_ == nullptr ? 0 : writer_->overrun_counter() + file_->lost();
}

void JobLog::Write(Level level, const std::string& line) {
  const auto severity = level == Level::kInfo      ? spdlog::level::info
                        : level == Level::kWarning ? spdlog::level::warn
                                                   : spdlog::level::err;
  // As an argument: a line is data, not a format.
  logger_->log(severity, "{}", line);
}

}  // namespace traverse

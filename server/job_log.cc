#include "server/job_log.h"

#include <spdlog/async.h>
#include <spdlog/async_logger.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_sinks.h>

#include <nlohmann/json.hpp>

#include "absl/time/clock.h"
#include "absl/time/time.h"

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

std::string Dump(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
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

std::string JsonString(const std::string& text) { return Dump(Json(text)); }

std::string FormatJobLine(const JobRecord& record) {
  Json line = NewLine(LevelName(LevelOf(record)), "job");
  line["job_id"] = record.job_id;
  line["method"] = record.method;
  line["caller"] = record.caller;
  line["peer"] = record.peer;
  if (!record.trace_id.empty()) line["trace_id"] = record.trace_id;
  line["strategy"] = record.strategy;
  line["code"] = absl::StatusCodeToString(record.status.code());
  if (!record.status.ok()) line["message"] = std::string(record.status.message());
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
  spdlog::sink_ptr sink;
  if (path.empty()) {
    sink = std::make_shared<spdlog::sinks::stderr_sink_mt>();
  } else {
    sink = std::make_shared<spdlog::sinks::basic_file_sink_mt>(path);
  }
  logger_ = std::make_shared<spdlog::async_logger>("traverse", std::move(sink), writer_,
                                                   spdlog::async_overflow_policy::overrun_oldest);
  logger_->set_pattern("%v");
  logger_->flush_on(spdlog::level::info);
}

JobLog::~JobLog() = default;

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

void JobLog::Write(Level level, const std::string& line) {
  const auto severity = level == Level::kInfo      ? spdlog::level::info
                        : level == Level::kWarning ? spdlog::level::warn
                                                   : spdlog::level::err;
  // As an argument: a line is data, not a format.
  logger_->log(severity, "{}", line);
}

}  // namespace traverse

#include "client/gcode/stated_times.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/gcode/dialects/dialect.h"
#include "client/gcode/machine/progress_line.h"
#include "client/gcode/text/decimal.h"
#include "client/gcode/text/digest_line.h"
#include "client/gcode/text/text.h"
#include "client/gcode/verify/verifier.h"

namespace traverse::gcode {
namespace {

constexpr std::string_view kRestated = "times restated x";

absl::string_view AsAbsl(std::string_view text) { return {text.data(), text.size()}; }

// Seconds of a "1d 2h 3m 4s", of which any part may be missing.
std::optional<int64_t> ParseDuration(std::string_view text) {
  constexpr std::string_view kUnits = "dhms";
  constexpr std::array<int64_t, 4> kSeconds = {86400, 3600, 60, 1};
  constexpr int64_t kMost = int64_t{1} << 40;
  int64_t seconds = 0;
  size_t unit = 0;
  bool any = false;
  while (!(text = TrimBlanks(text)).empty()) {
    int64_t number = 0;
    size_t digits = 0;
    while (digits < text.size() && IsDigit(text[digits]) && number < kMost) {
      number = 10 * number + (text[digits++] - '0');
    }
    if (digits == 0 || digits == text.size() || number >= kMost) return std::nullopt;
    unit = kUnits.find(text[digits], unit);
    if (unit == std::string_view::npos) return std::nullopt;
    seconds += number * kSeconds[unit++];
    text.remove_prefix(digits + 1);
    any = true;
  }
  return any ? std::optional(seconds) : std::nullopt;
}

int64_t Scaled(int64_t seconds, double factor) {
  return std::llround(static_cast<double>(seconds) * factor);
}

// As slicers write it: from the first part that is not 0 on.
std::string FormatDuration(int64_t seconds) {
  if (seconds >= 86400) {
    return absl::StrFormat("%dd %dh %dm %ds", seconds / 86400, seconds / 3600 % 24,
                           seconds / 60 % 60, seconds % 60);
  }
  if (seconds >= 3600) {
    return absl::StrFormat("%dh %dm %ds", seconds / 3600, seconds / 60 % 60, seconds % 60);
  }
  if (seconds >= 60) return absl::StrFormat("%dm %ds", seconds / 60, seconds % 60);
  return absl::StrFormat("%ds", seconds);
}

// A number with as many decimals as it had.
std::optional<std::string> ScaleNumber(std::string_view value, double factor) {
  const size_t point = value.find('.');
  double number = 0;
  const bool plain = !value.empty() && value.find_first_not_of("0123456789.") == value.npos;
  if (!plain || !absl::SimpleAtod(AsAbsl(value), &number)) return std::nullopt;
  constexpr size_t kMost = 9;
  const size_t decimals =
      point == std::string_view::npos ? 0 : std::min(value.size() - point - 1, kMost);
  return absl::StrFormat("%.*f", static_cast<int>(decimals), number * factor);
}

// `line` with `value`, a part of it, scaled; the line itself if the value is not a time.
std::string WithScaled(std::string_view line, std::string_view value, double factor) {
  const std::optional<std::string> scaled = ScaleDuration(value, factor);
  if (!scaled) return std::string(line);
  const auto begin = static_cast<size_t>(value.data() - line.data());
  return std::string(line).replace(begin, value.size(), *scaled);
}

// `; model printing time: 1m 6s; total estimated time: 9m 3s`: the rest of the second, heating and
// so on, stays as it is.
std::string RestateModelTime(std::string_view line, double factor) {
  constexpr std::string_view kModel = "model printing time:";
  constexpr std::string_view kTotal = "total estimated time:";
  const size_t model_begin = line.find(kModel) + kModel.size();
  const size_t model_end = line.find(';', model_begin);
  const std::string_view model = TrimBlanks(line.substr(model_begin, model_end - model_begin));
  const std::optional<int64_t> model_seconds = ParseDuration(model);
  if (!model_seconds) return std::string(line);
  std::string out = WithScaled(line, model, factor);
  const size_t total_begin = out.find(kTotal);
  if (total_begin == std::string::npos) return out;
  const std::string_view total =
      TrimBlanks(std::string_view(out).substr(total_begin + kTotal.size()));
  const std::optional<int64_t> total_seconds = ParseDuration(total);
  if (!total_seconds) return out;
  const auto at = static_cast<size_t>(total.data() - out.data());
  return out.replace(at, total.size(),
                     FormatDuration(std::max<int64_t>(
                         0, *total_seconds - *model_seconds + Scaled(*model_seconds, factor))));
}

double ScaleOf(const TimeWord& stated, const TimeScale& scale) {
  return stated.first_layer ? scale.first_layer : scale.total;
}

std::string RestateComment(std::string_view line, const TimeScale& scale) {
  const std::string_view comment = TrimBlanks(line.substr(1));
  if (comment.starts_with("model printing time:")) return RestateModelTime(line, scale.total);
  const TimeWord* stated = TimeOf(comment);
  const size_t mark = stated == nullptr ? comment.npos : comment.find_first_of(":=");
  if (mark == comment.npos) return std::string(line);
  return WithScaled(line, TrimBlanks(comment.substr(mark + 1)), ScaleOf(*stated, scale));
}

// Minutes left are whole ones, rounded down.
std::string RestateProgress(std::string_view line, double factor) {
  std::string out;
  const std::string_view words = line.substr(0, line.find(';'));
  for (size_t at = 0; at < words.size();) {
    const bool minutes = at > 0 && words[at - 1] == ' ' &&
                         std::string_view("RSCD").find(words[at]) != std::string_view::npos;
    out += words[at++];
    if (!minutes) continue;
    size_t end = at;
    while (end < words.size() && IsDigit(words[end])) ++end;
    int64_t number = 0;
    if (end == at || !absl::SimpleAtoi(AsAbsl(words.substr(at, end - at)), &number)) continue;
    constexpr double kMiddle = 0.5;  // of the minute for which the number stands
    out += absl::StrFormat("%d",
                           static_cast<int64_t>((static_cast<double>(number) + kMiddle) * factor));
    at = end;
  }
  out += line.substr(words.size());
  return out;
}

// `1:02:03` or `02:03`: the parts behind the first have two digits.
std::optional<std::string> ScaleClock(std::string_view clock, double factor) {
  constexpr int64_t kBase = 60;
  constexpr size_t kMostDigits = 5;
  const size_t first = clock.find(':');
  const size_t parts = first == 0 || first > kMostDigits ? 0 : (clock.size() - first) / 3;
  if (parts == 0 || parts > 2 || clock.size() != first + 3 * parts) return std::nullopt;
  int64_t seconds = 0;
  int64_t part = 0;
  for (size_t i = 0; i < clock.size(); ++i) {
    const bool colon = i >= first && (i - first) % 3 == 0;
    if (colon != (clock[i] == ':')) return std::nullopt;
    part = colon ? 0 : 10 * part + (clock[i] - '0');
    const bool ends = i + 1 == clock.size() || clock[i + 1] == ':';
    if (ends) seconds = kBase * seconds + part;
  }
  seconds = Scaled(seconds, factor);
  std::string scaled;
  for (size_t i = 0; i < parts; ++i, seconds /= kBase) {
    scaled = absl::StrFormat(":%02d", seconds % kBase) + scaled;
  }
  return absl::StrFormat("%0*d", static_cast<int>(first), seconds) + scaled;
}

// `1h2m3s`, or with blanks between its parts.
std::optional<std::string> ScaleSpan(std::string_view span, double factor) {
  std::optional<std::string> scaled =
      ParseDuration(span) ? ScaleDuration(span, factor) : std::nullopt;
  if (scaled && span.find(' ') == std::string_view::npos) {
    std::erase(*scaled, ' ');
  }
  return scaled;
}

// `M117 Time left 1h 2m 3s`: the first time in a message that tells what is left or elapsed.
std::string RestateMessage(std::string_view line, double factor) {
  constexpr std::string_view kOfTimes = "0123456789:dhms ";
  for (size_t at = 0; at < line.size(); ++at) {
    if (!IsDigit(line[at]) || (line[at - 1] != ' ' && line[at - 1] != '=' && line[at - 1] != '"')) {
      continue;
    }
    // A blank may also end it.
    size_t end = std::min(line.find_first_not_of(kOfTimes, at), line.size());
    for (; end > at; end = line.find_last_of(' ', end - 1)) {
      const std::string_view time = TrimBlanks(line.substr(at, end - at));
      std::optional<std::string> scaled = ScaleClock(time, factor);
      if (!scaled) scaled = ScaleSpan(time, factor);
      if (scaled) return std::string(line).replace(at, time.size(), *scaled);
      if (line.find_last_of(' ', end - 1) == std::string_view::npos) break;
    }
  }
  return std::string(line);
}

// A message of progress, but for one that only states a share.
bool TellsTime(std::string_view line) {
  if (line.empty() || (line[0] != 'M' && line[0] != 'S')) return false;
  if (!line.starts_with("M117 ") && !line.starts_with("M118 ") && !IsProgressMacro(line))
    return false;
  return IsProgressMessage(line.substr(line.find(' ')));
}

std::string RestateLines(std::string_view text, const TimeScale& scale) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    if (line.starts_with(';')) {
      out += RestateComment(line, scale);
    } else if (line.starts_with("M73 ")) {
      out += RestateProgress(line, scale.total);
    } else if (TellsTime(line)) {
      out += RestateMessage(line, scale.total);
    } else {
      out += line;
    }
    if (end < text.size()) out += '\n';
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

}  // namespace

size_t FindMark(std::string_view text) {
  if (text.starts_with(kOptimisedMark)) return 0;
  const size_t before = text.find("\n" + std::string(kOptimisedMark));
  return before == std::string_view::npos ? before : before + 1;
}

std::string DescribeScale(const TimeScale& scale) {
  return absl::StrFormat("%s%.6f, first layer x%.6f", AsAbsl(kRestated), scale.total,
                         scale.first_layer);
}

TimeScale RoundScale(const TimeScale& scale) {
  return StatedScale(absl::StrCat(AsAbsl(kOptimisedMark), " ", DescribeScale(scale)))
      .value_or(scale);
}

std::optional<TimeScale> StatedScale(std::string_view text) {
  const size_t mark = FindMark(text);
  if (mark == std::string_view::npos) return std::nullopt;
  const std::string_view line = text.substr(mark, text.find('\n', mark) - mark);
  size_t at = line.find(kRestated);
  if (at == std::string_view::npos) return std::nullopt;
  const auto number = [&](size_t begin) {
    double value = 0;
    const size_t end = std::min(line.find_first_not_of("0123456789.", begin), line.size());
    const bool good = absl::SimpleAtod(AsAbsl(line.substr(begin, end - begin)), &value);
    return good && value > 0 && std::isfinite(value) ? value : 1;
  };
  constexpr std::string_view kFirst = "first layer x";
  TimeScale scale;
  scale.total = number(at + kRestated.size());
  at = line.find(kFirst, at);
  if (at != std::string_view::npos) scale.first_layer = number(at + kFirst.size());
  return scale;
}

std::optional<std::string> ScaleDuration(std::string_view value, double factor) {
  if (const std::optional<int64_t> seconds = ParseDuration(value)) {
    return FormatDuration(Scaled(*seconds, factor));
  }
  return ScaleNumber(value, factor);
}

std::string RestateTimes(std::string_view text, const TimeScale& scale) {
  std::string out = RestateLines(text, scale);
  if (StatesItsDigest(text)) RenewDigest(out);
  return out;
}

std::string RestateOptimised(std::string_view text, const TimeScale& scale) {
  std::string out = RestateLines(text, scale);
  if (const size_t mark = FindMark(out); mark != std::string::npos) {
    size_t end = std::min(out.find('\n', mark), out.size());
    while (end > mark && out[end - 1] == '\r') --end;
    out.insert(end, ", " + DescribeScale(scale));
  }
  if (StatesItsDigest(text)) RenewDigest(out);
  return out;
}

std::optional<std::string> RestateEntry(std::string_view key, std::string_view value,
                                        const TimeScale& scale) {
  const TimeWord* stated = TimeOf(key);
  return stated == nullptr ? std::nullopt
                           : ScaleDuration(TrimBlanks(value), ScaleOf(*stated, scale));
}

}  // namespace traverse::gcode

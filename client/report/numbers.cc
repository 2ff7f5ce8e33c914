#include "client/report/numbers.h"

#include <cmath>
#include <cstdint>

#include "absl/strings/str_format.h"

namespace traverse::report {

double GainPercent(double before, double after) {
  if (before == after) return 0;
  return before > 0 ? 100 * (before - after) / before : -100;
}

std::string Change(double before, double after) {
  const double gain = GainPercent(before, after);
  constexpr double kRoundsToNothing = 0.05;
  if (std::abs(gain) < kRoundsToNothing) return "the same";
  return absl::StrFormat("%.1f %% %s", std::abs(gain), gain > 0 ? "less" : "more");
}

std::string Duration(double seconds) {
  if (seconds < 9.95) return absl::StrFormat("%.1f s", seconds);
  const int64_t s = std::llround(seconds);
  if (s < 60) return absl::StrFormat("%d s", s);
  if (s < 3600) return absl::StrFormat("%d min %d s", s / 60, s % 60);
  const int64_t minutes = std::llround(seconds / 60);
  if (minutes < 24 * 60) return absl::StrFormat("%d h %d min", minutes / 60, minutes % 60);
  const int64_t hours = std::llround(seconds / 3600);
  return absl::StrFormat("%d d %d h", hours / 24, hours % 24);
}

std::string Length(double mm) {
  if (mm < 9999.95) return absl::StrFormat("%.1f mm", mm);
  const double m = mm / 1000;
  if (m < 99.995) return absl::StrFormat("%.2f m", m);
  if (m < 9999.95) return absl::StrFormat("%.1f m", m);
  return absl::StrFormat("%.2f km", m / 1000);
}

}  // namespace traverse::report

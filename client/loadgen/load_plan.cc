#include "client/loadgen/load_plan.h"

#include <algorithm>
#include <cmath>

#include "absl/status/status.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_split.h"

namespace traverse::loadgen {
namespace {

constexpr int kMaxLayers = 1'000'000;

// In [0, 1).
double Fraction(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1.0p-53; }

}  // namespace

absl::StatusOr<std::vector<SizeShare>> ParseMix(const std::string& text) {
  std::vector<SizeShare> mix;
  const std::vector<std::string> parts = absl::StrSplit(text, ',');
  for (const std::string& part : parts) {
    const std::vector<std::string> pair = absl::StrSplit(part, ':');
    SizeShare share;
    const bool number = !pair.front().empty() && absl::SimpleAtoi(pair.front(), &share.layers);
    const bool weight = pair.size() == 1 || absl::SimpleAtod(pair.back(), &share.weight);
    if (!number || !weight || pair.size() > 2 || share.layers < 1 || share.layers > kMaxLayers ||
        !(share.weight > 0) || !std::isfinite(share.weight)) {
      return absl::InvalidArgumentError(
          absl::StrFormat("\"%s\" is not LAYERS:WEIGHT, such as 10:25", part));
    }
    mix.push_back(share);
  }
  return mix;
}

SizeChoice::SizeChoice(const std::vector<SizeShare>& mix, uint64_t seed) : random_(seed) {
  double sum = 0;
  for (const SizeShare& share : mix) upto_.push_back(sum += share.weight);
}

size_t SizeChoice::Next() {
  const double at = Fraction(random_) * upto_.back();
  const auto found = std::upper_bound(upto_.begin(), upto_.end() - 1, at);
  return static_cast<size_t>(found - upto_.begin());
}

std::vector<absl::Duration> SendTimes(double rate, absl::Duration duration, Arrivals arrivals,
                                      uint64_t seed) {
  std::vector<absl::Duration> times;
  const double end = absl::ToDoubleSeconds(duration);
  std::mt19937_64 random(seed);
  double at = 0;
  for (uint64_t i = 0; at < end; ++i) {
    if (arrivals == Arrivals::kPoisson) {
      at -= std::log1p(-Fraction(random)) / rate;
    } else {
      at = static_cast<double>(i) / rate;
    }
    if (at < end) times.push_back(absl::Seconds(at));
  }
  return times;
}

}  // namespace traverse::loadgen

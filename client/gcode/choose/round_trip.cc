#include "client/gcode/choose/round_trip.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

namespace traverse::gcode {
namespace {

constexpr double kLeastGainMm = 1e-6;

// Passes over the pairs that lie so near to each other in the trip; few plates have more objects.
constexpr size_t kNear = 300;
constexpr size_t kMostPasses = 50;
constexpr double kMostPairs = 3e7;

class Trip {
 public:
  explicit Trip(const std::vector<Point>& points) : points_(points), order_(points.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
  }

  bool TurnRuns() {
    bool any = false;
    for (size_t i = 1; i + 1 < size(); ++i) {
      for (size_t j = i + 1; j < std::min(size(), i + kNear); ++j) {
        const double gain = Mm(i - 1, i) + Mm(j, Next(j)) - Mm(i - 1, j) - Mm(i, Next(j));
        if (!(gain > kLeastGainMm)) continue;
        std::reverse(At(i), At(j + 1));
        any = true;
      }
    }
    return any;
  }

  bool MovePoints() {
    bool any = false;
    for (size_t i = 1; i < size(); ++i) {
      for (size_t j = i - std::min(i, kNear); j < std::min(size(), i + kNear); ++j) {
        if (j == i || j + 1 == i) continue;
        const double left = Mm(i - 1, i) + Mm(i, Next(i)) - Mm(i - 1, Next(i));
        const double added = Mm(j, i) + Mm(i, Next(j)) - Mm(j, Next(j));
        if (!(left - added > kLeastGainMm)) continue;
        if (j > i) {
          std::rotate(At(i), At(i + 1), At(j + 1));
        } else {
          std::rotate(At(j + 1), At(i), At(i + 1));
        }
        any = true;
      }
    }
    return any;
  }

  std::vector<uint32_t> Take() { return std::move(order_); }

 private:
  size_t size() const { return order_.size(); }
  size_t Next(size_t place) const { return place + 1 < size() ? place + 1 : 0; }
  std::vector<uint32_t>::iterator At(size_t place) {
    return order_.begin() + static_cast<std::ptrdiff_t>(place);
  }
  double Mm(size_t a, size_t b) const { return Distance(points_[order_[a]], points_[order_[b]]); }

  const std::vector<Point>& points_;
  std::vector<uint32_t> order_;
};

}  // namespace

std::vector<uint32_t> RoundTrip(const std::vector<Point>& points) {
  Trip trip(points);
  const size_t n = points.size();
  const auto passes =
      static_cast<size_t>(kMostPairs / static_cast<double>(n * std::min(n, kNear) + 1));
  for (size_t pass = 0; pass < std::min(passes, kMostPasses); ++pass) {
    const bool turned = trip.TurnRuns();
    if (!trip.MovePoints() && !turned) break;
  }
  return trip.Take();
}

}  // namespace traverse::gcode

#include "engine/model/tree/passed_pairs.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "absl/types/span.h"
#include "engine/base/rest.h"

namespace traverse {
namespace {

// What comes after each child by the pairs of a node, in two arrays.
class Later {
 public:
  Later(const PlanNode& node, Rest& rest)
      : first_(node.children.size() + 1), second_(node.before.size()) {
    for (const auto& [first, second] : node.before) {
      rest(2);
      ++first_[static_cast<size_t>(first) + 1];
    }
    for (size_t c = 0; c < node.children.size(); ++c) first_[c + 1] += first_[c];
    std::vector<size_t> next(first_.begin(), first_.end() - 1);
    for (const auto& [first, second] : node.before) {
      rest(4);
      second_[next[static_cast<size_t>(first)]++] = second;
    }
  }

  absl::Span<const int> operator[](size_t child) const {
    return absl::MakeConstSpan(second_).subspan(first_[child], first_[child + 1] - first_[child]);
  }

 private:
  std::vector<size_t> first_;  // [child] where its part of second_ begins; one more
  std::vector<int> second_;
};

}  // namespace

std::optional<std::vector<std::pair<int, int>>> PassedPairs(const PlanNode& node,
                                                            const std::vector<bool>& has_paths,
                                                            Budget* budget) {
  std::vector<std::pair<int, int>> pairs;
  if (node.before.empty()) return pairs;
  const size_t parts = node.children.size() + node.before.size();
  size_t steps = std::max(kPassedPairs, kPassedPairsEach * parts);
  Rest rest(budget);
  const Later later(node, rest);
  std::vector<size_t> reached_from(node.children.size(), node.children.size());
  std::vector<int> open;
  const auto follow = [&](size_t child) {
    const absl::Span<const int> after = later[child];
    if (after.size() > steps) return false;
    rest(1 + 4 * after.size());
    steps -= after.size();
    open.insert(open.end(), after.begin(), after.end());
    return true;
  };
  for (size_t first = 0; first < node.children.size(); ++first) {
    if (!has_paths[first]) continue;
    if (!follow(first)) return std::nullopt;
    while (!open.empty()) {
      const auto second = static_cast<size_t>(open.back());
      open.pop_back();
      if (std::exchange(reached_from[second], first) == first) continue;
      if (has_paths[second]) {
        pairs.emplace_back(static_cast<int>(first), static_cast<int>(second));
      } else if (!follow(second)) {
        return std::nullopt;
      }
    }
  }
  return pairs;
}

}  // namespace traverse

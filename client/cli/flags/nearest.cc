#include "client/cli/flags/nearest.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "absl/strings/str_format.h"

namespace traverse::cli {
namespace {

// The least number of letters to insert, remove, replace or swap with their neighbor to turn `a`
// into `b` (optimal string alignment).
size_t EditDistance(const std::string& a, const std::string& b) {
  const size_t width = b.size() + 1;
  // distance[i * width + j]: between the first i letters of a and the first j of b.
  std::vector<size_t> distance((a.size() + 1) * width);
  std::iota(distance.begin(), distance.begin() + static_cast<std::ptrdiff_t>(width), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    distance[i * width] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t replaced = distance[(i - 1) * width + j - 1] + (a[i - 1] != b[j - 1]);
      size_t best =
          std::min({distance[(i - 1) * width + j] + 1, distance[i * width + j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        best = std::min(best, distance[(i - 2) * width + j - 2] + 1);
      }
      distance[i * width + j] = best;
    }
  }
  return distance.back();
}

}  // namespace

std::string Nearest(const std::string& word, absl::Span<const std::string> known) {
  constexpr size_t kLongestAsked = 64;
  if (word.size() > kLongestAsked) return "";
  std::string nearest;
  size_t least = std::max<size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : known) {
    // An unfinished word counts like a word with one typing error.
    const bool begun = word.size() >= 3 && candidate.starts_with(word);
    const size_t distance = begun ? 1 : EditDistance(word, candidate);
    if (distance < least && distance < candidate.size()) {
      least = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

std::string DidYouMean(const std::string& word, absl::Span<const std::string> known,
                       const std::string& prefix) {
  const std::string nearest = Nearest(word, known);
  return nearest.empty() ? "" : absl::StrFormat("; did you mean %s%s?", prefix, nearest);
}

}  // namespace traverse::cli

// Random changes of bytes, for mutators that make their own first inputs.

#ifndef TRAVERSE_TESTS_FUZZ_SUPPORT_BYTE_CHANGES_H_
#define TRAVERSE_TESTS_FUZZ_SUPPORT_BYTE_CHANGES_H_

#include <algorithm>
#include <random>
#include <string>

namespace traverse::fuzz {

// Changes, inserts, removes or repeats some bytes behind the first `keep`, a few times.
inline void ChangeBytes(std::string& bytes, size_t keep, std::mt19937& random) {
  const auto below = [&random](size_t n) { return n == 0 ? 0 : random() % n; };
  for (size_t changes = 1 + below(4); changes > 0 && bytes.size() > keep; --changes) {
    const size_t at = keep + below(bytes.size() - keep);
    const size_t length = std::min(1 + below(24), bytes.size() - at);
    switch (below(6)) {
      case 0:
        bytes[at] = static_cast<char>(random());
        break;
      case 1:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        break;
      case 2:  // numbers at their limits
        std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), std::min<size_t>(length, 4),
                    static_cast<char>(below(2) == 0 ? 0 : 0xff));
        break;
      case 3:
        bytes.insert(at, 1, static_cast<char>(random()));
        break;
      case 4:
        bytes.erase(at, length);
        break;
      default:
        bytes.insert(keep + below(bytes.size() - keep), bytes.substr(at, length));
    }
  }
}

}  // namespace traverse::fuzz

#endif  // TRAVERSE_TESTS_FUZZ_SUPPORT_BYTE_CHANGES_H_

// Text as slicers write it, made at random.

#ifndef TRAVERSE_TESTS_CLIENT_CONTAINERS_SLICED_TEXT_H_
#define TRAVERSE_TESTS_CLIENT_CONTAINERS_SLICED_TEXT_H_

#include <random>
#include <string>

namespace traverse::containers {

inline std::string SlicedText(std::mt19937& random, int lines) {
  std::string out;
  const auto number = [&] {
    return std::to_string(random() % 200) + "." + std::to_string(random() % 1000);
  };
  for (int i = 0; i < lines; ++i) {
    switch (random() % 8) {
      case 0:
        out += ";TYPE:Perimeter\n";
        break;
      case 1:
        out += "M204 S" + std::to_string(random() % 5000) + "\n";
        break;
      case 2:
        out += "M117 Layer \"" + std::to_string(i) + "\" ; caf\u00e9\n";
        break;
      case 3:
        out += "\n";
        break;
      default:
        out +=
            "G1 X" + number() + " Y" + number() + " E." + std::to_string(random() % 10000) + "\n";
    }
  }
  return out;
}

}  // namespace traverse::containers

#endif  // TRAVERSE_TESTS_CLIENT_CONTAINERS_SLICED_TEXT_H_

#include "tests/fuzz/support/gcode_mutator.h"

#include <algorithm>
#include <cstring>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tests/client/gcode/support/samples.h"

namespace traverse::fuzz {
namespace {

constexpr const char* kLines[] = {
    "G1 X10 Y10 E1",
    "G1 X12 Y10 E1.5 F1200",
    "G0 X15 Y15 F9000",
    "G1 F1800",
    "G1 E-.8 F2100",
    "G1 E.8 F2100",
    "G1 E2.22",
    "G1 Z.4",
    "G1 Z.2 F600",
    "G2 X20 Y10 I5 J0 E1",
    "G3 X10 Y10 R5 E1",
    "G2 X5 Y5",
    "G3 Z1 I1 J1",
    "G10",
    "G11",
    "G10 S200 P0",
    "G92 E0",
    "G92 X0",
    "G90",
    "G91",
    "G20",
    "G21",
    "G18",
    "G17",
    "G4 P100",
    "G28",
    "M82",
    "M83",
    "M73 P5 R2",
    "M104 S200",
    "M106 S255",
    "M106 P1 S20",
    "M107",
    "M117 line",
    "M201 X500 Y500",
    "M204 S800",
    "M204 P500 T1000",
    "M205 X8 Y8",
    "M221 S95",
    "M486 S1",
    "M486 S-1",
    "M600",
    "M900 K.05",
    "T0",
    "T1",
    "SET_VELOCITY_LIMIT ACCEL=500",
    "EXCLUDE_OBJECT_START NAME=a",
    "EXCLUDE_OBJECT_END NAME=a",
    "START_PRINT",
    ";LAYER_CHANGE",
    ";LAYER:1",
    ";Z:.4",
    ";HEIGHT:.2",
    ";WIDTH:.45",
    ";TYPE:External perimeter",
    ";TYPE:Internal infill",
    ";TYPE:WALL-INNER",
    ";TYPE:FILL",
    ";MESH:a.stl",
    ";MESH:NONMESH",
    "; printing object a id:0 copy 0",
    "; stop printing object a id:0 copy 0",
    ";WIPE_START",
    ";WIPE_END",
    "; a note",
    "",
};

constexpr const char* kNumbers[] = {"0",     "1",       "-1",   ".00001", "10.06", "9999999",
                                    "1e9",   "-0",      ".",    "--1",    "+5",    "0.000000001",
                                    "12.5.", "1000000", "2.22", "30001"};

using Random = std::mt19937;

size_t Below(Random& random, size_t n) { return n == 0 ? 0 : random() % n; }

std::vector<std::string> LinesOf(const std::string& text) {
  std::vector<std::string> lines;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

// Another number in place of one of the line's.
void ChangeNumber(std::string& line, Random& random) {
  const std::string digits = "0123456789.-+";
  const size_t from = line.find_first_of(digits, Below(random, line.size()));
  if (from == std::string::npos) return;
  const size_t to = std::min(line.find_first_not_of(digits, from), line.size());
  line.replace(from, to - from, kNumbers[Below(random, std::size(kNumbers))]);
}

void ChangeByte(std::string& line, Random& random) {
  const std::string bytes = "GMTXYZEFIJRSPK;:=. \t\r0123456789-";
  const size_t at = Below(random, line.size() + 1);
  const char byte = bytes[Below(random, bytes.size())];
  if (at < line.size() && random() % 2 == 0) {
    line[at] = byte;
  } else {
    line.insert(at, 1, byte);
  }
}

void ChangeLines(std::vector<std::string>& lines, Random& random) {
  const size_t at = Below(random, lines.size());
  const size_t count = std::min(Below(random, 8) + 1, lines.size() - at);
  const auto begin = lines.begin() + static_cast<std::ptrdiff_t>(at);
  const auto end = begin + static_cast<std::ptrdiff_t>(count);
  switch (random() % 8) {
    case 0:
      lines.erase(begin, end);
      return;
    case 1: {
      const std::vector<std::string> copy(begin, end);
      lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(Below(random, lines.size())),
                   copy.begin(), copy.end());
      return;
    }
    case 2:
      std::swap(lines[at], lines[Below(random, lines.size())]);
      return;
    case 3:
    case 4:
      lines.insert(begin, kLines[Below(random, std::size(kLines))]);
      return;
    case 5:
      return ChangeByte(lines[at], random);
    default:
      return ChangeNumber(lines[at], random);
  }
}

}  // namespace

size_t MutateGcode(uint8_t* data, size_t size, size_t max_size, unsigned int seed) {
  using gcode::testing::kCuraSample;
  using gcode::testing::kPrusaSample;
  Random random(seed);
  std::string text(reinterpret_cast<const char*>(data), size);
  if (text.empty()) text = random() % 2 == 0 ? kPrusaSample : kCuraSample;
  std::vector<std::string> lines = LinesOf(text);
  for (size_t i = Below(random, 4) + 1; i > 0 && !lines.empty(); --i) ChangeLines(lines, random);
  const char* line_end = random() % 64 == 0 ? "\r\n" : "\n";
  text.clear();
  for (const std::string& line : lines) text += line + line_end;
  if (random() % 32 == 0) text.resize(Below(random, text.size() + 1));
  text.resize(std::min(text.size(), max_size));
  std::memcpy(data, text.data(), text.size());
  return text.size();
}

}  // namespace traverse::fuzz

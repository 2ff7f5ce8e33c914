#include "client/gateway/work/text_count.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <numbers>

namespace traverse::gateway {
namespace {

// What a line does stands in its first bytes; a longer one is a comment, or is read by nobody.
constexpr size_t kMostOfLine = 256;

bool IsDigit(char c) { return c >= '0' && c <= '9'; }
bool IsBlank(char c) { return c == ' ' || c == '\t'; }

// By how much an arc turns around a center that lies `i` and `j` from its begin, and ends `x` and
// `y` from there.
double SweepOf(double i, double j, double x, double y, bool clockwise) {
  const double begin = std::atan2(-j, -i);
  const double end = std::atan2(y - j, x - i);
  double sweep = clockwise ? begin - end : end - begin;
  while (sweep <= 1e-9) sweep += 2 * std::numbers::pi;
  return sweep;
}

// Arcs are taken for so many chords, which lie this near to them.
double ChordsOf(double radius_mm, double sweep) {
  constexpr double kOffMm = 0.01;
  constexpr double kMost = 360;
  if (!(radius_mm > kOffMm)) return 1;
  const double chords = sweep / (2 * std::acos(1 - kOffMm / radius_mm));
  return chords < kMost ? std::max(chords, 1.0) : kMost;  // also where it is no number
}

// The number at `at`, which then is behind it.
double TakeNumber(std::string_view line, size_t& at) {
  while (at < line.size() && IsBlank(line[at])) ++at;
  const bool minus = at < line.size() && line[at] == '-';
  if (minus || (at < line.size() && line[at] == '+')) ++at;
  double value = 0;
  for (; at < line.size() && IsDigit(line[at]); ++at) value = 10 * value + (line[at] - '0');
  if (at < line.size() && line[at] == '.') {
    double unit = 0.1;
    for (++at; at < line.size() && IsDigit(line[at]); ++at, unit /= 10) {
      value += unit * (line[at] - '0');
    }
  }
  return minus ? -value : value;
}

// Of an object or a layer.
bool IsMark(std::string_view line) {
  for (const std::string_view word :
       {"object", "OBJECT", "MESH", "PRINTING", "layer", "LAYER", "TIME"}) {
    if (line.find(word) != std::string_view::npos) return true;
  }
  return false;
}

}  // namespace

// Of a line that is a command.
struct TextCount::Words {
  char letter = 0;  // with which it begins, in capitals
  int number = -1;
  bool e = false;
  double i = 0;
  double j = 0;
  double r = 0;
  bool has[3] = {false, false, false};  // X, Y, Z
  double value[3] = {0, 0, 0};

  explicit Words(std::string_view line) {
    size_t at = 0;
    while (at < line.size() && (IsBlank(line[at]) || line[at] == '/')) ++at;
    if (at < line.size() && (line[at] & ~0x20) == 'N') TakeNumber(line, ++at);
    while (at < line.size() && line[at] != ';') {
      const char c = static_cast<char>(line[at++] & ~0x20);
      if (c < 'A' || c > 'Z') continue;
      const double read = TakeNumber(line, at);
      if (letter == 0) {
        letter = c;
        number = static_cast<int>(std::clamp(read, -1.0, 1e6));
      } else if (c >= 'X' && c <= 'Z') {
        has[c - 'X'] = true;
        value[c - 'X'] = read;
      }
      if (c == 'I') i = read;
      if (c == 'J') j = read;
      if (c == 'R') r = read;
      e = e || c == 'E';
    }
  }

  bool Is(int n) const { return letter == 'G' && number == n; }
  // The settings of Marlin that go with paths; Klipper's begin with SET.
  bool Sets() const {
    return letter == 'S' ||
           (letter == 'M' && (number == 106 || number == 107 || number / 100 == 2 ||
                              number / 100 == 5 || number / 100 == 9));
  }
  // Filament that is counted anew, and messages, hold nothing in its place.
  bool passed() const { return (Is(92) && e) || (letter == 'M' && number == 117); }
  bool moves() const { return letter == 'G' && number >= 0 && number <= 3; }
  bool arc() const { return letter == 'G' && (number == 2 || number == 3); }
  bool sideways() const { return has[0] || has[1] || arc(); }
};

void TextCount::Take(std::string_view piece) {
  bytes_ += static_cast<int64_t>(piece.size());
  while (!piece.empty()) {
    const void* found = std::memchr(piece.data(), '\n', piece.size());
    const size_t end = found == nullptr
                           ? piece.size()
                           : static_cast<size_t>(static_cast<const char*>(found) - piece.data());
    if (found != nullptr && rest_.empty()) {
      TakeLine(piece.substr(0, std::min(end, kMostOfLine)));
    } else {
      rest_.append(piece.substr(0, std::min(end, kMostOfLine - rest_.size())));
      if (found != nullptr) {
        TakeLine(rest_);
        rest_.clear();
      }
    }
    piece.remove_prefix(std::min(end + 1, piece.size()));
  }
}

void TextCount::Finish() {
  TakeLine(rest_);
  rest_.clear();
  EndLayer();
}

void TextCount::EndLayer() {
  if (layer_paths_ > 0) ++layers_;
  paths_ += layer_paths_;
  most_paths_ = std::max(most_paths_, layer_paths_);
  layer_paths_ = 0;
  cells_ += layer_cells_;
  most_cells_ = std::max(most_cells_, layer_cells_);
  layer_cells_ = 0;
}

void TextCount::TakeLine(std::string_view line) {
  const Words words(line);
  if (words.letter == 0) {
    fences_ += IsMark(line) ? 1 : 0;
    return;
  }
  if (words.moves()) return Move(words);
  in_path_ = false;
  if (words.Sets()) {
    ++settings_;
  } else if (!words.passed()) {
    ++fences_;
  }
  if (words.Is(90) || words.Is(91)) relative_ = words.Is(91);
  if (words.Is(20) || words.Is(21)) unit_mm_ = words.Is(20) ? 25.4 : 1;
  for (int axis = 0; axis < 3 && words.Is(92); ++axis) {
    if (words.has[axis]) at_[axis] = words.value[axis];
  }
}

void TextCount::Move(const Words& words) {
  const double begin[2] = {at_[0], at_[1]};
  double length = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (!words.has[axis]) continue;
    const double to = relative_ ? at_[axis] + words.value[axis] : words.value[axis];
    if (axis < 2) length += std::abs(to - at_[axis]) * unit_mm_;
    at_[axis] = to;
  }
  if (!words.sideways() || !words.e) {
    const int64_t weight = words.arc() ? 2 : 1;
    moves_ += weight;
    link_moves_ += weight;
    most_moves_ = std::max(most_moves_, link_moves_);
    // What a reader takes for one path has no travel in it, and no retraction.
    travelled_ = travelled_ || words.sideways() != words.e;
    in_path_ = false;
    return;
  }
  if (travelled_ && at_[2] != layer_z_) {
    EndLayer();
    layer_z_ = at_[2];
  }
  if (!in_path_) ++layer_paths_;
  double pieces = 1;
  if (words.arc()) {
    const double x = at_[0] - begin[0];
    const double y = at_[1] - begin[1];
    const bool centered = words.i != 0 || words.j != 0;
    const double radius = centered ? std::hypot(words.i, words.j) : std::abs(words.r);
    const double short_way =
        2 * std::asin(std::min(std::hypot(x, y) / 2 / std::max(radius, 1e-9), 1.0));
    const double sweep = centered      ? SweepOf(words.i, words.j, x, y, words.Is(2))
                         : words.r < 0 ? 2 * std::numbers::pi - short_way
                                       : short_way;
    pieces = ChordsOf(radius * unit_mm_, sweep);
    length = radius * sweep * unit_mm_;
  }
  link_moves_ = 0;
  segments_ += static_cast<int64_t>(pieces);
  constexpr double kMost = kMostCellsOfLine - 1;
  layer_cells_ += 1 + static_cast<int64_t>(length < kMost ? length : kMost);
  if (!(length < kMostCellsOfLine)) far_mm_ += length;
  in_path_ = true;
  travelled_ = false;
}

}  // namespace traverse::gateway

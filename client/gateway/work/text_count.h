// What a text of G-code is made of, as far as work on it takes memory.

#ifndef TRAVERSE_CLIENT_GATEWAY_WORK_TEXT_COUNT_H_
#define TRAVERSE_CLIENT_GATEWAY_WORK_TEXT_COUNT_H_

#include <cstdint>
#include <string>
#include <string_view>

namespace traverse::gateway {

// Goes through a text once, piece by piece, at some hundred megabytes in a second. Knows of G-code
// only as much as that takes: it counts every path that a reader finds, and may count some more.
class TextCount {
 public:
  // The next bytes; they may end anywhere.
  void Take(std::string_view piece);

  // No more bytes come.
  void Finish();

  int64_t bytes() const { return bytes_; }
  int64_t segments() const { return segments_; }  // lines that print, and chords of arcs
  int64_t paths() const { return paths_; }        // runs of them
  int64_t moves() const { return moves_; }        // other lines that move; arcs are two
  int64_t settings() const { return settings_; }  // lines that set the fan, accelerations and so on

  // Lines that nothing passes: other commands, and the comments that name objects and layers.
  int64_t fences() const { return fences_; }

  // Moves from one line that prints to the next, at most.
  int64_t most_moves() const { return most_moves_; }

  int64_t layers() const { return layers_; }
  int64_t most_paths() const { return most_paths_; }  // of a layer

  // Cells of a millimetre that lines lie in: of all layers, and of the one with most. A layer's
  // lines are laid into grids, where a long line counts as so many cells at most.
  int64_t cells() const { return cells_; }
  int64_t most_cells() const { return most_cells_; }
  static constexpr double kMostCellsOfLine = 256;

  // The length of lines with more cells than that, in mm: few prints have any.
  double far_mm() const { return far_mm_; }

 private:
  struct Words;

  void TakeLine(std::string_view line);
  void Move(const Words& words);
  void EndLayer();

  int64_t bytes_ = 0;
  int64_t segments_ = 0;
  int64_t paths_ = 0;
  int64_t moves_ = 0;
  int64_t settings_ = 0;
  int64_t fences_ = 0;
  int64_t most_moves_ = 0;
  int64_t link_moves_ = 0;
  int64_t layers_ = 0;
  int64_t most_paths_ = 0;
  int64_t layer_paths_ = 0;
  int64_t cells_ = 0;
  int64_t most_cells_ = 0;
  int64_t layer_cells_ = 0;
  double far_mm_ = 0;
  std::string rest_;        // of a line whose end has not come
  bool in_path_ = false;    // the last line that does something prints
  bool travelled_ = false;  // since the last line that prints
  bool relative_ = false;   // G91
  double unit_mm_ = 1;
  double at_[3] = {0, 0, 0};
  double layer_z_ = 0;
};

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_WORK_TEXT_COUNT_H_

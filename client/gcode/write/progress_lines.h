// The lines of a layer that say how far the print is: M73 and others (machine/progress_line.h).
//
// They keep their sequence, and stand where as large a share of the layer's time is over as in the
// file: before paths, or between the segments of long ones. None passes what nothing crosses: these
// lines stay on their side of it, and those amid it stay there.

#ifndef TRAVERSE_CLIENT_GCODE_WRITE_PROGRESS_LINES_H_
#define TRAVERSE_CLIENT_GCODE_WRITE_PROGRESS_LINES_H_

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "client/gcode/measure/layer_meter.h"
#include "client/gcode/model/gcode_file.h"

namespace traverse::gcode {

class ProgressLines {
 public:
  // `file` and `layer` outlive this. `moved`: objects of the layer have changed places, so that the
  // lines between them go through the whole layer.
  ProgressLines(const GcodeFile& file, const Layer& layer, bool moved);

  // Appends `bare` to `out`, with the lines inserted: the text of the layer's paths in some order,
  // from `start` on. `marks` are where in it each path begins and ends, and become the same in
  // `out`.
  void Insert(std::string_view bare, const PartStart& start, std::vector<size_t>& marks,
              std::string& out) const;

 private:
  // A run of places between which nothing is that nothing crosses.
  struct Part {
    size_t first_place = 0;
    size_t end_place = 0;
    size_t first_line = 0;  // of lines_
    size_t end_line = 0;
  };

  // A place where a line may stand, and when that is.
  struct Gap {
    size_t offset = 0;
    double seconds = 0;
  };

  void FindParts(const Layer& layer, bool moved);
  void LearnShares(const Layer& layer);

  // In `bare`, ascending: before each path and before each segment of it.
  std::vector<Gap> GapsOf(std::string_view bare, const PartStart& start,
                          const std::vector<size_t>& marks, TextMoments& moments) const;

  const GcodeFile& file_;
  std::vector<Offset> lines_;
  std::vector<double> shares_;  // [line] of the time of its part that is over
  std::vector<Part> parts_;     // those with lines
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_WRITE_PROGRESS_LINES_H_

// Writes one layer with its paths in a new order.

#ifndef TRAVERSE_CLIENT_GCODE_LAYER_WRITER_H_
#define TRAVERSE_CLIENT_GCODE_LAYER_WRITER_H_

#include <string>
#include <vector>

#include "client/gcode/layer_meter.h"
#include "client/gcode/link_donors.h"
#include "client/gcode/placed_path.h"
#include "client/gcode/travel_rules.h"

namespace traverse::gcode {

// The paths of a layer in the order to print them.
using LayerOrder = std::vector<Placement>;

// The order of the file.
LayerOrder GivenOrder(const GcodeFile& file, const Layer& layer);

struct WrittenLayer {
  std::string text;  // from behind the last path of the layer before to behind its own last path
  PartStart behind;  // the machine then
  size_t first_path = 0;  // where in the text its first path begins
  bool as_given = false;  // byte by byte what the file has
};

class LayerWriter {
 public:
  // `file` and `habit` outlive the writer.
  LayerWriter(const GcodeFile& file, const RetractionHabit& habit)
      : file_(file), habit_(habit), donors_(file) {}

  // Writes `layer` in `order`. `before` is the last path before it and `start` the machine behind
  // that path; for the first layer null and the machine where its first path begins. Thread-safe.
  WrittenLayer Write(const Layer& layer, const LayerOrder& order, const Placement* before,
                     const PartStart& start) const;

 private:
  const GcodeFile& file_;
  const RetractionHabit& habit_;
  const LinkDonors donors_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_LAYER_WRITER_H_

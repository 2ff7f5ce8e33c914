#include "client/gcode/layer_meter.h"

#include "client/gcode/outline.h"
#include "client/gcode/parallel.h"
#include "client/gcode/print_meter.h"

namespace traverse::gcode {

PrintTotals Measure(const GcodeFile& file, std::string_view text, const PartStart& start) {
  PrintMeter meter(file.profile, DynamicsOf(file.profile, start.state, file.setters));
  Interpreter interpreter(text, 0, start.machine);
  for (Step step; interpreter.Next(step);) meter.Follow(step, interpreter);
  return meter.Finish();
}

PartStart StartBehind(const GcodeFile& file, const Block& block) {
  PartStart start{StateAt(file, block), file.states[block.state_out]};
  start.machine.at = block.last;
  start.machine.e = block.e_out;
  start.machine.feed = block.feed_out;
  return start;
}

std::vector<PrintTotals> MeasureLayers(const GcodeFile& file, int threads) {
  std::vector<PrintTotals> totals(file.layers.size());
  ParallelFor(totals.size(), threads, [&file, &totals](size_t i) {
    const Layer& layer = file.layers[i];
    const Block& first = file.blocks[layer.first_block];
    const Offset end = file.blocks[layer.end_block - 1].end;
    const bool whole_file_begins = layer.first_block == 0;
    const PartStart start = whole_file_begins
                                ? PartStart{StateAt(file, first), file.states[first.state_in]}
                                : StartBehind(file, file.blocks[layer.first_block - 1]);
    const Offset begin = whole_file_begins ? first.begin : file.blocks[layer.first_block - 1].end;
    totals[i] = Measure(file, std::string_view(file.text).substr(begin, end - begin), start);
  });
  return totals;
}

PrintTotals Sum(const std::vector<PrintTotals>& totals) {
  PrintTotals sum;
  for (const PrintTotals& each : totals) sum += each;
  return sum;
}

}  // namespace traverse::gcode

#include "client/gcode/write/link_writer.h"

namespace traverse::gcode {

void PrintLink(const NewLink& link, GcodeOut& out) {
  if (const std::optional<FilePart>& part = link.part()) {
    out.Copy(part->begin, part->end, part->before, part->behind, part->without_progress);
  }
  for (const LinkLine& line : link.lines()) {
    const LinkStep& step = line.step;
    switch (line.form) {
      case LineForm::kRaw:
        out.Raw(line.raw);
        break;
      case LineForm::kEdited:
        out.Edited(line);
        break;
      case LineForm::kTravel:
        out.Travel(line.raw, step.to, step.feed);
        break;
      case LineForm::kSetter:
        out.SetBy(line.raw, step.slots);
        break;
      case LineForm::kState:
        out.Set(link.state(line), step.slots);
        break;
      case LineForm::kStand:
        out.Stand(step);
        break;
      case LineForm::kSegment:
        out.Segment("G1", step.to, line.extrudes, step.filament, step.feed, {}, {});
        break;
    }
  }
}

}  // namespace traverse::gcode

#include "client/gcode/verify/trace/side_reader.h"

#include "client/gcode/verify/text.h"

namespace traverse::gcode {
namespace {

constexpr std::string_view kLayerMarks[] = {";LAYER_CHANGE", ";LAYER:", "; CHANGE_LAYER",
                                            "; layer ",      ";layer:", "; BEGIN_LAYER_OBJECT",
                                            "; <layer>",     ";LAYER "};

// Stands for a first line that states the digest of its text.
constexpr uint64_t kRightMd5 = 2;

// Lines are read in less than a microsecond.
constexpr size_t kLinesToLimit = 256;

// Marks beyond this much of a file are not its first ones.
constexpr size_t kHead = 1 << 20;

bool IsLayerMark(std::string_view text) { return BeginsWithAny(text, kLayerMarks); }

}  // namespace

bool HasLayerMarks(std::string_view text) {
  text = text.substr(0, kHead);
  for (size_t at = 0; at < text.size();) {
    if (text[at] == ';' && IsLayerMark(text.substr(at, 32))) return true;
    at = text.find('\n', at);
    if (at == std::string_view::npos) return false;
    ++at;
  }
  return false;
}

SideReader::SideReader(std::string_view text, std::string_view ignored, bool marked,
                       bool right_digest, const WorkLimit& limit)
    : machine_(text),
      cutter_(ignored, marked),
      tracer_(marked),
      right_digest_(right_digest),
      limit_(limit) {}

void SideReader::TakeHeld() {
  held_ = false;
  tracer_.Take(line_, machine_, cutter_.open_section());
}

// A chunk ends where a path begins that is of a new layer: so that all that leads to it, and all
// that follows the path before it, is known.
template <typename Enough>
TraceChunk SideReader::ReadUntil(Enough enough) {
  if (held_) TakeHeld();
  while (machine_.Next(line_)) {
    if (line_.number % kLinesToLimit == 0 && limit_.Ended()) break;
    bytes_ += line_.text.size() + 1;
    if (right_digest_ && line_.number == 1) line_.digest = kRightMd5;
    const uint32_t section = cutter_.open_section();
    const bool mark = line_.text.size() > 1 && line_.text[0] == ';' && IsLayerMark(line_.text);
    const SectionCutter::Cut cut = cutter_.Take(line_, machine_, mark);
    if (cut.before) tracer_.EndSection(true, false);
    if (line_.role == LineRole::kDeposit && tracer_.AtLayer() && enough()) {
      held_ = true;
      return tracer_.TakeChunk(cutter_.open_section(), false);
    }
    tracer_.Take(line_, machine_, cut.before ? cutter_.open_section() : section);
    if (mark) cutter_.EndScript();
    if (cut.behind) tracer_.EndSection(mark, mark);
    if (mark && !cut.behind) tracer_.Mark();
  }
  cutter_.Finish(machine_);
  done_ = true;
  return tracer_.TakeChunk(cutter_.open_section(), true);
}

TraceChunk SideReader::NextBytes(size_t bytes) {
  bytes_ = 0;
  return ReadUntil([this, bytes] { return bytes_ >= bytes; });
}

TraceChunk SideReader::NextSections(uint32_t end_section) {
  return ReadUntil([this, end_section] { return cutter_.open_section() >= end_section; });
}

}  // namespace traverse::gcode

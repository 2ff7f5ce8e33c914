// Reads one of the two files of a verification, a few layers at a time.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_TRACE_SIDE_READER_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_TRACE_SIDE_READER_H_

#include <cstdint>
#include <string_view>

#include "client/gcode/verify/machine/text_lines.h"
#include "client/gcode/verify/sections.h"
#include "client/gcode/verify/trace/trace.h"
#include "client/gcode/verify/trace/tracer.h"
#include "client/gcode/work_limit.h"

namespace traverse::gcode {

// True if `text` has marks of layers that slicers write.
bool HasLayerMarks(std::string_view text);

class SideReader {
 public:
  // Ignores comments that begin with `ignored`. `right_digest`: the first line states the digest
  // of the file, which `text` need not have (line_numbers.h). Reads nothing more once `limit`
  // ends.
  SideReader(std::string_view text, std::string_view ignored, bool marked, bool right_digest,
             const WorkLimit& limit);

  // The next layers, with `bytes` of text or a little more.
  TraceChunk NextBytes(size_t bytes);

  // The next layers, as far as section `end_section`.
  TraceChunk NextSections(uint32_t end_section);

  bool done() const { return done_; }

  // Read so far.
  const TextLines& lines() const { return machine_.lines(); }

  // The sections read so far.
  const Sections& cut() const { return cutter_.cut(); }

  // Counts the deposits `printed` of a section as those of `as`.
  void Count(uint32_t section, const std::vector<uint64_t>& printed,
             const std::vector<uint64_t>& as) {
    cutter_.Count(section, printed, as);
  }

 private:
  template <typename Enough>
  TraceChunk ReadUntil(Enough enough);
  void TakeHeld();

  VerifyMachine machine_;
  SectionCutter cutter_;
  Tracer tracer_;
  VerifyLine line_;
  const bool right_digest_;
  const WorkLimit limit_;
  bool held_ = false;  // line_ begins the next chunk
  bool done_ = false;
  size_t bytes_ = 0;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_TRACE_SIDE_READER_H_

// Follows a machine through a file and writes down what the rules look at.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_TRACE_TRACER_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_TRACE_TRACER_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "client/gcode/verify/trace/trace.h"
#include "engine/geometry/bounding_box.h"

namespace traverse::gcode {

class Tracer {
 public:
  // `marked`: the file has marks of layers, so that what stands before the first one is a script.
  explicit Tracer(bool marked) : in_print_(!marked) { link_.first = !marked; }

  // A line that `machine` has just done, in section `section`.
  void Take(const VerifyLine& line, VerifyMachine& machine, uint32_t section);

  // A section ends: `layer`, with a layer.
  void EndSection(bool layer, bool mark);

  // What follows is no start script.
  void Mark();

  // The next deposit begins a path of a new layer, so that a chunk may end.
  bool AtLayer() const { return layer_due_; }

  // What has been written down since the last time; the link that follows goes into the next chunk
  // as well, and so do lines of progress of which it is not known yet what they belong to, unless
  // there is none.
  TraceChunk TakeChunk(uint32_t end_section, bool last_of_file);

 private:
  void TakeComment(const VerifyLine& line, uint32_t section);
  void TakeWipeMark(bool begins, uint32_t line, uint32_t section);
  void TakeDeposit(const VerifyLine& line, VerifyMachine& machine, uint32_t section);
  void TakeMove(const VerifyLine& line, VerifyMachine& machine, uint32_t section);
  void BeginSection(const VerifyLine& line, uint32_t section, double before_seconds);
  void NotePlaces(double before_seconds);
  void BeginPath(const Motion& motion, uint32_t section, double unit);
  void EndLink();
  bool OnlyRounding() const;
  void FixExcursion(Point begin, double z_mm);
  bool IsAside(Point at, Point begin) const;
  PathClass ClassNow(const VerifyLine& line) const;

  TraceChunk chunk_;
  double seconds_ = 0;  // since the file began: clock.h
  std::vector<TraceMove> pending_;
  std::vector<TraceCommand> pending_commands_;
  TraceLink link_;
  double printed_mm_ = 0;  // the height of the last deposit
  BoundingBox extent_;     // of all deposits of the print so far
  std::array<float, static_cast<size_t>(PathClass::kCount)> length_of_{};
  std::optional<PathClass> named_;
  bool in_path_ = false;
  bool section_due_ = true;
  bool layer_due_ = true;
  bool wiping_ = false;   // between the marks of a wipe
  bool wiped_ = false;    // something moved sideways there
  bool printed_ = false;  // something was printed there
  bool marks_wipes_ = false;
  bool in_print_;
  bool states_fan_ = false;  // since the last deposit
  uint32_t layers_ = 0;
  uint32_t last_section_ = UINT32_MAX;
  uint32_t last_held_line_ = 0;  // the last deposit or fence, and when it was done
  double held_seconds_ = 0;
  double begun_seconds_ = 0;  // the last deposit
  double left_seconds_ = 0;
  size_t without_next_ = 0;  // lines of progress since then
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_TRACE_TRACER_H_

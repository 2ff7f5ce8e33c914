// Collects the lines of a file into blocks and links while an interpreter executes them.

#ifndef TRAVERSE_CLIENT_GCODE_READ_BLOCK_BUILDER_H_
#define TRAVERSE_CLIENT_GCODE_READ_BLOCK_BUILDER_H_

#include <array>
#include <optional>
#include <vector>

#include "absl/container/flat_hash_map.h"
#include "client/gcode/model/gcode_file.h"
#include "engine/geometry/bounding_box.h"

namespace traverse::gcode {

class BlockBuilder {
 public:
  // Fills `file`, whose text is set and which must outlive the builder.
  explicit BlockBuilder(GcodeFile& file) : file_(file) {}

  // Adds the step that `interpreter` has just made; `before` is the machine before it.
  void Take(const Step& step, const MachineState& before, const Interpreter& interpreter);

  // Ends the text.
  void Finish();

 private:
  // A move that goes on along a path leads no farther beside it.
  static constexpr double kBesideMm = 0.05;

  enum class Where { kHead, kBody, kTail, kLink };

  // A line that machines interpret differently.
  struct LineFault {
    Offset at = 0;
    const char* what = nullptr;
    size_t block = 0;  // the next one
  };

  // What is known about the link being read.
  struct OpenLink {
    uint16_t flags = 0;
    int xy_moves = 0;
    double first_move_mm = 0;
    Position first_move_to;  // of a travel move without a retraction
    bool open_first_move = false;
    bool pulls_behind_first = false;  // such a move, and then pulls back
    bool retracted = false;           // before one of its lines
    bool sets_fan = false;
    bool lost = false;               // a move that is not understood: its end is unknown
    uint32_t found = 0;              // axes that a move behind it states
    int travels_behind_fixed = 0;    // moves in XY after the last line that must stay
    std::optional<Point> travel_to;  // where the last move in XY leads
    BoundingBox travelled;           // where those before it lead
    bool changes_tool = false;
    bool primes =
        false;  // behind a tool change, filament is pushed of which nothing was pulled back
    double travel_mm = 0;
    Decimal relative_rise = 0;   // of its moves under G91
    Decimal top = -kDecimalMax;  // the highest Z of its moves in XY
  };

  void TakeOther(const Step& step, const MachineState& before, const MachineState& after);
  void TakeSlot(const Step& step);
  void TakeLabel(const Step& step);
  void NoteScript(const Step& step);
  void NotePlace(const Step& step, const MachineState& after);
  void NoteTravel(Point to);
  bool LeadsAside(Point begin) const;
  void NoteInLink(const Step& step, const MachineState& before, const MachineState& after);
  bool IsTail(const Step& step, const MachineState& before, const MachineState& after) const;
  void TakeTail(const Step& step, const MachineState& before, const MachineState& after);
  bool TailIsOwn() const;
  bool TailLeadsAside() const;
  void UndoTail();
  void BeginBlock(const Step& step, const MachineState& before, const MachineState& after);
  void ExtendBlock(const Step& step, const MachineState& before, const MachineState& after);
  bool GoesOn() const;
  // `block`, of `layer`, is a scarf seam as far as it has been read.
  bool IsScarf(const Block& block, const Layer& layer) const;
  void EndBlock();
  // `block` begins here, and its first segment ends at `first_end_z`.
  bool BeginsLayer(const Block& block, Decimal first_end_z) const;
  void CloseLink(const Block& block, Decimal first_end_z, bool retracted);
  void BeginLayer(const Block& block);
  void KeepLayersWithFaults();
  void NoteHeights();
  uint32_t CurrentState();
  uint16_t ModeOf(const MachineState& state);
  Block& Last() { return file_.blocks.back(); }
  const Block& Last() const { return file_.blocks.back(); }

  GcodeFile& file_;
  PrintState state_{};
  bool state_dirty_ = true;
  uint32_t state_id_ = 0;
  absl::flat_hash_map<std::array<int, 5>, uint16_t> mode_ids_;
  uint32_t object_ = 0;

  std::vector<LineFault> faults_;
  size_t scripted_ = 0;  // blocks of the start script, as far as known
  bool layers_marked_ = false;

  Where where_ = Where::kHead;
  uint16_t pending_ = 0;  // BlockFlags of lines after the last extruding one
  OpenLink link_;
  BoundingBox printed_;  // what is printed so far

  bool ends_rising_ = false;  // the last segment of the last block rises

  // Set while the last block ends with a tail: its state without it, and the tail in a link.
  bool has_tail_ = false;
  bool meets_tail_ = false;  // the next block begins where the tail ended
  Block before_tail_;
  OpenLink tail_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_READ_BLOCK_BUILDER_H_

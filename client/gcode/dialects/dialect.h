// What slicers, hosts and printers write in words of their own: one table for each, and none of
// these words elsewhere in the reader. A slicer that is new here is one table more.
//
// The verifier has words of its own (verify/), so that no word can be wrong in both alike.

#ifndef TRAVERSE_CLIENT_GCODE_DIALECTS_DIALECT_H_
#define TRAVERSE_CLIENT_GCODE_DIALECTS_DIALECT_H_

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "client/gcode/dialects/feature.h"

namespace traverse::gcode {

// What a line means that is no command of all printers.
enum class MarkKind : uint8_t {
  kType,        // names the feature of what follows
  kQuotedType,  // the same, in quotes
  kNoType,      // looks like one
  kWidth,       // of the lines that follow
  kHeight,
  kWidthAndHeight,
  kWipeBegins,
  kWipeEnds,
  kLayer,         // a layer begins
  kObjectBegins,  // what follows is of the object that the line names
  kObjectEnds,    // and no longer
  kNoObject,      // what follows is of none
  kSays,          // shows something to who stands before the printer
  kStays,         // moves nothing, or leads the head away for a picture and back to where it was
};

struct Mark {
  std::string_view begins;
  MarkKind kind;
  std::string_view notation = {};  // of labels of objects: what lines of their sort begin with
  bool numbered = false;           // a digit follows
};

// A line near the head of the file that says which slicer wrote it.
struct Head {
  std::string_view line;         // begins so
  std::string_view other = {};   // another line begins so
  std::string_view slicer = {};  // where the first one does not say it
};

struct FeatureWord {
  std::string_view word;
  Feature feature;
  bool or_ironing = false;  // has the same word
};

// What settings say that are stated in the file, in the units of MachineProfile.
enum class Setting : uint8_t {
  kPrintAccel,
  kTravelAccel,
  kRetractAccel,
  kZAccel,
  kMaxZSpeed,
  kMaxESpeed,
  kRetractLength,
  kRetractSpeed,
  kRetractBeforeTravel,
  kAvoidCrossing,
  kTopFillPattern,
  kBottomFillPattern,
  kNozzleDiameter,
  kClearanceRadius,
  kHeadPolygon,  // around the nozzle
  kNozzleHeight,
  kFilamentDiameter,
};

struct SettingWord {
  std::string_view key;
  Setting setting;
};

// A comment that states how long the print takes, behind its first colon or equals sign.
struct TimeWord {
  std::string_view begins;  // behind the semicolon and blanks
  bool first_layer = false;
};

struct Dialect {
  std::span<const Head> heads = {};
  std::span<const Mark> marks = {};
  std::span<const FeatureWord> features = {};       // named by marks
  std::span<const FeatureWord> move_features = {};  // and by the comment on a move
  std::span<const SettingWord> settings = {};
  std::span<const TimeWord> times = {};
  // A comment that is one of `features` names the type without a mark.
  bool bare_types = false;
  // Leads travel around walls within the part. Else a short first move of it leaves the path, and
  // the travel proper begins behind it.
  bool combs = false;
};

extern const Dialect kPrusa;  // PrusaSlicer, SuperSlicer
extern const Dialect kOrca;   // OrcaSlicer, Bambu Studio
extern const Dialect kSlic3r;
extern const Dialect kCura;  // CuraEngine
extern const Dialect kIdeaMaker;
extern const Dialect kSimplify3d;  // and FlashPrint
extern const Dialect kKisslicer;
extern const Dialect kOthers;    // IceSL, Kiri:Moto, Canvas
extern const Dialect kFirmware;  // Klipper, Bambu's printers

// All of these, in the order in which a file is asked who wrote it.
std::span<const Dialect* const> AllDialects();

// The mark that `line` is, of which it begins with most; null if it is none. `line` has no blanks
// around it.
const Mark* MarkOf(std::string_view line);

// The name of the type that `line`, a mark of kType or kQuotedType, or a comment of that name
// alone, sets; empty if it sets none.
std::string_view TypeIn(std::string_view line);

// The feature of that name, with blanks around it or not; kCount if nobody calls one so.
Feature FeatureOfType(std::string_view type);

// True if the slicer calls ironing by that name, too.
bool MayBeIroning(std::string_view type);

// The feature that the comment on a move names; kCount if it names none.
Feature FeatureOfMove(std::string_view comment);

// What the setting `key` says; nothing if no slicer known here has it.
std::optional<Setting> SettingOf(std::string_view key);

// The time that `comment` states, if it does; `comment` begins behind its semicolon and blanks.
const TimeWord* TimeOf(std::string_view comment);

struct Slicer {
  std::string name;    // as the file states it, "PrusaSlicer 2.5.0"; empty if it does not
  bool combs = false;  // Dialect::combs
};

// By `head`, the first lines of a file.
Slicer SlicerOf(std::string_view head);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_DIALECTS_DIALECT_H_

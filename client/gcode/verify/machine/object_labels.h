// The labels of objects in force, each notation for itself: a printer, or its host, may be told to
// leave out whatever stands under one of them.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_MACHINE_OBJECT_LABELS_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_MACHINE_OBJECT_LABELS_H_

#include <array>
#include <cstdint>
#include <string_view>

namespace traverse::gcode {

class ObjectLabels {
 public:
  // Takes a line without blanks around it; true if it is a label.
  bool Take(std::string_view line);

  // A label that a host reads, not the printer.
  static bool IsOfHost(std::string_view line);

  // Of all labels in force; 0 if there is none.
  uint64_t digest() const;

  // Labels so far that end an object that was not begun, or begin one within another one.
  uint32_t faults() const { return faults_; }

 private:
  enum Notation : uint8_t {
    kPrinting,    // PrusaSlicer: `; printing object`
    kUnique,      // OrcaSlicer: `; start printing object, unique label id:`
    kExclude,     // Klipper
    kM486,        // Marlin, RepRapFirmware
    kM624,        // Bambu
    kObjectId,    // Bambu: `; OBJECT_ID:`
    kMesh,        // CuraEngine
    kPrintingOf,  // ideaMaker: `;PRINTING:`
    kPrintingId,  // `;PRINTING_ID:`
    kHost,        // OctoPrint: `@OBJECT`
    kRegion,      // `@EXCLUDEREGION`
    kCount,
  };

  struct Mark;

  void Switch(Notation notation, std::string_view name);
  void Begin(Notation notation, std::string_view name);
  void End(Notation notation, std::string_view name);

  std::array<uint64_t, kCount> open_{};  // [notation] of the name; 0: none
  uint32_t faults_ = 0;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_MACHINE_OBJECT_LABELS_H_

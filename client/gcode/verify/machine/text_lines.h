// The lines of a file, as firmware takes them.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_MACHINE_TEXT_LINES_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_MACHINE_TEXT_LINES_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace traverse::gcode {

class TextLines {
 public:
  // `text` outlives it.
  explicit TextLines(std::string_view text) : rest_(text) {}

  // The next line, without what ends it: to firmware a carriage return ends one, wherever it
  // stands. False at the end.
  bool Next(std::string_view& line);

  uint32_t number() const { return number_; }      // of the last line, from 1
  std::string_view rest() const { return rest_; }  // behind it

  // Which line ends there were so far: bit n for LF behind n carriage returns, and kLoneReturn.
  uint32_t ends() const { return ends_; }
  static constexpr size_t kMostReturns = 3;
  static constexpr uint32_t kLoneReturn = 1u << (kMostReturns + 1);

  // The first line that ends in one of these ways; 0 if there is none.
  uint32_t FirstWithEnds(uint32_t ends) const;

 private:
  void NoteEnd(size_t bit);

  std::string_view rest_;
  const char* line_feed_ = nullptr;  // the next one, or the end
  const char* return_ = nullptr;     // the same of carriage returns
  uint32_t number_ = 0;
  uint32_t ends_ = 0;
  std::array<uint32_t, kMostReturns + 2> first_with_end_{};  // [bit of ends_]
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_MACHINE_TEXT_LINES_H_

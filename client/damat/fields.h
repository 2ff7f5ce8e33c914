// The fields of one DAMAT record, and the numbers in them.

#ifndef TRAVERSE_CLIENT_DAMAT_FIELDS_H_
#define TRAVERSE_CLIENT_DAMAT_FIELDS_H_

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace traverse::damat {

// `text` without blanks, tabs and carriage returns at its ends.
std::string_view Trimmed(std::string_view text);

// `text` between quotation marks for a message: its beginning, without bytes that do not print.
std::string Quoted(std::string_view text);

// A whole number, digits alone; nothing if `text` is none or exceeds 64 bits.
std::optional<uint64_t> ParseCount(std::string_view text);

// A number in mm, finite and within kMaxCoordinateMm; nothing if `text` is none.
std::optional<double> ParseCoordinate(std::string_view text);

// Walks over fields that commas divide; a comma behind the last one is ignored. Points into the
// record.
class Fields {
 public:
  explicit Fields(std::string_view record) : rest_(record) {}

  // The next field, trimmed; empty if there is none.
  std::string_view Next();

  // True if there are no more fields.
  bool done() const { return done_; }

 private:
  std::string_view rest_;
  bool done_ = false;
};

}  // namespace traverse::damat

#endif  // TRAVERSE_CLIENT_DAMAT_FIELDS_H_

// The fields of one DAMAT record, and the numbers in them.

#ifndef TRAVERSE_CLIENT_DAMAT_FIELDS_H_
#define TRAVERSE_CLIENT_DAMAT_FIELDS_H_

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace traverse::damat {

// `text` without blanks, tabs and carriage returns at both ends.
std::string_view Trimmed(std::string_view text);

// `text` in quotation marks for a message: its beginning, without unprintable bytes.
std::string Quoted(std::string_view text);

// A whole number of digits; unset if `text` is not one or exceeds 64 bits.
std::optional<uint64_t> ParseCount(std::string_view text);

// A number in mm, finite and within kMaxCoordinateMm; unset if `text` is not one.
std::optional<double> ParseCoordinate(std::string_view text);

// Iterates over fields separated by commas; ignores a comma at the end. Points into the
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

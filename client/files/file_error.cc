#include "client/files/file_error.h"

#include <system_error>

#include "absl/strings/str_format.h"

namespace traverse {

absl::Status FileError(const std::string& display_name, int error_number) {
  return absl::Status(
      absl::ErrnoToStatusCode(error_number),
      absl::StrFormat("%s: %s", display_name, std::generic_category().message(error_number)));
}

}  // namespace traverse

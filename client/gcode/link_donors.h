// Links of a file that may serve as templates for ways that the file does not have.

#ifndef TRAVERSE_CLIENT_GCODE_LINK_DONORS_H_
#define TRAVERSE_CLIENT_GCODE_LINK_DONORS_H_

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "client/gcode/gcode_file.h"

namespace traverse::gcode {

class LinkDonors {
 public:
  explicit LinkDonors(const GcodeFile& file);

  // A link without marks between two paths in the modes of `block`, which retracts or not: the
  // nearest one at or before `block`, else the nearest one behind it. Nothing if there is none.
  std::optional<uint32_t> Find(uint32_t block, bool retracts) const;

 private:
  const GcodeFile& file_;
  // By mode and whether it retracts: links, ascending.
  std::map<std::pair<uint16_t, bool>, std::vector<uint32_t>> donors_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_LINK_DONORS_H_

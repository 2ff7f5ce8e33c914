#include "client/gcode/link_donors.h"

#include <algorithm>

namespace traverse::gcode {

LinkDonors::LinkDonors(const GcodeFile& file) : file_(file) {
  for (uint32_t i = 1; i < file.blocks.size(); ++i) {
    const Block& block = file.blocks[i];
    if ((block.link & (kLinkSplits | kLinkFixed)) != 0) continue;
    donors_[{block.mode, (block.link & kLinkRetracts) != 0}].push_back(i);
  }
}

std::optional<uint32_t> LinkDonors::Find(uint32_t block, bool retracts) const {
  const auto found = donors_.find({file_.blocks[block].mode, retracts});
  if (found == donors_.end()) return std::nullopt;
  const std::vector<uint32_t>& links = found->second;
  const auto behind = std::upper_bound(links.begin(), links.end(), block);
  return behind == links.begin() ? *behind : *(behind - 1);
}

}  // namespace traverse::gcode

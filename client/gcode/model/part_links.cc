#include "client/gcode/model/part_links.h"

#include "client/gcode/model/block_feature.h"

namespace traverse::gcode {
namespace {

bool IsOfPart(const GcodeFile& file, const Block& block) {
  if ((block.flags & kBlockScript) != 0) return false;
  const Feature feature = NamedFeature(file, block);
  return feature != Feature::kTower && feature != Feature::kCustom;
}

}  // namespace

bool LeadsWithinPart(const GcodeFile& file, uint32_t block) {
  return block > 0 && IsOfPart(file, file.blocks[block]) && IsOfPart(file, file.blocks[block - 1]);
}

}  // namespace traverse::gcode

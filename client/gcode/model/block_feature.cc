#include "client/gcode/model/block_feature.h"

#include <string_view>

#include "client/gcode/dialects/dialect.h"

namespace traverse::gcode {
namespace {

// Behind the semicolon of its first line.
Feature FeatureOfComment(const GcodeFile& file, const Block& block) {
  const Line line = LineAt(file.text, block.begin);
  const std::string_view text = line.Text(file.text);
  const size_t semicolon = text.find(';');
  if (semicolon == std::string_view::npos) return Feature::kCount;
  return FeatureOfMove(text.substr(semicolon + 1));
}

}  // namespace

Feature NamedFeature(const GcodeFile& file, const Block& block) {
  const uint32_t setter = file.states[block.state_in][kSlotType];
  if (setter == 0) return Feature::kCount;
  return FeatureOfType(TypeIn(file.setters.Line(setter)));
}

Feature FeatureOf(const GcodeFile& file, const Block& block, bool closed) {
  Feature feature = NamedFeature(file, block);
  if (feature == Feature::kCount) feature = FeatureOfComment(file, block);
  if (feature == Feature::kLoop && !closed) return Feature::kOverhangWall;
  if (feature != Feature::kCount) return feature;
  return closed ? Feature::kLoop : Feature::kLine;
}

}  // namespace traverse::gcode

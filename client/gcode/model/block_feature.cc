#include "client/gcode/model/block_feature.h"

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

std::string_view TypeOf(const GcodeFile& file, const Block& block) {
  return TypeIn(file.setters.Line(file.states[block.state_in][kSlotType]));
}

Feature NamedFeature(const GcodeFile& file, const Block& block) {
  return FeatureOfType(TypeOf(file, block));
}

Feature FeatureOf(const GcodeFile& file, const Block& block, bool closed) {
  Feature feature = NamedFeature(file, block);
  if (feature == Feature::kCount) feature = FeatureOfComment(file, block);
  if (feature == Feature::kLoop && !closed) return Feature::kOverhangWall;
  if (feature != Feature::kCount) return feature;
  return closed ? Feature::kLoop : Feature::kLine;
}

}  // namespace traverse::gcode

#include "client/gcode/dialects/dialect.h"

namespace traverse::gcode {
namespace {

constexpr Head kHeads[] = {{"; KISSlicer"}};

// `; 'Loop Path', 0.2 [feed mm/s], 5.2 [head mm/s]`; travel between paths has such lines, too.
constexpr Mark kMarks[] = {
    {"; '", MarkKind::kQuotedType},
    {"; 'Travel", MarkKind::kNoType},
    {"; 'Destring", MarkKind::kNoType},
    {"; 'Wipe", MarkKind::kNoType},
    {"; BEGIN_LAYER_OBJECT", MarkKind::kLayer},
    {"; END_LAYER_OBJECT", MarkKind::kNoObject, "; END_LAYER_OBJECT"},
};

constexpr FeatureWord kFeatures[] = {
    {"Perimeter Path", Feature::kOuterWall},
    {"Loop Path", Feature::kInnerWall},
    {"Solid Path", Feature::kSolidInfill},
    {"Sparse Infill Path", Feature::kSparseInfill},
    {"Stacked Sparse Infill Path", Feature::kSparseInfill},
    {"Crown Path", Feature::kSolidInfill},
    {"Support Path", Feature::kSupport},
    {"Support (may Stack) Path", Feature::kSupport},
    {"Support Interface Path", Feature::kSupportInterface},
    {"Raft Path", Feature::kSupport},
    {"Skirt Path", Feature::kSkirt},
    {"Pillar Path", Feature::kTower},
    {"Prime Pillar Path", Feature::kTower},
};

}  // namespace

const Dialect kKisslicer = {.heads = kHeads, .marks = kMarks, .features = kFeatures};

}  // namespace traverse::gcode

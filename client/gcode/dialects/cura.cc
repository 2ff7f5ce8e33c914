#include "client/gcode/dialects/dialect.h"

namespace traverse::gcode {
namespace {

// Profiles of some printers leave the line with the name out, and Cura before 2.1 wrote none.
constexpr Head kHeads[] = {{";Generated with Cura_SteamEngine"},
                           {";FLAVOR:", ";Layer height: ", "Cura"},
                           {";Sliced at: ", ";Basic settings: Layer height: ", "Cura"}};

constexpr Mark kMarks[] = {
    {";TYPE:", MarkKind::kType},
    {";LAYER:", MarkKind::kLayer},
    {";MESH:", MarkKind::kObjectBegins, ";MESH:"},
    {";MESH:NONMESH", MarkKind::kNoObject, ";MESH:"},
};

constexpr FeatureWord kFeatures[] = {
    {"WALL-OUTER", Feature::kOuterWall},
    {"WALL-INNER", Feature::kInnerWall},
    {"SKIN", Feature::kSolidInfill, /*or_ironing=*/true},
    {"FILL", Feature::kSparseInfill},
    {"SKIRT", Feature::kSkirt},
    {"SUPPORT", Feature::kSupport},
    {"SUPPORT-INTERFACE", Feature::kSupportInterface},
    {"PRIME-TOWER", Feature::kTower},
};

// The outline of the head around the nozzle, fans and all, and how high its lowest part hangs above
// the tip.
constexpr SettingWord kSettings[] = {
    {"machine_head_with_fans_polygon", Setting::kHeadPolygon},
    {"machine_nozzle_head_distance", Setting::kNozzleHeight},
    {"material_diameter", Setting::kFilamentDiameter},
};

constexpr TimeWord kTimes[] = {{"TIME:"}, {"TIME_ELAPSED:"}, {"Print Time:"}, {"Print time:"}};

}  // namespace

const Dialect kCura = {
    .heads = kHeads,
    .marks = kMarks,
    .features = kFeatures,
    .settings = kSettings,
    .times = kTimes,
    .combs = true,
};

}  // namespace traverse::gcode

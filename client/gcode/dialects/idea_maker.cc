#include "client/gcode/dialects/dialect.h"

namespace traverse::gcode {
namespace {

constexpr Head kHeads[] = {{";Sliced by ideaMaker"}};

constexpr Mark kMarks[] = {
    {";TYPE:", MarkKind::kType},
    {";WIDTH:", MarkKind::kWidth},
    {";HEIGHT:", MarkKind::kHeight},
    {";LAYER:", MarkKind::kLayer},
    {";PRINTING:", MarkKind::kObjectBegins, ";PRINTING:"},
    {";PRINTING: NON-OBJECT", MarkKind::kNoObject, ";PRINTING:"},
    {";PRINTING_ID:", MarkKind::kObjectBegins, ";PRINTING_ID:"},
    {";PRINTING_ID: -1", MarkKind::kNoObject, ";PRINTING_ID:"},
};

constexpr FeatureWord kFeatures[] = {
    {"SOLID-FILL", Feature::kSolidInfill},
    {"GAP-FILL", Feature::kGapFill},
    {"BRIDGE", Feature::kBridge},
    {"RAFT", Feature::kSupport},
    {"DENSE-SUPPORT", Feature::kSupportInterface},
    {"IRONING", Feature::kIroning},
};

constexpr TimeWord kTimes[] = {{"PRINTING_TIME:"}, {"REMAINING_TIME:"}};

}  // namespace

const Dialect kIdeaMaker = {
    .heads = kHeads,
    .marks = kMarks,
    .features = kFeatures,
    .times = kTimes,
};

}  // namespace traverse::gcode

#include "client/gcode/verify/report.h"

#include <iterator>

namespace traverse {
namespace {

struct RuleWords {
  std::string_view name;
  std::string_view text;
};

constexpr RuleWords kRules[] = {
    {"same_print", "the same is printed under the same conditions"},
    {"whole_paths", "what adjoins in a path stays adjoined"},
    {"order", "paths side by side keep their order"},
    {"direction", "visible walls keep their direction"},
    {"seam", "outer walls keep their seam"},
    {"open_ways", "no more or longer open ways across outer walls"},
    {"lifts", "ways are lifted as such ways are"},
    {"retractions", "filament is pulled back and returned as in the original"},
    {"standstill", "filament pushed at a standstill is the same"},
    {"speeds", "speed and acceleration are those of such moves"},
    {"wipes", "a wipe lies on its path, and no wipe is lost"},
    {"commands", "no command comes into a path, and none is in vain"},
    {"progress", "the sequence of M73 is the same"},
    {"scripts", "nothing of the scripts comes between paths"},
    {"path_ends", "what goes on along the end of a path stays with it"},
    {"bounds", "no way leads out of the room that the original moves in"},
};
static_assert(std::size(kRules) == static_cast<size_t>(VerifyRule::kCount));

}  // namespace

std::string_view VerifyRuleName(VerifyRule rule) { return kRules[static_cast<size_t>(rule)].name; }
std::string_view VerifyRuleText(VerifyRule rule) { return kRules[static_cast<size_t>(rule)].text; }

}  // namespace traverse

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
    {"whole_paths", "adjoining segments of a path stay together"},
    {"order", "paths side by side keep their order"},
    {"direction", "visible walls keep their direction"},
    {"seam", "outer walls keep their seam"},
    {"open_travel", "no more, and no longer, travel across outer walls without a retraction"},
    {"lifts", "travel is lifted as such travel is in the original"},
    {"retractions", "primes give back as much of what was retracted"},
    {"standstill",
     "filament pushed at a standstill beyond or short of what was retracted is the same"},
    {"speeds", "moves have the accelerations of their kind"},
    {"wipes", "wipes lie on their paths, and none is lost"},
    {"commands", "no command moves into a path, and none is without effect"},
    {"progress", "lines of progress keep their sequence, and stand where they are true"},
    {"scripts", "moves beside scripts are as they were"},
    {"path_ends", "moves that continue along a path stay with its end"},
    {"bounds", "travel is straight, but for bends around outer walls"},
    {"made_of_parts", "new travel leaves, goes and arrives as travel of the original does"},
    {"kept_travel", "between paths that still follow each other nothing changes"},
    {"obstacles", "no travel leads into what stands, or nearer to it than in the original"},
    {"rest", "islands rest as long as in the original, or for the least layer time"},
};
static_assert(std::size(kRules) == static_cast<size_t>(VerifyRule::kCount));

}  // namespace

std::string_view VerifyRuleName(VerifyRule rule) { return kRules[static_cast<size_t>(rule)].name; }
std::string_view VerifyRuleText(VerifyRule rule) { return kRules[static_cast<size_t>(rule)].text; }

}  // namespace traverse

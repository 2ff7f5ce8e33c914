// Random orders of a layer's paths that its plan allows, and files rewritten by them.

#ifndef TRAVERSE_TESTS_CLIENT_GCODE_SUPPORT_RANDOM_ORDER_H_
#define TRAVERSE_TESTS_CLIENT_GCODE_SUPPORT_RANDOM_ORDER_H_

#include <cstdint>
#include <string>

#include "client/gcode/model/gcode_file.h"
#include "client/gcode/plan/policy.h"
#include "client/gcode/write/layer_writer.h"
#include "engine/base/rng.h"

namespace traverse::v1 {
class Plan;
}

namespace traverse::gcode::testing {

// Any order and any entries that `plan` allows.
LayerOrder RandomOrder(const Layer& layer, const v1::Plan& plan, Rng& rng);

// All of `file` with every layer in a random order: no layer keeps its own for being better.
std::string Shuffled(const GcodeFile& file, Policy policy, uint64_t seed);

}  // namespace traverse::gcode::testing

#endif  // TRAVERSE_TESTS_CLIENT_GCODE_SUPPORT_RANDOM_ORDER_H_

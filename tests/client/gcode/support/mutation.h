// One change to a G-code that changes what it prints, made at random.

#ifndef TRAVERSE_TESTS_CLIENT_GCODE_SUPPORT_MUTATION_H_
#define TRAVERSE_TESTS_CLIENT_GCODE_SUPPORT_MUTATION_H_

#include <cstdint>
#include <string>

namespace traverse::gcode::testing {

struct Mutation {
  std::string what;  // "line 118: dropped `G1 X5 Y3 E.4`"
  std::string text;  // of the changed file
};

// Seeds 1, 2, ... go through the kinds of change: drop, duplicate, swap; other E, F, X, Z, fan,
// acceleration, feature, tool; retraction and priming left out or by another amount. `text` has
// relative extrusion.
Mutation Mutate(const std::string& text, uint64_t seed);

}  // namespace traverse::gcode::testing

#endif  // TRAVERSE_TESTS_CLIENT_GCODE_SUPPORT_MUTATION_H_

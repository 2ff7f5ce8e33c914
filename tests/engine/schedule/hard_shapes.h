// Plans that are hard on loops of the engine: large, deep, or with much of one kind.

#ifndef TRAVERSE_TESTS_ENGINE_SCHEDULE_HARD_SHAPES_H_
#define TRAVERSE_TESTS_ENGINE_SCHEDULE_HARD_SHAPES_H_

#include <functional>
#include <string>
#include <vector>

#include "engine/model/plan.h"

namespace traverse::testing {

struct Shape {
  std::string name;
  std::function<Plan(int)> make;  // of about so many vertices, or nodes where it is about these
  int most = 0;                   // of what the server's limits let in
};

const std::vector<Shape>& HardShapes();

}  // namespace traverse::testing

#endif  // TRAVERSE_TESTS_ENGINE_SCHEDULE_HARD_SHAPES_H_

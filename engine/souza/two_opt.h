// 2-opt: exchanges two moves of a line of blocks for two others, which reverses what lies between.
//
//   before   a -> [i ... j] -> b         reversible blocks of i..j are then traversed
//   after    a -> [j ... i] -> b         backwards, the others keep their direction
//
// A stretch may be a single block: the reversal of one raster ([T] 2.6.2). Source: SPEC 3.3; Croes
// (1958). Reversals keep precedence as in Gambardella and Dorigo (2000): a stretch grows until it
// meets a block that waits for one inside.

#ifndef TRAVERSE_ENGINE_SOUZA_TWO_OPT_H_
#define TRAVERSE_ENGINE_SOUZA_TWO_OPT_H_

#include "engine/base/budget.h"
#include "engine/souza/block_line.h"

namespace traverse {

// Reverses stretches while the line gets cheaper: for each first block in turn the best last one,
// until no pair improves. Returns the change of cost, <= 0. A pass is O(n^2) for n blocks, 25 ms
// for 5000.
double TwoOpt(BlockLine& line, Budget& budget);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SOUZA_TWO_OPT_H_

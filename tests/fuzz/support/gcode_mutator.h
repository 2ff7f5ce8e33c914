// Changes G-code line by line, so that most of what comes out is still read as G-code.

#ifndef TRAVERSE_TESTS_FUZZ_SUPPORT_GCODE_MUTATOR_H_
#define TRAVERSE_TESTS_FUZZ_SUPPORT_GCODE_MUTATOR_H_

#include <cstddef>
#include <cstdint>

namespace traverse::fuzz {

// A LLVMFuzzerCustomMutator: drops, repeats, moves or swaps lines, puts in lines of slicers and
// firmwares, changes numbers and letters. Of nothing it makes one of the small sliced files.
size_t MutateGcode(uint8_t* data, size_t size, size_t max_size, unsigned int seed);

}  // namespace traverse::fuzz

#endif  // TRAVERSE_TESTS_FUZZ_SUPPORT_GCODE_MUTATOR_H_

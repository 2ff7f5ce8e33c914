// Small jobs that use every field of the API: where fuzzing begins.

#ifndef TRAVERSE_TESTS_FUZZ_SUPPORT_SEED_JOBS_H_
#define TRAVERSE_TESTS_FUZZ_SUPPORT_SEED_JOBS_H_

#include <cstddef>
#include <cstdint>
#include <random>

#include "traverse/v1/route_optimizer_service.pb.h"

namespace traverse::fuzz {

// One of the jobs.
const v1::OptimizeBatchRequest& SeedJob(std::mt19937& random);

// Changes the job in `data` (what cannot be parsed becomes a seed job) and writes it back. Returns
// its size, at most `max_size`. What LLVMFuzzerCustomMutator calls.
size_t MutateJob(uint8_t* data, size_t size, size_t max_size, unsigned int seed);

}  // namespace traverse::fuzz

#endif  // TRAVERSE_TESTS_FUZZ_SUPPORT_SEED_JOBS_H_

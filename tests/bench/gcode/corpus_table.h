// Tables of what a corpus of sliced files gains.

#ifndef TRAVERSE_TESTS_BENCH_GCODE_CORPUS_TABLE_H_
#define TRAVERSE_TESTS_BENCH_GCODE_CORPUS_TABLE_H_

#include <string>
#include <vector>

#include "tests/bench/gcode/corpus_run.h"

namespace traverse::bench {

// Markdown: a row for each run, by policy, slicer and file, then the medians by policy and slicer.
std::string CorpusTable(const std::vector<CorpusRun>& runs);

// The same figures, one object for each run.
std::string CorpusJson(const std::vector<CorpusRun>& runs);

}  // namespace traverse::bench

#endif  // TRAVERSE_TESTS_BENCH_GCODE_CORPUS_TABLE_H_

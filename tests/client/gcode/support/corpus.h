// Sliced files for tests: those kept here, compressed, and the whole corpus where there is one.

#ifndef TRAVERSE_TESTS_CLIENT_GCODE_SUPPORT_CORPUS_H_
#define TRAVERSE_TESTS_CLIENT_GCODE_SUPPORT_CORPUS_H_

#include <string>
#include <vector>

namespace traverse::gcode::testing {

// Paths of the files under tests/data/gcode.
std::vector<std::string> KeptFiles();

// Paths of the files of the corpus: the folder that TRAVERSE_CORPUS names, or `shared/corpus/gcode`
// beside the source folder. Empty if there is neither; tests then skip, and say so.
std::vector<std::string> CorpusFiles();

// The text of a file, decompressed.
std::string TextOf(const std::string& path);

// "ps_clusters13_brim_skirt" of ".../ps_clusters13_brim_skirt.gcode.xz".
std::string NameOf(const std::string& path);

}  // namespace traverse::gcode::testing

#endif  // TRAVERSE_TESTS_CLIENT_GCODE_SUPPORT_CORPUS_H_

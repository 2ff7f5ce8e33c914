// Sliced files for tests: those kept here, compressed.

#ifndef TRAVERSE_TESTS_CLIENT_GCODE_SUPPORT_CORPUS_H_
#define TRAVERSE_TESTS_CLIENT_GCODE_SUPPORT_CORPUS_H_

#include <string>
#include <vector>

namespace traverse::gcode::testing {

// Paths of the files under tests/data/gcode.
std::vector<std::string> KeptFiles();

// The text of a file, decompressed.
std::string TextOf(const std::string& path);

// "ps_clusters13_brim_skirt" of ".../ps_clusters13_brim_skirt.gcode.xz".
std::string NameOf(const std::string& path);

}  // namespace traverse::gcode::testing

#endif  // TRAVERSE_TESTS_CLIENT_GCODE_SUPPORT_CORPUS_H_

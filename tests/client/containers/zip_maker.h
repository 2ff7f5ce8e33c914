// Zip archives made byte by byte, so that tests know what is in them and can spoil it.

#ifndef TRAVERSE_TESTS_CLIENT_CONTAINERS_ZIP_MAKER_H_
#define TRAVERSE_TESTS_CLIENT_CONTAINERS_ZIP_MAKER_H_

#include <cstdint>
#include <string>
#include <vector>

namespace traverse::testing {

struct MadeEntry {
  std::string name;
  std::string content;
  bool deflated = true;
  bool descriptor = false;  // sizes behind the data, as writers to streams leave them
  std::string local_extra = "";
  std::string extra = "";        // of the directory
  std::string gap = "";          // bytes before the local header
  uint16_t flags = 0;            // besides the descriptor's
  uint16_t method = UINT16_MAX;  // said to be it, unless UINT16_MAX
};

struct MadeZip {
  std::string bytes;
  std::vector<size_t> local;   // offsets of local headers
  std::vector<size_t> record;  // of the directory's records
  size_t end = 0;
};

MadeZip MakeZip(const std::vector<MadeEntry>& entries, const std::string& comment = "");

}  // namespace traverse::testing

#endif  // TRAVERSE_TESTS_CLIENT_CONTAINERS_ZIP_MAKER_H_

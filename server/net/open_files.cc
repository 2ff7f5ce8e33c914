#include "server/net/open_files.h"

#include <sys/resource.h>

#include <algorithm>
#include <cassert>
#include <climits>

namespace traverse {
namespace {

// For the log, certificates, listening sockets, gRPC's own, the operators' port and connections to
// other servers. Where there are very few files, a quarter of them.
constexpr int kOwnFiles = 128;

}  // namespace

int MaxOpenFiles() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return kOwnFiles;
  return static_cast<int>(std::min<rlim_t>(limit.rlim_cur, INT_MAX));
}

int FilesFor(double part) {
  assert(part > 0 && part <= 1);
  const int all = MaxOpenFiles();
  return static_cast<int>(part * (all - std::min(kOwnFiles, all / 4)));
}

int PlacesFor(double part, int files_each, int wanted) {
  assert(files_each > 0);
  return std::max(1, std::min(wanted, FilesFor(part) / files_each));
}

}  // namespace traverse

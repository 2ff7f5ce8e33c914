#include "server/ops/memory.h"

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace traverse {
namespace {

// The number in a file; `limit` if it is larger, "max", or cannot be read.
int64_t LimitOf(const std::string& path, int64_t limit) {
  std::ifstream file(path);
  int64_t value = 0;
  return file >> value && value > 0 ? std::min(limit, value) : limit;
}

// The limits of a group and of those it is in: each of them counts.
int64_t LimitOfGroups(const std::string& mount, std::string group, const char* file,
                      int64_t limit) {
  while (true) {
    limit = LimitOf(mount + group + "/" + file, limit);
    const size_t slash = group.rfind('/');
    if (slash == std::string::npos || group.size() <= 1) break;
    group.resize(slash);
  }
  return LimitOf(mount + "/" + file, limit);
}

int64_t MachineMemory(const std::string& root) {
  std::ifstream file(root + "/proc/meminfo");
  std::string name;
  int64_t kilobytes = 0;
  if (file >> name >> kilobytes && name == "MemTotal:") return kilobytes * 1024;
  return INT64_MAX;
}

}  // namespace

int64_t MemoryLimit(const std::string& root) {
  int64_t limit = MachineMemory(root);
  const std::string mount = root + "/sys/fs/cgroup";
  std::ifstream groups(root + "/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    // NUMBER:CONTROLLERS:GROUP; within a container the group is that of the host, and not there.
    const size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const std::string group = line.substr(second + 1);
    if (controllers.empty()) {
      limit = LimitOfGroups(mount, group, "memory.max", limit);
    } else if (("," + controllers + ",").find(",memory,") != std::string::npos) {
      limit = LimitOfGroups(mount + "/memory", group, "memory.limit_in_bytes", limit);
    }
  }
  return limit;
}

int64_t ResidentBytes() {
  std::ifstream file("/proc/self/statm");
  int64_t all = 0, resident = 0, shared = 0;
  if (!(file >> all >> resident >> shared)) return 0;
  return (resident - shared) * sysconf(_SC_PAGESIZE);
}

void GiveLargeBlocksBack() {
  constexpr int kLargeBytes = 4 << 20;
  mallopt(M_MMAP_THRESHOLD, kLargeBytes);  // which also stops it from being adjusted
}

}  // namespace traverse

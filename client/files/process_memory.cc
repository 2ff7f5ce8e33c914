#include "client/files/process_memory.h"

#include <malloc.h>
#include <sys/mman.h>

#include <cstdint>

namespace traverse {
namespace {

// Below this, what is saved is not worth a call of the system.
constexpr size_t kLargeBytes = size_t{8} << 20;
constexpr uintptr_t kHugePage = uintptr_t{2} << 20;

}  // namespace

void KeepFreedMemory() {
  constexpr int kMostMapped = 32 << 20;  // the most that glibc takes for this threshold
  constexpr int kTopBytes = 4 << 20;
  mallopt(M_MMAP_THRESHOLD, kMostMapped);
  mallopt(M_TRIM_THRESHOLD, INT32_MAX);
  mallopt(M_TOP_PAD, kTopBytes);
}

void ReserveLarge(std::string& text, size_t bytes) {
  text.reserve(bytes);
  if (bytes < kLargeBytes) return;
  // Only whole pages inside the room are asked for, so that nothing else becomes larger. Where the
  // system has no such pages it says so, and nothing is lost.
  const auto begin = reinterpret_cast<uintptr_t>(text.data());
  const uintptr_t first = (begin + kHugePage - 1) / kHugePage * kHugePage;
  const uintptr_t end = (begin + text.capacity()) / kHugePage * kHugePage;
  if (first < end) madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);
}

}  // namespace traverse

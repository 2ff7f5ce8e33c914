// Uploads and answers on disk, so that slow clients cost no memory.
//
// A spooled file has no name (O_TMPFILE, or unlinked as soon as it exists): when it is closed, or
// the process is killed, the system frees it. All files of a spool together are bounded, and so are
// those of a caller (Shares).

#ifndef TRAVERSE_CLIENT_GATEWAY_SPOOL_SPOOL_H_
#define TRAVERSE_CLIENT_GATEWAY_SPOOL_SPOOL_H_

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "absl/status/statusor.h"
#include "client/gateway/spool/shares.h"

namespace traverse::gateway {

class Spool;

// One file. Writing is not thread-safe; once written, several threads may read it.
class SpoolFile {
 public:
  ~SpoolFile();
  SpoolFile(const SpoolFile&) = delete;
  SpoolFile& operator=(const SpoolFile&) = delete;

  // Appends `bytes`. ResourceExhausted if the spool, or the disk below it, is full.
  absl::Status Append(std::string_view bytes);

  uint64_t size() const { return size_; }

  // Of all bytes, as xz makes it (CRC-64): equal files have the same.
  uint64_t checksum() const { return checksum_; }

  // Whether somebody was sent the end of it.
  bool sent_to_end() const { return sent_to_end_; }
  void NoteSentToEnd() const { sent_to_end_ = true; }

  // Reads up to `size` bytes from `offset` on; fewer only at the end.
  absl::StatusOr<size_t> ReadAt(uint64_t offset, char* out, size_t size) const;

  // All of it.
  absl::StatusOr<std::string> ReadAll() const;

  // Calls take(piece) for all of it, in pieces of `size` bytes, until it returns an error.
  absl::Status ForEachPiece(size_t size,
                            const std::function<absl::Status(std::string_view)>& take) const;

 private:
  friend class Spool;
  SpoolFile(Spool& spool, int fd, std::string caller)
      : spool_(spool), fd_(fd), caller_(std::move(caller)) {}

  Spool& spool_;
  const int fd_;
  const std::string caller_;
  uint64_t size_ = 0;
  uint64_t checksum_ = 0;
  mutable std::atomic<bool> sent_to_end_ = false;
};

// Thread-safe.
class Spool {
 public:
  // Files in `folder`, at most `max_bytes` together. Unavailable, with the folder's name, if files
  // cannot be created there.
  static absl::StatusOr<std::unique_ptr<Spool>> Open(const std::string& folder, uint64_t max_bytes);

  // A new, empty file. It belongs to `caller`, unless that is empty. The spool must outlive it.
  absl::StatusOr<std::shared_ptr<SpoolFile>> NewFile(const std::string& caller = "");

  // Bytes in all files now.
  uint64_t used_bytes() const { return shares_.used(); }
  uint64_t max_bytes() const { return shares_.most(); }

 private:
  friend class SpoolFile;
  Spool(std::string folder, uint64_t max_bytes) : folder_(std::move(folder)), shares_(max_bytes) {}

  absl::StatusOr<int> OpenNameless() const;

  // ResourceExhausted if this many bytes more of `caller` would be too many.
  absl::Status Take(uint64_t bytes, const std::string& caller);

  const std::string folder_;
  Shares shares_;
};

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_SPOOL_SPOOL_H_

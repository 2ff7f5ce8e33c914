#include "client/gateway/spool/spool.h"

#include <fcntl.h>
#include <lzma.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace traverse::gateway {
namespace {

absl::Status WriteFault(int error) {
  if (error == ENOSPC || error == EDQUOT || error == EFBIG) {
    return absl::ResourceExhaustedError("the disk of the spool is full");
  }
  return absl::UnavailableError(
      absl::StrFormat("the spool cannot be written: %s", std::strerror(error)));
}

}  // namespace

SpoolFile::~SpoolFile() {
  close(fd_);
  spool_.shares_.GiveBack(size_, caller_);
}

absl::Status SpoolFile::Append(std::string_view bytes) {
  if (absl::Status status = spool_.Take(bytes.size(), caller_); !status.ok()) return status;
  size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t put = write(fd_, bytes.data() + done, bytes.size() - done);
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) {
      const int error = errno;
      spool_.shares_.GiveBack(bytes.size() - done, caller_);
      size_ += done;
      return WriteFault(error);
    }
    done += static_cast<size_t>(put);
  }
  size_ += done;
  checksum_ = lzma_crc64(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size(), checksum_);
  return absl::OkStatus();
}

absl::StatusOr<size_t> SpoolFile::ReadAt(uint64_t offset, char* out, size_t size) const {
  size_t done = 0;
  while (done < size) {
    const ssize_t got = pread(fd_, out + done, size - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) {
      return absl::UnavailableError(
          absl::StrFormat("the spool cannot be read: %s", std::strerror(errno)));
    }
    if (got == 0) break;
    done += static_cast<size_t>(got);
  }
  return done;
}

absl::StatusOr<std::string> SpoolFile::ReadAll() const {
  std::string bytes(size_, '\0');
  absl::StatusOr<size_t> got = ReadAt(0, bytes.data(), bytes.size());
  if (!got.ok()) return got.status();
  if (*got != bytes.size()) return absl::DataLossError("part of a file is missing from the spool");
  return bytes;
}

absl::Status SpoolFile::ForEachPiece(
    size_t size, const std::function<absl::Status(std::string_view)>& take) const {
  std::string piece;
  for (uint64_t at = 0; at < size_; at += piece.size()) {
    piece.resize(std::min<uint64_t>(size, size_ - at));
    const absl::StatusOr<size_t> got = ReadAt(at, piece.data(), piece.size());
    if (!got.ok()) return got.status();
    if (absl::Status status = take(piece); !status.ok()) return status;
  }
  return absl::OkStatus();
}

absl::StatusOr<std::unique_ptr<Spool>> Spool::Open(const std::string& folder, uint64_t max_bytes) {
  std::unique_ptr<Spool> spool(new Spool(folder, max_bytes));
  absl::StatusOr<int> file = spool->OpenNameless();
  if (!file.ok()) return file.status();
  close(*file);
  return spool;
}

absl::StatusOr<std::shared_ptr<SpoolFile>> Spool::NewFile(const std::string& caller) {
  absl::StatusOr<int> file = OpenNameless();
  if (!file.ok()) return file.status();
  return std::shared_ptr<SpoolFile>(new SpoolFile(*this, *file, caller));
}

absl::StatusOr<int> Spool::OpenNameless() const {
  int file = open(folder_.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file >= 0) return file;
  if (errno == EOPNOTSUPP || errno == EISDIR || errno == EINVAL) {  // not on this file system
    std::string name = folder_ + "/traverse-spool-XXXXXX";
    file = mkostemp(name.data(), O_CLOEXEC);
    if (file >= 0) {
      unlink(name.c_str());
      return file;
    }
  }
  return absl::UnavailableError(absl::StrFormat("cannot create a file in the spool folder %s: %s",
                                                folder_, std::strerror(errno)));
}

absl::Status Spool::Take(uint64_t bytes, const std::string& caller) {
  const std::optional<Shares::Refusal> refusal = shares_.Take(bytes, caller);
  if (!refusal) return absl::OkStatus();
  const std::string most = absl::StrFormat("%d MiB", refusal->most >> 20);
  return absl::ResourceExhaustedError(
      refusal->of_caller
          ? absl::StrCat("the spool is full for this caller, who may have ", most, " of it now")
          : absl::StrCat("the spool is full: it holds ", most, " at most"));
}

}  // namespace traverse::gateway

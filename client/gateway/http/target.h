// The target in the first line of a request: path and query.

#ifndef TRAVERSE_CLIENT_GATEWAY_HTTP_TARGET_H_
#define TRAVERSE_CLIENT_GATEWAY_HTTP_TARGET_H_

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace traverse::gateway {

struct Target {
  std::string path;
  std::vector<std::pair<std::string, std::string>> query;
};

// Cuts "http://HOST:PORT" off an absolute target, as clients of proxies send it; returns HOST:PORT,
// or nothing if the target is another.
std::string TakeOrigin(std::string_view& target);

// Parses "/path?name=value&...", decodes percent escapes, and in the query also `+`.
// InvalidArgument for what no client of ours sends: invalid escapes, control characters, a path
// that is not absolute or has the segments `.` or `..`.
absl::StatusOr<Target> ParseTarget(std::string_view target);

// OK if `name` can be a file name: one segment of a path, without control characters or slashes of
// either kind, not `.` or `..`, in UTF-8, no longer than 255 bytes.
absl::Status CheckFileName(std::string_view name);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_HTTP_TARGET_H_

// What stands in the first line of a request: path and query.

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

// Parses "/path?name=value&...", percent escapes undone, in the query `+` too. InvalidArgument for
// what no client of ours sends: escapes that are none, control characters, a path that is not
// absolute or has the segments `.` or `..`.
absl::StatusOr<Target> ParseTarget(std::string_view target);

// OK if `name` is fit to be the name of a file: one segment of a path, without control characters
// or slashes of either kind, not `.` or `..`, of UTF-8, no longer than 255 bytes.
absl::Status CheckFileName(std::string_view name);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_HTTP_TARGET_H_

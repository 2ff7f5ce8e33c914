// Sends files to printers' own servers, by libcurl.

#ifndef TRAVERSE_CLIENT_GATEWAY_OCTOPRINT_UPSTREAM_H_
#define TRAVERSE_CLIENT_GATEWAY_OCTOPRINT_UPSTREAM_H_

#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "client/gateway/octoprint/printers_config.h"
#include "client/gateway/spool/spool.h"

namespace traverse::gateway {

// The answer of a printer's server.
struct UpstreamAnswer {
  int status = 0;
  std::string content_type;
  std::string location;  // header of that name
  std::string body;      // the first MiB
};

// A file for a printer, in the form of OctoPrint's API.
struct PrinterUpload {
  std::string storage;  // "local" or "sdcard"
  std::string name;     // checked by CheckFileName
  bool print = false;
  std::vector<std::pair<std::string, std::string>> fields;  // select, path and others, unchanged
};

struct UpstreamLimits {
  absl::Duration connect_time = absl::Seconds(10);
  absl::Duration idle_time = absl::Seconds(60);  // without a byte, either way
};

// Sends `file` to `printer`, with `api_key` unless it is empty. Returns the server's answer,
// whatever its status; if a Moonraker or a PrusaLink accepted the file, its answer in OctoPrint's
// form. Errors: Unavailable if the server cannot be reached or breaks off, DeadlineExceeded if it
// is too slow. Blocks; tries nothing twice.
absl::StatusOr<UpstreamAnswer> SendToPrinter(const Printer& printer, const std::string& api_key,
                                             const PrinterUpload& upload, const SpoolFile& file,
                                             const UpstreamLimits& limits);

// Asks for the server's version: OctoPrint's own answer, or one in its form.
absl::StatusOr<UpstreamAnswer> AskVersion(const Printer& printer, const std::string& api_key,
                                          const UpstreamLimits& limits);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_OCTOPRINT_UPSTREAM_H_

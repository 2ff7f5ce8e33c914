// The printers to which uploads are passed: the file of --printers.
//
//   {"default": "mk3",
//    "printers": [
//      {"name": "mk3", "kind": "octoprint", "url": "http://mk3.local:5000"},
//      {"name": "voron", "kind": "moonraker", "url": "https://voron.local", "tls_ca": "ca.pem",
//       "api_key_file": "/etc/traverse/voron.key", "policy": "balanced", "on_failure": "refuse"}]}

#ifndef TRAVERSE_CLIENT_GATEWAY_OCTOPRINT_PRINTERS_CONFIG_H_
#define TRAVERSE_CLIENT_GATEWAY_OCTOPRINT_PRINTERS_CONFIG_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/gcode/machine/machine_limits.h"
#include "client/gcode/plan/policy.h"

namespace traverse::gateway {

enum class PrinterKind { kOctoPrint, kMoonraker, kPrusaLink };

struct Printer {
  std::string name;  // letters, digits, '.', '_' and '-'
  PrinterKind kind = PrinterKind::kOctoPrint;
  std::string url;                // http or https, without the last slash of its path
  std::string tls_ca;             // a file; empty: the system's authorities
  std::string api_key;            // empty: the caller's own key is passed on
  std::string storage = "local";  // of a PrusaLink: "local", "usb", "sdcard"
  gcode::Policy policy = gcode::Policy::kSafe;
  std::optional<gcode::MachineLimits> machine;  // unset: as files state
  bool refuse_on_failure = false;               // otherwise the original goes on
};

struct PrintersConfig {
  std::vector<Printer> printers;
  std::string default_name;  // the printer at /api; empty: none

  const Printer* Find(const std::string& name) const;
};

// InvalidArgument, in one line with the field's path, for mistakes; Unavailable for a file, or a
// key file, that cannot be read.
absl::StatusOr<PrintersConfig> ParsePrinters(const std::string& json);
absl::StatusOr<PrintersConfig> ReadPrinters(const std::string& path);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_OCTOPRINT_PRINTERS_CONFIG_H_

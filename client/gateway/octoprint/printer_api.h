// OctoPrint's upload API in front of printers: slicers send a file here as if it were OctoPrint,
// and the printer gets it with less travel.
//
//   /api/version, /api/files/local, /api/files/sdcard     the printer that is the default
//   /printers/NAME/api/...                                the printer of that name
//
// No print is ever lost: if a file cannot be rewritten, or not before its deadline, the original
// goes on unchanged; log, metrics and the header Traverse-Reason say why.

#ifndef TRAVERSE_CLIENT_GATEWAY_OCTOPRINT_PRINTER_API_H_
#define TRAVERSE_CLIENT_GATEWAY_OCTOPRINT_PRINTER_API_H_

#include <functional>
#include <memory>
#include <string>

#include "absl/time/time.h"
#include "client/gateway/api/upload.h"
#include "client/gateway/core.h"
#include "client/gateway/http/message.h"
#include "client/gateway/octoprint/printers_config.h"
#include "client/gateway/octoprint/upstream.h"
#include "engine/base/mutex.h"

namespace traverse::gateway {

struct PrinterApiOptions {
  PrintersConfig printers;
  absl::Duration upload_deadline = absl::Seconds(60);  // for the work on one file
  UpstreamLimits upstream;
};

// Thread-safe.
class PrinterApi {
 public:
  // `core` must outlive it.
  PrinterApi(Core& core, PrinterApiOptions options) : core_(core), options_(std::move(options)) {}

  // Waits for the running uploads.
  ~PrinterApi();

  // A request to one of the paths above.
  HttpDecision Handle(const HttpRequest& request, const std::string& caller);

 private:
  // One upload in progress.
  struct Delivery;

  HttpDecision HandleUpload(const HttpRequest& request, const std::string& caller,
                            const Printer& printer, const std::string& storage);
  HttpDecision HandleVersion(const HttpRequest& request, const std::string& caller,
                             const Printer& printer);
  // The key for the printer's own server: that of the configuration, or else the caller's.
  std::string KeyFor(const Printer& printer, const HttpRequest& request);

  void Deliver(Delivery& delivery);
  void Optimise(Delivery& delivery);
  void Answer(Delivery& delivery, const absl::StatusOr<UpstreamAnswer>& answer);

  // Runs `work`, which waits for others, on a thread of its own. Answers `reply` itself if the
  // process may have no more threads.
  void Spawn(HttpReply& reply, std::function<void()> work);

  Core& core_;
  const PrinterApiOptions options_;
  Mutex mutex_;
  ConditionVariable ended_;
  int threads_ TRAVERSE_GUARDED_BY(mutex_) = 0;
};

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_OCTOPRINT_PRINTER_API_H_

// Files that come with a request: as its body, or in a form.

#ifndef TRAVERSE_CLIENT_GATEWAY_API_UPLOAD_H_
#define TRAVERSE_CLIENT_GATEWAY_API_UPLOAD_H_

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "client/gateway/http/message.h"
#include "client/gateway/spool/spool.h"

namespace traverse::gateway {

// Everything that came.
struct Upload {
  struct File {
    std::string field;  // of the form; empty: the file is the body itself
    std::string name;   // as sent, not checked; may be empty
    std::shared_ptr<SpoolFile> file;
  };
  std::vector<File> files;
  std::vector<std::pair<std::string, std::string>> fields;  // of the form, except files
};

struct UploadLimits {
  uint64_t max_file_bytes = uint64_t{256} << 20;
  size_t max_files = 1;
  std::string caller = {};  // whose files they are

  // Files of a form that may come once each besides: [field] their most bytes.
  std::map<std::string, uint64_t> small_files = {};
};

using UploadDone = std::function<void(Upload upload, std::shared_ptr<HttpReply> reply)>;

// Receives the body of `request` into `spool`; `done` gets it when it is complete. Refuses at once
// what the head already shows: too long, an unknown encoding or type. `spool` must outlive the
// result.
HttpDecision TakeUpload(const HttpRequest& request, Spool& spool, const UploadLimits& limits,
                        UploadDone done);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_API_UPLOAD_H_

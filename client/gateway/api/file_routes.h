// The paths that accept files: /v1/gcode, /v1/inspect, /v1/verify.

#ifndef TRAVERSE_CLIENT_GATEWAY_API_FILE_ROUTES_H_
#define TRAVERSE_CLIENT_GATEWAY_API_FILE_ROUTES_H_

#include <string>
#include <utility>
#include <vector>

#include "client/gateway/core.h"
#include "client/gateway/http/message.h"
#include "client/gateway/work/file_worker.h"

namespace traverse::gateway {

// POST /v1/gcode: the file with less travel. Depending on Accept: the file (default), its summary
// as JSON, or events during the work, which include the file.
HttpDecision RewriteRoute(const HttpRequest& request, const std::string& caller, Core& core);

// POST /v1/inspect: describes a file, as JSON.
HttpDecision InspectRoute(const HttpRequest& request, const std::string& caller, Core& core);

// POST /v1/verify: a form with the files `original` and `optimised`; says as JSON whether they
// print the same.
HttpDecision VerifyRoute(const HttpRequest& request, const std::string& caller, Core& core);

// What the log and the metrics say about a file.
struct FileRecord {
  std::string route;
  std::string caller;
  std::string peer;
  std::string name;
  uint64_t bytes = 0;
  double seconds = 0;
};
void RecordFile(Core& core, const FileRecord& record, const absl::Status& status,
                const v1::RewriteSummary* summary);

// The summary as headers: Traverse-Policy, Traverse-Travel-Mm, ...
std::vector<std::pair<std::string, std::string>> SummaryHeaders(const v1::RewriteSummary& summary);

// A message of the API as JSON, with all of its fields under their names in the .proto.
std::string MessageJson(const google::protobuf::Message& message);

// `attachment; filename=...` for a name that CheckFileName accepts.
std::string AttachmentHeader(const std::string& name);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_API_FILE_ROUTES_H_

// The paths of files as jobs, below /v1/jobs.

#ifndef TRAVERSE_CLIENT_GATEWAY_API_JOB_ROUTES_H_
#define TRAVERSE_CLIENT_GATEWAY_API_JOB_ROUTES_H_

#include <string>

#include "client/gateway/core.h"
#include "client/gateway/http/message.h"

namespace traverse::gateway {

// Whether `path` is /v1/jobs or below it.
bool IsJobPath(const std::string& path);

// Answers for such a path, and sets `route` to its pattern, which has no ids:
//   POST   /v1/jobs             takes a file as RewriteRoute does, and answers 202 at once
//   GET    /v1/jobs/ID          the job as JSON, or events until it has ended
//   DELETE /v1/jobs/ID          ends and forgets it
//   GET    /v1/jobs/ID/file     the new file
//   GET    /v1/jobs/ID/report   the report
HttpDecision JobRoute(const HttpRequest& request, const std::string& caller, Core& core,
                      std::string& route);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_API_JOB_ROUTES_H_

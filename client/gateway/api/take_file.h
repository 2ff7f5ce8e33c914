// Files that come with a request, and the request's place in the queue.

#ifndef TRAVERSE_CLIENT_GATEWAY_API_TAKE_FILE_H_
#define TRAVERSE_CLIENT_GATEWAY_API_TAKE_FILE_H_

#include <functional>
#include <memory>
#include <string>
#include <variant>

#include "client/gateway/api/parameters.h"
#include "client/gateway/api/upload.h"
#include "client/gateway/core.h"
#include "client/gateway/http/message.h"
#include "client/gateway/work/file_worker.h"

namespace traverse::gateway {

using TicketPtr = std::shared_ptr<WorkQueue::Ticket>;
using ReplyPtr = std::shared_ptr<HttpReply>;

// A place in the queue for a request of `caller`, or the refusal: 429, or 503 while draining.
std::variant<HttpResponse, TicketPtr> EnterQueue(const std::string& caller, Core& core);

// Gives `caller` a place in the queue, and takes the request's files; `start` is called when they
// are there. Refuses where there is no place.
using FilesTaken = std::function<void(const TicketPtr&, Upload, const ReplyPtr&)>;
HttpDecision TakeFiles(const HttpRequest& request, const UploadLimits& limits, Core& core,
                       FilesTaken start);

// A file, and what is asked of it.
struct TakenFile {
  TicketPtr ticket;
  FileRequest wanted;
  std::shared_ptr<SpoolFile> file;  // not empty
  std::string print;                // equal for equal files with equal parameters but time
  ReplyPtr reply;
};

// The same for one file with the parameters of ParameterTable, whose faults are answered.
HttpDecision TakeFile(const HttpRequest& request, const std::string& caller, Core& core,
                      std::function<void(TakenFile)> start);

// The parameters of the query and of the form.
Parameters AllParameters(const HttpRequest& request, const Upload& upload);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_API_TAKE_FILE_H_

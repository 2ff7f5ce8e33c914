// The answer to layers that came as JSON: in lines as they come, or as one document.

#ifndef TRAVERSE_CLIENT_GATEWAY_API_LAYER_ANSWER_H_
#define TRAVERSE_CLIENT_GATEWAY_API_LAYER_ANSWER_H_

#include <memory>
#include <string>

#include "absl/status/status.h"
#include "client/gateway/http/message.h"
#include "client/gateway/spool/spool.h"
#include "traverse/v1/route_optimizer_service.pb.h"

namespace traverse::gateway {

// Not thread-safe. Nothing in it waits for the client: what he has not read is in the spool.
class LayerAnswer {
 public:
  virtual ~LayerAnswer() = default;

  // Adds one message. ResourceExhausted if the spool, or the caller's share of it, is full.
  virtual absl::Status Add(const v1::OptimizeBatchResponse& message) = 0;

  // Ends the answer, with the reason if it is not complete. Once, as the last call.
  virtual void Finish(const absl::Status& status) = 0;
};

// In lines of JSON (application/x-ndjson), each sent as soon as it is there. A reason that comes
// after the first line becomes the last one, {"error": PROBLEM}. `spool` and `reply` outlive it.
std::unique_ptr<LayerAnswer> AnswerInLines(Spool& spool, const std::string& caller,
                                           std::shared_ptr<HttpReply> reply);

// As one document, {"results": [MESSAGE, ...]}, once it is complete; otherwise as a problem.
std::unique_ptr<LayerAnswer> AnswerAsDocument(Spool& spool, const std::string& caller,
                                              std::shared_ptr<HttpReply> reply);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_API_LAYER_ANSWER_H_

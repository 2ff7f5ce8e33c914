// The service inside this process: the same object that traverse-server serves, behind an
// in-process channel, so that all jobs take the same path. Opens no port.

#ifndef TRAVERSE_CLIENT_API_EMBEDDED_H_
#define TRAVERSE_CLIENT_API_EMBEDDED_H_

#include <grpcpp/channel.h>

#include <memory>

#include "absl/status/statusor.h"

namespace traverse {

class EmbeddedService {
 public:
  // Starts a service with `threads` workers. REQUIRES: threads >= 1.
  static absl::StatusOr<std::unique_ptr<EmbeddedService>> Start(int threads);

  // Ends all calls. Channels stay valid; calls on them fail.
  virtual ~EmbeddedService() = default;

  virtual std::shared_ptr<grpc::Channel> channel() = 0;
};

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_API_EMBEDDED_H_

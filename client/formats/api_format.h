// The service's own messages as files: OptimizeBatchRequest, in protobuf's JSON mapping or in wire
// format; in JSON also others.

#ifndef TRAVERSE_CLIENT_FORMATS_API_FORMAT_H_
#define TRAVERSE_CLIENT_FORMATS_API_FORMAT_H_

#include <google/protobuf/message.h>

#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "client/input/input_job.h"

namespace traverse {

// The job in `bytes`, with the options that the request states. InvalidArgument `name: ...` if they
// are not such a message. The service checks the values.
absl::StatusOr<InputJob> ReadApiJson(std::string_view bytes, const std::string& name);
absl::StatusOr<InputJob> ReadApiProto(std::string_view bytes, const std::string& name);

// `job` as such a file. Open paths keep all their points. InvalidArgument if the message would
// exceed protobuf's 2 GiB. In JSON, numbers that are not finite are strings, as in protobuf.
absl::StatusOr<std::string> WriteApiJson(const InputJob& job);
absl::StatusOr<std::string> WriteApiProto(const InputJob& job);

// Any message of the API, with the names of fields as in its .proto file.
absl::StatusOr<std::string> ApiMessageJson(const google::protobuf::Message& message);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_FORMATS_API_FORMAT_H_

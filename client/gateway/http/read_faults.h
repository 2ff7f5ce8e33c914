// The answer to a client whose request could not be read to its end.

#ifndef TRAVERSE_CLIENT_GATEWAY_HTTP_READ_FAULTS_H_
#define TRAVERSE_CLIENT_GATEWAY_HTTP_READ_FAULTS_H_

#include <boost/system/error_code.hpp>
#include <cstdint>
#include <optional>

#include "client/gateway/http/message.h"

namespace traverse::gateway {

// The answer to a head on which Beast ended with `error`; unset if nobody waits for one.
// `timed_out`: its time was over; `begun`: part of it had come.
std::optional<HttpResponse> HeadFault(boost::system::error_code error, bool timed_out, bool begun);

// The same for a body of which `received` bytes had come.
HttpResponse BodyFault(boost::system::error_code error, bool timed_out, uint64_t received);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_HTTP_READ_FAULTS_H_

// What a verification found, as the API says it.

#ifndef TRAVERSE_CLIENT_GATEWAY_WORK_VERIFY_ANSWER_H_
#define TRAVERSE_CLIENT_GATEWAY_WORK_VERIFY_ANSWER_H_

#include "client/gcode/verify/report.h"
#include "traverse/v1/gcode_service.pb.h"

namespace traverse::gateway {

// Every rule of `report`, with its first break.
v1::VerifyResponse VerifyAnswer(const VerifyReport& report);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_WORK_VERIFY_ANSWER_H_

"""When a call is worth another try, and after how long."""

import random
from typing import Optional

import grpc

from traverse_client.wire import retry_info_pb2

# The first says "ask another server", the second "not now". A proxy resets a stream (CANCELLED) when the server behind it
# closes its connection, and gRPC says "Stream removed" (UNKNOWN) when a connection goes at the wrong moment; our servers
# send neither.
RETRIED = (grpc.StatusCode.UNAVAILABLE, grpc.StatusCode.RESOURCE_EXHAUSTED, grpc.StatusCode.CANCELLED,
           grpc.StatusCode.UNKNOWN)


def stated_delay(error: grpc.RpcError) -> Optional[float]:
    """Seconds that the server asks to wait, or None."""
    for key, value in error.trailing_metadata() or ():
        if key == "grpc-status-details-bin":
            for detail in retry_info_pb2.Status.FromString(value).details:
                if detail.type_url.endswith("/google.rpc.RetryInfo"):
                    info = retry_info_pb2.RetryInfo.FromString(detail.value)
                    return info.retry_delay.ToTimedelta().total_seconds()
    return None


def delay_before(error: grpc.RpcError, attempt: int) -> float:
    """Seconds to wait before attempt number `attempt + 1`: as the server asks, else 0.1 s doubled up to 5 s, and chance."""
    stated = stated_delay(error)
    if stated is not None:
        return stated * random.uniform(1, 1.2)
    return min(5.0, 0.1 * 2**min(attempt, 10)) * random.uniform(0.8, 1.2)

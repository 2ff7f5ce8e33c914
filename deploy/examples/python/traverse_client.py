"""A client of Traverse for a scheduler to copy: one job, layer by layer, through refusals and restarts.

    client = TraverseClient(["10.0.0.1:50051", "10.0.0.2:50051"])
    for result in client.optimize(request, deadline_seconds=30):
        print(result.index, result.travel.total_mm)

What it takes care of:

- Several servers: each attempt goes to the next one that its health service calls serving.
- A server that goes away (UNAVAILABLE) or is full (RESOURCE_EXHAUSTED): tried again, after the delay that
  the server asks for or a growing one of its own, until the deadline.
- Nothing is computed twice: an attempt asks only for the layers that are still missing.
- The deadline: the server answers before it, with the best routes it has. So DEADLINE_EXCEEDED means
  that no server was reached in time.
"""

import json
import random
import time
from typing import Iterator, Optional, Sequence

import grpc

from google.rpc import error_details_pb2, status_pb2
from traverse.v1 import options_pb2, route_optimizer_service_pb2 as api
from traverse.v1 import route_optimizer_service_pb2_grpc as service

# Worth another try: the first says "ask another server", the second "not now". The third is not ours, for this client
# cancels no call that it waits for: a proxy resets a stream so when the server behind it closes its connection. Nor is
# the fourth: gRPC itself says "Stream removed" when a connection goes at the wrong moment; our servers never send it.
RETRIED = (grpc.StatusCode.UNAVAILABLE, grpc.StatusCode.RESOURCE_EXHAUSTED, grpc.StatusCode.CANCELLED,
           grpc.StatusCode.UNKNOWN)

# Round-robin over all addresses whose health service says SERVING.
SERVICE_CONFIG = json.dumps({
    "loadBalancingConfig": [{"round_robin": {}}],
    "healthCheckConfig": {"serviceName": "traverse.v1.RouteOptimizerService"},
})


class JobFailed(Exception):
    """The job cannot be done: `code` is a grpc.StatusCode, the text says what is wrong and where."""

    def __init__(self, code: grpc.StatusCode, details: str):
        super().__init__(f"{code.name}: {details}")
        self.code = code


class TraverseClient:
    """Connections to a fleet. Thread-safe; make one and keep it."""

    def __init__(self, addresses: Sequence[str], credentials: Optional[grpc.ChannelCredentials] = None,
                 server_name: Optional[str] = None):
        """`server_name`: what the servers' certificates say, if it is not the address; with several addresses it never is."""
        # One address may be a name with many servers behind it: dns:///traverse-headless:50051.
        target = addresses[0] if len(addresses) == 1 else "ipv4:" + ",".join(addresses)
        options = [("grpc.service_config", SERVICE_CONFIG),
                   ("grpc.keepalive_time_ms", 60_000),
                   ("grpc.max_reconnect_backoff_ms", 2_000)]
        if server_name:
            options.append(("grpc.ssl_target_name_override", server_name))
        self._channel = (grpc.secure_channel(target, credentials, options) if credentials
                         else grpc.insecure_channel(target, options))
        self._stub = service.RouteOptimizerServiceStub(self._channel)

    def close(self) -> None:
        self._channel.close()

    def optimize(self, job: api.OptimizeBatchRequest, deadline_seconds: float) -> Iterator[api.LayerResult]:
        """Yields the routes in build order, each as soon as it is there; raises JobFailed.

        A result's `index` is the layer's position in `job`, in whichever attempt it was solved. Stop
        iterating and the server stops working.
        """
        deadline = time.monotonic() + deadline_seconds
        request = api.OptimizeBatchRequest()
        request.CopyFrom(job)
        request.options.result_order = options_pb2.RESULT_ORDER_BUILD  # what came is then a prefix
        done = attempt = 0
        while True:
            last = None
            # wait_for_ready: until a server can be reached, but not beyond the deadline.
            call = self._stub.OptimizeBatch(request, timeout=deadline - time.monotonic(), wait_for_ready=True)
            try:
                for answer in call:
                    if answer.WhichOneof("result") == "layer":
                        last, attempt = answer.layer, 0
                        last.index += done
                        yield last
                return
            except grpc.RpcError as error:
                delay = _retry_delay(error, attempt)
                if error.code() not in RETRIED or time.monotonic() + delay >= deadline:
                    raise JobFailed(error.code(), error.details()) from error
            finally:
                call.cancel()  # nothing if it has ended
            if last is not None:
                _drop_done(request, last, last.index + 1 - done)
                done = last.index + 1
            attempt += 1
            time.sleep(delay)


def _drop_done(request: api.OptimizeBatchRequest, last: api.LayerResult, count: int) -> None:
    """Turns `request` into one for what is left after its first `count` layers, of which `last` is the last."""
    del request.layers[:count]
    options = request.options
    start = last.end
    if options.HasField("cleaning"):
        since = (options.cleaning.layers_since_cleaning + count) % options.cleaning.every_layers
        options.cleaning.layers_since_cleaning = since
        if since == 0:
            start = options.cleaning.point
    options.start.CopyFrom(start)


def _retry_delay(error: grpc.RpcError, attempt: int) -> float:
    """Seconds to wait: what the server asks for, else 0.1 s doubled with each attempt up to 5 s, and some chance."""
    for key, value in error.trailing_metadata() or ():
        if key == "grpc-status-details-bin":
            for detail in status_pb2.Status.FromString(value).details:
                info = error_details_pb2.RetryInfo()
                if detail.Unpack(info):
                    return info.retry_delay.ToTimedelta().total_seconds() * random.uniform(1, 1.2)
    return min(5.0, 0.1 * 2 ** attempt) * random.uniform(0.8, 1.2)

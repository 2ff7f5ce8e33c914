"""Layers in, routes out."""

import itertools
import threading
import time
from typing import Iterable, Iterator, List, Optional, Sequence, Union

import grpc

from traverse_client import channels, retries
from traverse_client.errors import TraverseError
from traverse_client.remaining_job import RemainingJob, is_whole, opening
from traverse_client.wire import options_pb2, plan_pb2
from traverse_client.wire import route_optimizer_service_pb2 as api
from traverse_client.wire import route_optimizer_service_pb2_grpc as service

SERVICE = "traverse.v1.RouteOptimizerService"


class TravelOptimizer:
    """Connections to one or several servers. Thread-safe; make one and keep it, and close it in the end.

    addresses: HOST:PORT of each server, or one name with many servers behind it (dns:///traverse:50051).
    credentials: grpc.ssl_channel_credentials(...); None: plaintext.
    token: the bearer token, or a function that returns the one of now.
    server_name: what the servers' certificates say, if it is not the address.
    """

    def __init__(self, addresses: Sequence[str], credentials: Optional[grpc.ChannelCredentials] = None, *,
                 token: Optional[channels.Token] = None, server_name: Optional[str] = None):
        self._channel = channels.channel(grpc.secure_channel, grpc.insecure_channel, SERVICE, addresses, credentials,
                                         server_name)
        self._stub = service.RouteOptimizerServiceStub(self._channel)
        self._token = token

    def __enter__(self) -> "TravelOptimizer":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Ends the connections; jobs under way fail."""
        self._channel.close()

    def optimize(self, layers: Union[Sequence[plan_pb2.Layer], Iterable[plan_pb2.Layer]], deadline_seconds: float = 30.0,
                 *, strategy: Optional[str] = None,
                 options: Optional[options_pb2.JobOptions] = None) -> Iterator[api.LayerResult]:
        """Yields the routes in build order, each as soon as it is there.

        layers: a list or tuple goes out at once, and faults of all its layers come before any work. Any other iterable is
        read as the server takes layers; what it raises ends the job and comes out here.
        deadline_seconds: for the whole job, with all attempts. The server answers before it with the best it has.
        strategy: instead of that of `options`; None for both: the server's default.

        A server that goes away or is full is tried again, on another address, until the deadline; layers that were
        answered are not asked again. A result's `index` is the layer's position in the job. Stop iterating, or close the
        generator, and the server stops working. Raises TraverseError.
        """
        deadline = time.monotonic() + deadline_seconds
        if is_whole(layers):
            job = RemainingJob(options, strategy, layers)  # type: ignore[arg-type]
            return self._attempts(job, deadline, lambda: self._stub.OptimizeBatch(
                job.batch(), timeout=deadline - time.monotonic(), wait_for_ready=True,
                metadata=channels.authorization(self._token)))
        job = RemainingJob(options, strategy)
        source = _Source(iter(layers))
        return self._attempts(job, deadline, lambda: self._stub.Optimize(
            source.requests(job), timeout=deadline - time.monotonic(), wait_for_ready=True,
            metadata=channels.authorization(self._token)), source)

    def _attempts(self, job, deadline, begin, source=None):
        attempt = 0
        while True:
            call = begin()
            try:
                for answer in call:
                    if answer.WhichOneof("result") == "layer":
                        attempt = 0
                        yield job.answered(answer.layer)
                return
            except grpc.RpcError as error:
                if source is not None and source.fault is not None:
                    raise source.fault from None
                delay = retries.delay_before(error, attempt)
                if error.code() not in retries.RETRIED or time.monotonic() + delay >= deadline:
                    raise TraverseError(error.code(), error.details()) from error
            finally:
                call.cancel()  # nothing if it has ended
                if source is not None:
                    source.leave()
            attempt += 1
            time.sleep(delay)

    def strategies(self, timeout_seconds: float = 10.0) -> "Strategies":
        """The strategies of the servers with their options, and what else these can do. Raises TraverseError."""
        try:
            answer = self._stub.ListStrategies(api.ListStrategiesRequest(), timeout=timeout_seconds, wait_for_ready=True,
                                               metadata=channels.authorization(self._token))
        except grpc.RpcError as error:
            raise TraverseError(error.code(), error.details()) from error
        return Strategies(answer)


class Strategies(List[api.StrategyInfo]):
    """The strategies of a server, in the order of growing effort.

    default_strategy: the name of the one for jobs that name none.
    server_version: such as 0.1.0.
    capabilities: words for what the server can do, as proto/VERSIONS.md has them: ask for one
    before you send what an older server refuses with UNIMPLEMENTED.
    """

    def __init__(self, answer: api.ListStrategiesResponse):
        super().__init__(answer.strategies)
        self.default_strategy: str = answer.default_strategy
        self.server_version: str = answer.server_version
        self.capabilities: List[str] = list(answer.capabilities)


class _Source:
    """A caller's iterator of layers, which gRPC reads on a thread of each attempt. What is being fetched when one ends goes
    to the next; nobody else waits for it."""

    def __init__(self, layers: Iterator[plan_pb2.Layer]):
        self._layers = layers
        self._attempt = 0
        self._changed = threading.Condition()
        self._reading = False  # the thread of an attempt, which may be over, asks the iterator
        self._fetched: Optional[plan_pb2.Layer] = None  # and not sent
        self.fault: Optional[BaseException] = None

    def leave(self) -> None:
        """The attempt under way is over: its thread sends no further layer."""
        with self._changed:
            self._attempt += 1
            self._changed.notify_all()

    def requests(self, job: RemainingJob) -> Iterator[api.OptimizeRequest]:
        """The messages of a new attempt, which begins now: gRPC's thread may get its first turn when it is over."""
        return itertools.chain(opening(job), self._rest(job, self._attempt))

    def _rest(self, job: RemainingJob, attempt: int) -> Iterator[api.OptimizeRequest]:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: attempt != self._attempt or not self._reading)
                if attempt != self._attempt:
                    return
                self._reading = True
            self._fetch()  # without the lock, because this may take long
            with self._changed:
                self._reading = False
                self._changed.notify_all()
                if attempt != self._attempt:
                    return
                if self.fault is not None:
                    raise self.fault
                layer, self._fetched = self._fetched, None
                if layer is None:
                    return
                job.sent(layer)
            yield api.OptimizeRequest(layers=[layer])

    def _fetch(self) -> None:
        """Asks the iterator, unless what it said to an attempt that was over is still there."""
        if self._fetched is None and self.fault is None:
            try:
                self._fetched = next(self._layers, None)
            except BaseException as fault:  # pylint: disable=broad-except
                self.fault = fault

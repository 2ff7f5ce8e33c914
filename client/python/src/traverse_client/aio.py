"""The same clients for asyncio."""

import asyncio
import time
from typing import Any, AsyncIterable, AsyncIterator, Iterable, Optional, Sequence, Union

import grpc
import grpc.aio

from traverse_client import channels, files, retries
from traverse_client.errors import TraverseError
from traverse_client.file_job import ABANDON_SECONDS, File, FileJob, OnProgress, RewrittenFile
from traverse_client.optimizer import SERVICE, Strategies
from traverse_client.remaining_job import RemainingJob, is_whole, opening
from traverse_client.wire import gcode_service_pb2, options_pb2, plan_pb2
from traverse_client.wire import gcode_service_pb2_grpc, route_optimizer_service_pb2_grpc
from traverse_client.wire import route_optimizer_service_pb2 as api

Layers = Union[Sequence[plan_pb2.Layer], Iterable[plan_pb2.Layer], AsyncIterable[plan_pb2.Layer]]


class _Client:
    """A channel that ends with its `async with`. Make it where the event loop runs."""

    def __init__(self, service: str, addresses: Sequence[str], credentials: Optional[grpc.ChannelCredentials] = None, *,
                 token: Optional[channels.Token] = None, server_name: Optional[str] = None):
        self._channel = channels.channel(grpc.aio.secure_channel, grpc.aio.insecure_channel, service, addresses, credentials,
                                         server_name)
        self._token = token

    async def __aenter__(self):
        return self

    async def __aexit__(self, *_: object) -> None:
        await self.close()

    async def close(self) -> None:
        """Ends the connections; what is under way fails."""
        await self._channel.close()


class AsyncTravelOptimizer(_Client):
    """As TravelOptimizer, for asyncio."""

    def __init__(self, addresses: Sequence[str], credentials: Optional[grpc.ChannelCredentials] = None, *,
                 token: Optional[channels.Token] = None, server_name: Optional[str] = None):
        super().__init__(SERVICE, addresses, credentials, token=token, server_name=server_name)
        self._stub = route_optimizer_service_pb2_grpc.RouteOptimizerServiceStub(self._channel)

    async def optimize(self, layers: Layers, deadline_seconds: float = 30.0, *, strategy: Optional[str] = None,
                       options: Optional[options_pb2.JobOptions] = None) -> AsyncIterator[api.LayerResult]:
        """As TravelOptimizer.optimize; `layers` may be an asynchronous iterable too. Cancelling the task ends the work.

        If the job ends while it waits for a layer, that wait is cancelled in the iterable.
        """
        deadline = time.monotonic() + deadline_seconds
        whole = is_whole(layers)
        job = RemainingJob(options, strategy, layers if whole else ())
        source = None if whole else _Source(layers)
        attempt = 0
        try:
            while True:
                call = self._begin(job, source, deadline - time.monotonic())
                try:
                    async for answer in call:
                        if answer.WhichOneof("result") == "layer":
                            attempt = 0
                            yield job.answered(answer.layer)
                    return
                except (grpc.aio.AioRpcError, asyncio.CancelledError) as error:
                    if source is not None and source.fault is not None:
                        raise source.fault from None
                    if isinstance(error, asyncio.CancelledError):
                        raise
                    delay = retries.delay_before(error, attempt)
                    if error.code() not in retries.RETRIED or time.monotonic() + delay >= deadline:
                        raise TraverseError(error.code(), error.details()) from error
                finally:
                    call.cancel()
                attempt += 1
                await asyncio.sleep(delay)
        finally:
            if source is not None:
                source.close()

    def _begin(self, job, source, timeout):
        metadata = channels.authorization(self._token)
        if source is None:
            return self._stub.OptimizeBatch(job.batch(), timeout=timeout, wait_for_ready=True, metadata=metadata)
        return self._stub.Optimize(source.requests(job), timeout=timeout, wait_for_ready=True, metadata=metadata)

    async def strategies(self, timeout_seconds: float = 10.0) -> Strategies:
        """As TravelOptimizer.strategies."""
        try:
            answer = await self._stub.ListStrategies(api.ListStrategiesRequest(), timeout=timeout_seconds,
                                                     wait_for_ready=True, metadata=channels.authorization(self._token))
        except grpc.aio.AioRpcError as error:
            raise TraverseError(error.code(), error.details()) from error
        return Strategies(answer)


class _Source:
    """A caller's layers, from one attempt to the next: a layer that is being fetched when one ends is not lost."""

    def __init__(self, layers: Layers):
        self._layers = layers.__aiter__() if hasattr(layers, "__aiter__") else _as_async(layers)
        self._fetching: Optional["asyncio.Task[Optional[plan_pb2.Layer]]"] = None
        self._attempt = 0
        self._ended = False
        self.fault: Optional[BaseException] = None

    def close(self) -> None:
        """The job is over: no further layer is taken."""
        self._attempt += 1
        if self._fetching is not None:
            self._fetching.cancel()

    def requests(self, job: RemainingJob) -> AsyncIterator[api.OptimizeRequest]:
        """The messages of a new attempt. Those of the one before, which may wait for the same layer, end."""
        self._attempt += 1
        return self._requests(job, self._attempt)

    async def _requests(self, job: RemainingJob, attempt: int) -> AsyncIterator[api.OptimizeRequest]:
        for request in opening(job):
            yield request
        while attempt == self._attempt and not self._ended:
            if self._fetching is None:
                self._fetching = asyncio.ensure_future(self._next())
            try:
                layer = await asyncio.shield(self._fetching)
            except asyncio.CancelledError:
                raise  # the attempt is over; the next one waits for the same layer
            except BaseException as fault:
                self.fault = fault
                raise
            if attempt != self._attempt:
                return
            self._fetching = None
            if layer is None:
                self._ended = True
                return
            job.sent(layer)
            yield api.OptimizeRequest(layers=[layer])

    async def _next(self) -> Optional[plan_pb2.Layer]:
        try:
            return await self._layers.__anext__()
        except StopAsyncIteration:
            return None


async def _as_async(layers: Iterable[plan_pb2.Layer]) -> AsyncIterator[plan_pb2.Layer]:
    for layer in layers:
        yield layer


class AsyncGcodeGateway:
    """As GcodeGateway, for asyncio. Make it where the event loop runs."""

    def __init__(self, addresses: Sequence[str], credentials: Optional[grpc.ChannelCredentials] = None, *,
                 token: Optional[channels.Token] = None, server_name: Optional[str] = None):
        self._channels = channels.channels_one_by_one(grpc.aio.secure_channel, grpc.aio.insecure_channel, files.SERVICE,
                                                      addresses, credentials, server_name)
        self._stubs = [gcode_service_pb2_grpc.GcodeServiceStub(channel) for channel in self._channels]
        self._token = token

    async def __aenter__(self) -> "AsyncGcodeGateway":
        return self

    async def __aexit__(self, *_: object) -> None:
        await self.close()

    async def close(self) -> None:
        """Ends the connections; what is under way fails."""
        for channel in self._channels:
            await channel.close()

    async def rewrite(self, file: File, deadline_seconds: float = 600.0, *,
                      options: Optional[gcode_service_pb2.RewriteOptions] = None, on_progress: Optional[OnProgress] = None,
                      idempotency_key: Optional[str] = None) -> RewrittenFile:
        """As GcodeGateway.rewrite."""
        job = FileJob(file, options, idempotency_key, on_progress, deadline_seconds, len(self._stubs))
        try:
            while True:
                call = job.next_call()
                if call is None:
                    return job.file()
                try:
                    await self._make(job, *call)
                except grpc.RpcError as error:
                    await asyncio.sleep(job.delay_after(error, call[1]))
        except BaseException:
            left = job.abandoned()
            if left is not None:
                try:
                    await self._stubs[job.gateway].CancelJob(left, timeout=ABANDON_SECONDS,
                                                             metadata=channels.authorization(self._token))
                except grpc.RpcError:
                    pass  # it expires
            raise

    async def _make(self, job: FileJob, method: str, request: Any) -> None:
        timeout, waits = job.call_settings(method)
        answer = getattr(self._stubs[job.gateway], method)(
            request, timeout=timeout, wait_for_ready=waits, metadata=channels.authorization(self._token))
        if method in ("CreateJob", "CancelJob"):
            job.take(await answer, request)
            return
        try:
            async for one in answer:
                job.take(one, request)
        finally:
            answer.cancel()
        job.ended(request)

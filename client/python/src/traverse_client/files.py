"""Sliced files in, the same prints with less travel out."""

import time
from typing import Any, Optional, Sequence

import grpc

from traverse_client import channels
from traverse_client.file_job import ABANDON_SECONDS, File, FileJob, OnProgress, RewrittenFile
from traverse_client.wire import gcode_service_pb2 as api
from traverse_client.wire import gcode_service_pb2_grpc as service

SERVICE = "traverse.v1.GcodeService"


class GcodeGateway:
    """Connections to one or several gateways. Thread-safe; the arguments are those of TravelOptimizer."""

    def __init__(self, addresses: Sequence[str], credentials: Optional[grpc.ChannelCredentials] = None, *,
                 token: Optional[channels.Token] = None, server_name: Optional[str] = None):
        self._channels = channels.channels_one_by_one(grpc.secure_channel, grpc.insecure_channel, SERVICE, addresses,
                                                      credentials, server_name)
        self._stubs = [service.GcodeServiceStub(channel) for channel in self._channels]
        self._token = token

    def __enter__(self) -> "GcodeGateway":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Ends the connections; files under way fail."""
        for channel in self._channels:
            channel.close()

    def rewrite(self, file: File, deadline_seconds: float = 600.0, *, options: Optional[api.RewriteOptions] = None,
                on_progress: Optional[OnProgress] = None, idempotency_key: Optional[str] = None) -> RewrittenFile:
        """Returns the same print with less travel.

        file: a path, bytes, or an open binary file; G-code, plain, compressed or in a container.
        deadline_seconds: for all of it; the gateway answers before it with the best it has.
        on_progress: called from time to time with how far the work has come.
        idempotency_key: as of CreateJobOptions; None: one of its own.

        The file is a job of the gateway: a call that is lost goes on where it was, the download too. A gateway that has
        gone, or has forgotten the job, gets the file again.
        Raises TraverseError: FAILED_PRECONDITION if the file cannot be rewritten so that it prints the same, with the
        reason; OSError if the file cannot be read.
        """
        job = FileJob(file, options, idempotency_key, on_progress, deadline_seconds, len(self._stubs))
        try:
            while True:
                call = job.next_call()
                if call is None:
                    return job.file()
                try:
                    self._make(job, *call)
                except grpc.RpcError as error:
                    time.sleep(job.delay_after(error, call[1]))
        except BaseException:
            left = job.abandoned()
            if left is not None:
                try:
                    self._stubs[job.gateway].CancelJob(left, timeout=ABANDON_SECONDS,
                                                       metadata=channels.authorization(self._token))
                except grpc.RpcError:
                    pass  # it expires
            raise

    def _make(self, job: FileJob, method: str, request: Any) -> None:
        timeout, waits = job.call_settings(method)
        answer = getattr(self._stubs[job.gateway], method)(
            request, timeout=timeout, wait_for_ready=waits, metadata=channels.authorization(self._token))
        if method in ("CreateJob", "CancelJob"):
            job.take(answer, request)
            return
        try:
            for one in answer:
                job.take(one, request)
        finally:
            answer.cancel()  # nothing if it has ended
        job.ended(request)

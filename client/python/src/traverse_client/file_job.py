"""A file as a job of a gateway, whatever call is under way: the part that sync and asyncio share."""

import dataclasses
import os
import time
import uuid
from typing import Any, BinaryIO, Callable, Iterator, Optional, Tuple, Union

import grpc

from traverse_client import retries
from traverse_client.errors import TraverseError
from traverse_client.wire import gcode_service_pb2 as api

PIECE_BYTES = 1 << 20
CANCEL_SECONDS = 10.0
ABANDON_SECONDS = 1.0  # to cancel a job whose deadline may be over: its caller waits for it

File = Union[str, "os.PathLike[str]", bytes, BinaryIO]
OnProgress = Callable[[api.RewriteProgress], None]

# With other gateways to ask, a job is given up after so many calls to its own one that were lost.
TRIES_OF_ONE = 4

# The gateway has no such job any more, or another gateway answers now.
LOST = (grpc.StatusCode.ABORTED, grpc.StatusCode.FAILED_PRECONDITION, grpc.StatusCode.NOT_FOUND)
CODES = {code.value[0]: code for code in grpc.StatusCode}


@dataclasses.dataclass
class RewrittenFile:
    """What the gateway made of a file.

    data: the new file, in the format of the old one unless the options ask for another.
    summary: what was saved, and why the rest stays; `summary.layers_changed` is 0 if nothing was gained.
    report: a page of HTML, empty unless the options ask for one.
    """

    data: bytes
    summary: api.RewriteSummary
    report: bytes


class PassingFault(grpc.RpcError):
    """A job that failed as a call fails that may be tried again."""

    def __init__(self, fault: api.JobFault):
        super().__init__(fault.message)
        self._fault = fault

    def code(self) -> grpc.StatusCode:
        return CODES[self._fault.code]

    def details(self) -> str:
        return self._fault.message

    def trailing_metadata(self) -> None:
        """A job has none."""


class FileJob:
    """Says which call comes next, and takes its answers. The file is read whole, because it may have to be sent again."""

    def __init__(self, file: File, options: Optional[api.RewriteOptions], key: Optional[str],
                 on_progress: Optional[OnProgress], deadline_seconds: float, gateways: int):
        self._options = api.RewriteOptions()
        if options is not None:
            self._options.CopyFrom(options)
        if isinstance(file, bytes):
            self._file = file
        elif isinstance(file, (str, os.PathLike)):
            with open(file, "rb") as opened:
                self._file = opened.read()
            self._options.name = self._options.name or os.path.basename(file)
        else:
            self._file = file.read()
        self._key = key or uuid.uuid4().hex
        self._on_progress = on_progress
        self._deadline = time.monotonic() + deadline_seconds
        self._gateways = gateways
        self.gateway = 0  # the number of the one to ask
        self._attempt = 0
        self._begin_anew()

    def _begin_anew(self) -> None:
        self._job: Optional[api.Job] = None
        self._data, self._report = bytearray(), bytearray()
        self._report_read = not self._options.report
        self._deleted = False

    def seconds_left(self) -> float:
        """Until the deadline."""
        return self._deadline - time.monotonic()

    def next_call(self) -> Optional[Tuple[str, Any]]:
        """The method and its request (of CreateJob the iterator of them); None if the file is here.

        Raises TraverseError if the job has failed.
        """
        job = self._job
        if job is None:
            return "CreateJob", self._upload()
        if job.state == api.Job.STATE_FAILED:
            raise TraverseError(CODES[job.fault.code], job.fault.message)
        if job.state != api.Job.STATE_DONE:
            return "WatchJob", api.WatchJobRequest(id=job.id, known_revision=job.revision)
        if len(self._data) < job.summary.bytes:
            return "ReadJob", api.ReadJobRequest(id=job.id, offset=len(self._data))
        if not self._report_read:
            return "ReadJob", api.ReadJobRequest(id=job.id, report=True, offset=len(self._report))
        return None if self._deleted else ("CancelJob", api.CancelJobRequest(id=job.id))

    def call_settings(self, method: str) -> Tuple[float, bool]:
        """How many seconds a call may take, and whether it waits for a gateway that is not there."""
        left = max(0.0, self.seconds_left())
        if method == "CancelJob":  # the file is here: nobody waits for this
            return min(left, CANCEL_SECONDS), False
        return left, self._gateways == 1

    def _upload(self) -> Iterator[api.CreateJobRequest]:
        left = self.seconds_left()
        options = api.CreateJobOptions(rewrite=self._options, idempotency_key=self._key)
        options.deadline.FromNanoseconds(max(1, int((left - min(5.0, left / 10)) * 1e9)))  # to have time for the way back
        yield api.CreateJobRequest(options=options)
        for begin in range(0, len(self._file), PIECE_BYTES):
            yield api.CreateJobRequest(data=self._file[begin:begin + PIECE_BYTES])

    def take(self, answer: Any, request: Any) -> None:
        """Takes one answer to `request`. Raises PassingFault if the job failed and may be tried again."""
        if isinstance(answer, api.ReadJobResponse):
            (self._report if request.report else self._data).extend(answer.data)
            self._attempt = 0
        elif isinstance(answer, api.CancelJobResponse):
            self._deleted = True
        else:
            if self._job is not None and answer.job.revision > self._job.revision:
                self._attempt = 0
            self._job = answer.job
            if self._on_progress is not None:
                self._on_progress(answer.job.progress)
            if self._job.state == api.Job.STATE_FAILED and CODES[self._job.fault.code] in retries.RETRIED:
                self._job = None  # for the same key the gateway begins anew
                raise PassingFault(answer.job.fault)

    def ended(self, request: Any) -> None:
        """All answers to `request` came."""
        if isinstance(request, api.ReadJobRequest) and request.report:
            self._report_read = True

    def delay_after(self, error: grpc.RpcError, request: Any) -> float:
        """Seconds to wait before next_call. Raises TraverseError where no other call helps."""
        fault = TraverseError(error.code(), error.details())
        if isinstance(request, api.CancelJobRequest):
            self._deleted = True  # or will be, when it expires
            return 0
        if self._job is not None and error.code() in LOST:
            self._begin_anew()
        elif error.code() not in retries.RETRIED:
            raise fault from error
        elif self._job is None or (self._attempt >= TRIES_OF_ONE and self._gateways > 1):
            self._begin_anew()
            self.gateway = (self.gateway + 1) % self._gateways
        delay = retries.delay_before(error, self._attempt)
        if delay >= self.seconds_left():
            raise fault from error
        self._attempt += 1
        return delay

    def abandoned(self) -> Optional[api.CancelJobRequest]:
        """What to send if nobody waits for the file any more."""
        return None if self._job is None or self._deleted else api.CancelJobRequest(id=self._job.id)

    def file(self) -> RewrittenFile:
        """The result. REQUIRES: next_call() is None."""
        assert self._job is not None
        return RewrittenFile(bytes(self._data), self._job.summary, bytes(self._report))

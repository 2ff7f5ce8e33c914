"""Sliced files in, the same prints with less travel out."""

import dataclasses
import os
import time
from typing import BinaryIO, Callable, Iterator, Optional, Sequence, Union

import grpc

from traverse_client import channels, retries
from traverse_client.errors import TraverseError
from traverse_client.wire import gcode_service_pb2 as api
from traverse_client.wire import gcode_service_pb2_grpc as service

SERVICE = "traverse.v1.GcodeService"
PIECE_BYTES = 1 << 20

File = Union[str, "os.PathLike[str]", bytes, BinaryIO]
OnProgress = Callable[[api.RewriteProgress], None]


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


class Upload:
    """The bytes of a file, and what a call sends of them; read whole, because a second attempt sends them again."""

    def __init__(self, file: File, options: Optional[api.RewriteOptions]):
        self._options = api.RewriteOptions()
        if options is not None:
            self._options.CopyFrom(options)
        if isinstance(file, bytes):
            self._data = file
        elif isinstance(file, (str, os.PathLike)):
            with open(file, "rb") as opened:
                self._data = opened.read()
            self._options.name = self._options.name or os.path.basename(file)
        else:
            self._data = file.read()

    def requests(self) -> Iterator[api.RewriteRequest]:
        yield api.RewriteRequest(options=self._options)
        for begin in range(0, max(1, len(self._data)), PIECE_BYTES):
            yield api.RewriteRequest(data=self._data[begin:begin + PIECE_BYTES])


class Download:
    """Collects the answers of one attempt."""

    def __init__(self, on_progress: Optional[OnProgress]):
        self._on_progress = on_progress
        self._data, self._report = [], []
        self._summary: Optional[api.RewriteSummary] = None

    def take(self, answer: api.RewriteResponse) -> None:
        part = answer.WhichOneof("part")
        if part == "progress" and self._on_progress is not None:
            self._on_progress(answer.progress)
        elif part == "data":
            self._data.append(answer.data)
        elif part == "report":
            self._report.append(answer.report)
        elif part == "summary":
            self._summary = answer.summary

    def file(self) -> RewrittenFile:
        """The whole file; raises TraverseError if the answers ended before it was whole."""
        if self._summary is None:
            raise TraverseError(grpc.StatusCode.DATA_LOSS, "the answer ended before the file was whole")
        return RewrittenFile(b"".join(self._data), self._summary, b"".join(self._report))


class GcodeGateway:
    """Connections to one or several gateways. Thread-safe; the arguments are those of TravelOptimizer."""

    def __init__(self, addresses: Sequence[str], credentials: Optional[grpc.ChannelCredentials] = None, *,
                 token: Optional[channels.Token] = None, server_name: Optional[str] = None):
        self._channel = channels.channel(grpc.secure_channel, grpc.insecure_channel, SERVICE, addresses, credentials,
                                         server_name)
        self._stub = service.GcodeServiceStub(self._channel)
        self._token = token

    def __enter__(self) -> "GcodeGateway":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Ends the connections; files under way fail."""
        self._channel.close()

    def rewrite(self, file: File, deadline_seconds: float = 600.0, *, options: Optional[api.RewriteOptions] = None,
                on_progress: Optional[OnProgress] = None) -> RewrittenFile:
        """Returns the same print with less travel.

        file: a path, bytes, or an open binary file; G-code, plain, compressed or in a container.
        deadline_seconds: for all attempts; the gateway answers before it with the best it has.
        on_progress: called from time to time with how far the work has come.
        Raises TraverseError: FAILED_PRECONDITION if the file cannot be rewritten so that it prints the same, with the
        reason; OSError if the file cannot be read.
        """
        upload = Upload(file, options)
        deadline = time.monotonic() + deadline_seconds
        attempt = 0
        while True:
            download = Download(on_progress)
            call = self._stub.Rewrite(upload.requests(), timeout=deadline - time.monotonic(), wait_for_ready=True,
                                      metadata=channels.authorization(self._token))
            try:
                for answer in call:
                    download.take(answer)
                return download.file()
            except grpc.RpcError as error:
                delay = retries.delay_before(error, attempt)
                if error.code() not in retries.RETRIED or time.monotonic() + delay >= deadline:
                    raise TraverseError(error.code(), error.details()) from error
            finally:
                call.cancel()
            attempt += 1
            time.sleep(delay)

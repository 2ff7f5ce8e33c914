"""What is left of a job, whatever attempt is under way: the part that sync and asyncio share."""

import collections
import itertools
from typing import Deque, Iterable, Iterator, Optional, Sequence, Union

from traverse_client.wire import options_pb2, plan_pb2
from traverse_client.wire import route_optimizer_service_pb2 as api

Options = Optional[options_pb2.JobOptions]


class RemainingJob:
    """Layers sent and not answered, and how the next attempt starts. `options` are copied."""

    def __init__(self, options: Options, strategy: Optional[str], layers: Sequence[plan_pb2.Layer] = ()):
        self._options = options_pb2.JobOptions()
        if options is not None:
            self._options.CopyFrom(options)
        if strategy is not None:
            self._options.strategy.name = strategy
        self._options.result_order = options_pb2.RESULT_ORDER_BUILD  # so that what came is a prefix
        self._unanswered: Deque[plan_pb2.Layer] = collections.deque(layers)
        self._answered = 0  # in all attempts
        self._answered_before = 0  # in those before the one under way
        self._last: Optional[api.LayerResult] = None

    def sent(self, layer: plan_pb2.Layer) -> None:
        """Another layer of a stream goes out."""
        self._unanswered.append(layer)

    def answered(self, result: api.LayerResult) -> api.LayerResult:
        """Takes a result of the attempt under way and gives it its position in the whole job."""
        self._unanswered.popleft()
        result.index += self._answered_before
        self._answered += 1
        self._last = result
        return result

    def begin_attempt(self) -> options_pb2.JobOptions:
        """The options of the next attempt, which begins where the last answered layer ended."""
        count = self._answered - self._answered_before
        self._answered_before = self._answered
        if count and self._last is not None:
            start = self._last.end
            if self._options.HasField("cleaning"):
                cleaning = self._options.cleaning
                since = (cleaning.layers_since_cleaning + count) % cleaning.every_layers
                cleaning.layers_since_cleaning = since
                start = cleaning.point if since == 0 else start
            self._options.start.CopyFrom(start)
        return self._options

    def unanswered(self) -> Iterable[plan_pb2.Layer]:
        """The layers to send again, as they are now."""
        return tuple(self._unanswered)

    def batch(self) -> api.OptimizeBatchRequest:
        """All that is left, in one message."""
        return api.OptimizeBatchRequest(options=self.begin_attempt(), layers=self.unanswered())


def opening(job: RemainingJob) -> Iterator[api.OptimizeRequest]:
    """Begins a streamed attempt and returns its first messages: the options, then the layers that lack an answer."""
    first = api.OptimizeRequest(options=job.begin_attempt())
    return itertools.chain([first], (api.OptimizeRequest(layers=[layer]) for layer in job.unanswered()))


def is_whole(layers: Union[Sequence[plan_pb2.Layer], Iterable[plan_pb2.Layer]]) -> bool:
    """True if all layers are there: one message then tells the server all of the job."""
    return isinstance(layers, (list, tuple))

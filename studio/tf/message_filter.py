"""MessageFilter: messages that came before their transforms wait for them, not for ever."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING, Generic, TypeVar

from studio.errors import ExtrapolationError, FrameError

if TYPE_CHECKING:
    from studio.tf.buffer import FramePose, TransformBuffer

_T = TypeVar("_T")


@dataclass(frozen=True, slots=True)
class Settled(Generic[_T]):
    """A message with its place, or with what is in the way of it.

    Attributes:
        item: What was added.
        pose: Of its frame in the fixed frame at its stamp.
        error: Why there is none.
    """

    item: _T
    pose: FramePose | None
    error: FrameError | None


@dataclass(slots=True)
class _Waiting(Generic[_T]):
    item: _T
    frame: str
    stamp_ns: int
    until_ns: int


class MessageFilter(Generic[_T]):
    """A bounded queue that is polled; one thread.

    Args:
        buffer: Where transforms come.
        wait_ns: How long a message waits at most.
        depth: How many wait at most: the oldest goes when one more comes.
    """

    def __init__(
        self, buffer: TransformBuffer, wait_ns: int = 1_000_000_000, depth: int = 10
    ) -> None:
        self._buffer, self._wait_ns = buffer, wait_ns
        self._depth = max(1, depth)
        self._queue: deque[_Waiting[_T]] = deque()
        self._seen: tuple[int, str] | None = None
        self._pushed_out: list[_Waiting[_T]] = []

    def __len__(self) -> int:
        return len(self._queue)

    def add(self, item: _T, frame: str, stamp_ns: int, now_ns: int) -> None:
        """Let a message wait for its transform, which may be there already.

        Args:
            item: Anything.
            frame: Where it is.
            stamp_ns: When it was there; 0 is the newest time.
            now_ns: By any clock, the same as for `poll`.
        """
        self._queue.append(_Waiting(item, frame, stamp_ns, now_ns + self._wait_ns))
        self._seen = None
        if len(self._queue) > self._depth:
            self._pushed_out.append(self._queue.popleft())

    def poll(self, fixed: str, now_ns: int) -> list[Settled[_T]]:
        """Take out, in their order, all that have a place now, and all that waited in vain."""
        seen = self._buffer.changes, fixed
        nothing_new = seen == self._seen
        last_chance, self._pushed_out = self._pushed_out, []
        settled = [self._look(one, fixed) for one in last_chance]
        kept: deque[_Waiting[_T]] = deque()
        for one in self._queue:
            is_over = now_ns >= one.until_ns
            if nothing_new and not is_over:
                kept.append(one)
                continue
            answer = self._look(one, fixed)
            if answer.pose is not None or is_over or _is_hopeless(answer.error):
                settled.append(answer)
            else:
                kept.append(one)
        self._queue, self._seen = kept, seen
        return settled

    def clear(self) -> None:
        """Forget all that wait: time jumped, or nobody wants them any more."""
        self._queue.clear()
        self._pushed_out.clear()

    def _look(self, one: _Waiting[_T], fixed: str) -> Settled[_T]:
        try:
            pose = self._buffer.fixed_from(fixed, one.frame, one.stamp_ns)
        except FrameError as error:
            return Settled(one.item, None, error)
        return Settled(one.item, pose, None)


def _is_hopeless(error: FrameError | None) -> bool:
    """Whether waiting cannot help: what is older than the buffer does not come again."""
    return isinstance(error, ExtrapolationError) and not error.may_come

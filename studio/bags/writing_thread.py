"""WritingThread: writes a bag in a thread of its own, so that whoever receives never waits."""

from __future__ import annotations

import logging
import threading
import time
from collections import deque
from typing import TYPE_CHECKING, Final, TypeAlias

from studio.errors import BagError

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from studio.bags.recording import RecordedTopic
    from studio.bags.writer import BagWriter, Written
    from studio.ros.node.samples import RawSample

WAITING_BYTES_MAX: Final = 256 * 1024 * 1024
_PAUSE_S: Final = 0.02
"""Between two looks at what waits, while something comes: fewer and larger steps cost less."""
_TEND_S: Final = 0.5

_Item: TypeAlias = "tuple[TopicInput, Sequence[RawSample]] | Callable[[], object]"

_log = logging.getLogger(__name__)


class TopicInput:
    """A topic on its way into a bag.

    Attributes:
        topic: As it is announced in the bag.
        count: Messages that were taken, without those that were lost later.
        bytes: Of their payloads.
        lost: Messages that came and were not written: too many waited, or the bag has ended.
    """

    def __init__(self, topic: RecordedTopic) -> None:
        self.topic = topic
        self.count = self.bytes = self.lost = 0
        self.number = 0
        """In the bag; of the writing thread."""


class WritingThread:
    """Takes messages from any thread, and writes them in their order until `close`.

    Args:
        writer: Is this thread's from now on, and closed by it.
        most_bytes: May wait; what comes beyond is dropped, and counted.
        ended: Called in this thread where the bag cannot be written any further.
    """

    def __init__(
        self, writer: BagWriter, most_bytes: int, ended: Callable[[], object] | None = None
    ) -> None:
        self._writer, self._most_bytes, self._ended = writer, most_bytes, ended
        self._waiting: deque[_Item] = deque()
        self._waiting_bytes = 0
        self._lock = threading.Lock()
        self._is_due = threading.Event()
        self._is_closing = False
        self._topics: list[TopicInput] = []
        """Those that the bag has."""
        self.trouble = ""
        """Why the bag ended by itself, in a sentence; else empty."""
        self.size = writer.size
        """Bytes of the bag."""
        self._thread = threading.Thread(target=self._run, name="bag writing", daemon=True)
        self._thread.start()

    def post(self, topic: TopicInput, samples: Sequence[RawSample], size: int) -> None:
        """Let samples be written; of `size` bytes in all."""
        with self._lock:
            if self.trouble or self._is_closing or self._waiting_bytes + size > self._most_bytes:
                topic.lost += len(samples)
                return
            self._waiting_bytes += size
            topic.count += len(samples)
            topic.bytes += size
            self._waiting.append((topic, samples))
        self._is_due.set()

    def announce(self, topic: TopicInput) -> None:
        """Let the bag have a topic, also if no message of it comes."""
        self._do(lambda: self._number(topic))

    def split(self) -> None:
        """Let another file begin behind what was posted until now."""
        self._do(self._writer.split)

    def close(self) -> Written:
        """Write all that waits, and complete the bag; `trouble` says whether that succeeded."""
        with self._lock:  # what is being posted is written, or counted as lost
            self._is_closing = True
        self._is_due.set()
        self._thread.join()
        return self._writer.close()

    def _do(self, step: Callable[[], object]) -> None:
        with self._lock:
            self._waiting.append(step)
        self._is_due.set()

    def _run(self) -> None:
        try:
            while not self._is_closing:
                if self._is_due.wait(_TEND_S):
                    self._is_due.clear()
                    self._write_waiting()
                    time.sleep(_PAUSE_S)
                self._writer.tend()
                self.size = self._writer.size
            self._write_waiting()
            self.size = self._writer.close().bytes
        except BagError as error:
            self._end(str(error))
        except Exception:  # noqa: BLE001 - whoever records is to hear of it, whatever it is
            _log.exception("A bag could not be written any further.")
            self._end("The bag could not be written any further: the terminal says why.")

    def _write_waiting(self) -> None:
        writer = self._writer
        while self._waiting:
            item = self._waiting.popleft()
            if callable(item):
                item()
                continue
            topic, samples = item
            number = self._number(topic)
            for sample in samples:
                writer.write(number, sample)
            size = sum(len(sample.payload) for sample in samples)
            with self._lock:
                self._waiting_bytes -= size

    def _number(self, topic: TopicInput) -> int:
        if not topic.number:
            topic.number = self._writer.add_topic(topic.topic)
            self._topics.append(topic)
        return topic.number

    def _end(self, trouble: str) -> None:
        """Count what was taken and is not in the bag."""
        with self._lock:
            self.trouble = trouble
            waiting, self._waiting = self._waiting, deque()
            topics = {*self._topics, *(item[0] for item in waiting if not callable(item))}
            for topic in topics:
                written = self._writer.taken(topic.number) if topic.number else 0
                topic.lost += topic.count - written
                topic.count = written
        if self._ended is not None:
            self._ended()

"""StorageFile: one file of a bag while it is written, whatever its storage."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from studio.bags.metadata_text import Span
    from studio.bags.recording import RecordedTopic
    from studio.ros.node.samples import RawSample


class StorageFile(Protocol):
    """A file that takes messages of topics, which are known by numbers from 1.

    Its methods raise an OSError where the disk refuses; what was whole before stays whole, and
    `close` may be called after it.
    """

    @property
    def span(self) -> Span:
        """What is in it."""
        ...

    @property
    def size(self) -> int:
        """Bytes, those that wait to be written among them."""
        ...

    @property
    def counts(self) -> Mapping[int, int]:
        """How many messages of each topic are in it."""
        ...

    def add_topic(self, number: int, topic: RecordedTopic, definition: str) -> None:
        """Announce a topic; the text of its type is empty where that is not known."""
        ...

    def write(self, number: int, sample: RawSample) -> None:
        """Add a message."""
        ...

    def flush(self) -> None:
        """Write what waits, so that it is there whatever happens to this process."""
        ...

    def close(self, information: Callable[[], str]) -> None:
        """Complete the file; on a full disk with fewer messages than it had.

        Args:
            information: Gives the text of the bag, for what is in the file when it is called.
        """
        ...

    def abandon(self) -> None:
        """Let go of the file as it is."""
        ...

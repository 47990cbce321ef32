"""TopicSource: what panels and displays need of wherever topics come from."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Protocol

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from studio.live.topics.request import Endpoint, Request
    from studio.live.topics.subscription import Subscription
    from studio.ros.node.samples import RawSample
    from studio.ros.types.library import TypeLibrary


class Topic(NamedTuple):
    """A row of a source's catalogue; `types` are all that either end uses."""

    name: str
    types: tuple[str, ...]
    publishers: tuple[Endpoint, ...]
    subscribers: tuple[Endpoint, ...]


class TopicSource(Protocol):
    """Topics, whether of a ROS 2 system that runs, of a recording, or of another studio.

    Any thread may ask.
    """

    @property
    def epoch(self) -> int:
        """Another number once what came before does not go with what comes now.

        Whoever keeps transforms, trails or plots clears them: another system was connected, or a
        recording jumped.
        """
        ...

    @property
    def types(self) -> TypeLibrary:
        """Message types as this source defines them."""
        ...

    def catalogue(self) -> list[Topic]:
        """Give all topics by name."""
        ...

    def publishers(self, topic: str) -> Sequence[Endpoint]:
        """Give who publishes a topic; nobody where it cannot be a topic's name."""
        ...

    def sender(self, gid: bytes) -> str | None:
        """Give the full name of the node that sent samples with a GID; None: it is not known."""
        ...

    def subscribe(
        self,
        request: Request,
        *,
        take: Callable[[RawSample], object] | None = None,
        arrived: Callable[[], object] | None = None,
        changed: Callable[[], object] | None = None,
    ) -> Subscription:
        """Subscribe, now or as soon as somebody is connected; it never waits.

        Args:
            request: What is wanted.
            take: Called with each sample, in a thread of the source; without it samples wait in
                the subscription.
            arrived: Called when samples wait, in a thread of the source: it must be quick.
            changed: Called when the subscription's state is another, as `arrived` is.
        """
        ...

    def latest(self, topics: Iterable[str], at_ns: int) -> dict[str, RawSample]:
        """Give the newest sample of each topic at or before a time, of those that are kept.

        Args:
            topics: Full names.
            at_ns: Of reception, since the Unix epoch.
        """
        ...

    def window(self, topic: str, begin_ns: int, end_ns: int) -> list[RawSample]:
        """Give the samples of a topic from a time on and before another, of those that are kept."""
        ...

"""TopicSource: what panels and displays need of wherever topics come from."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple, Protocol, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from studio.live.topics.request import Endpoint, Request
    from studio.live.topics.subscription import Subscription
    from studio.ros.node.samples import RawSample
    from studio.ros.node.topic_statistics import Flow
    from studio.ros.types.classes import MessageValue
    from studio.ros.types.library import TypeLibrary

Connection: TypeAlias = Literal["none", "lost", "there"]
"""`lost`: there is one, and its router is gone."""


class Topic(NamedTuple):
    """A row of a source's catalogue; `types` are all that either end uses."""

    name: str
    types: tuple[str, ...]
    publishers: tuple[Endpoint, ...]
    subscribers: tuple[Endpoint, ...]


class TopicSource(Protocol):
    """Topics, whether of a ROS 2 system that runs, of a recording, or of another studio.

    Thread-safe.
    """

    @property
    def epoch(self) -> int:
        """Another number once earlier messages do not belong to those that follow.

        Users clear transforms, trails and plots: another system was connected, or a recording
        jumped.
        """
        ...

    @property
    def connection(self) -> Connection:
        """Whether anything can come."""
        ...

    @property
    def is_live(self) -> bool:
        """Whether it is of what runs now, and not a recording."""
        ...

    @property
    def now_ns(self) -> int:
        """The time of the messages that come now, since the Unix epoch.

        Of what runs that is this machine's, of a recording where it stands.
        """
        ...

    @property
    def types(self) -> TypeLibrary:
        """Message types as this source defines them."""
        ...

    @property
    def later_tf(self) -> Sequence[RawSample]:
        """The messages of /tf that come next, where the time stands still; else none."""
        ...

    def catalogue(self) -> list[Topic]:
        """Return all topics by name."""
        ...

    def publishers(self, topic: str) -> Sequence[Endpoint]:
        """Return the publishers of a topic; none if the name is not valid."""
        ...

    def sender(self, gid: bytes) -> str | None:
        """Return the full name of the node that sent samples with a GID; None: it is not known."""
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

    def fit_all(self) -> None:
        """Subscribe now what was asked for; in a thread, for it may wait."""
        ...

    def flows(self, topics: Iterable[str]) -> dict[str, Flow]:
        """Return rates, sizes and ages of the messages of some topics.

        They are measured from the first request on, whatever their types, and for some seconds
        after the last. Topics that nobody publishes are left out.
        """
        ...

    def latest(self, topics: Iterable[str], at_ns: int) -> dict[str, RawSample]:
        """Return the newest sample of each topic at or before a time, of those that are kept.

        Args:
            topics: Full names.
            at_ns: Of reception, since the Unix epoch.
        """
        ...

    def window(self, topic: str, begin_ns: int, end_ns: int) -> list[RawSample]:
        """Return the kept samples of a topic in [begin_ns, end_ns)."""
        ...


def decoder(source: TopicSource, type_name: str) -> Callable[[RawSample], MessageValue]:
    """Return what decodes samples of a type, as the source defines it.

    What it returns raises a CdrError for bytes that are no such message, and an UnknownTypeError.
    """
    decode: Callable[[bytes], MessageValue] | None = None
    epoch = source.epoch

    def decode_sample(sample: RawSample) -> MessageValue:
        nonlocal decode, epoch
        if decode is None or epoch != source.epoch:  # another system may define it otherwise
            from studio.ros.cdr import codec_of  # noqa: PLC0415 - takes its time

            epoch = source.epoch
            decode = codec_of(source.types.message(type_name)).decode
        return decode(sample.payload)

    return decode_sample

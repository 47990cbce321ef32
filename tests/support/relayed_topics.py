"""Topics of a studio and of a relay, with a line between them that tests fill, hold and cut."""

from __future__ import annotations

from collections import deque
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING

from studio.live.topics.browsers import BrowserTopics
from studio.protocol.subscriptions import Subscribe, Unsubscribe
from studio.server.relays.messages import (
    AskTopic,
    TopicState,
    TopicTick,
    decode_down,
    decode_up,
    encode,
)
from studio.server.relays.origin_topics import TopicsOfRelay, allowed_topics
from studio.server.relays.relayed_topics import RelayedTopics
from tests.support.hearers import KeepingHearer
from tests.support.topic_worlds import text_of

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator, Callable

    from studio.live.topics.browsers import DataLaneEnd
    from studio.live.topics.source import TopicSource
    from studio.protocol.roles import Person
    from studio.protocol.subscriptions import SubscriptionCommand
    from studio.server.relays.messages import Down
    from studio.server.surface import SubscribesTopics
_ALL = allowed_topics(())


class Line:
    """Both ends; what is said goes over at once, as bytes, unless it is held.

    Attributes:
        pending: Bytes that the other end did not confirm.
        persons: Persons by their tickets.
        tickets: Tickets by data lane.
        asked: What the relay asked for.
        told: What the origin said.
    """

    def __init__(self, topics: SubscribesTopics, allows: Callable[[str], bool] = _ALL) -> None:
        self._topics, self._allows = topics, allows
        self.pending = 0
        self.is_held = False
        self.persons: dict[str, Person] = {}
        self.tickets: dict[DataLaneEnd, str] = {}
        self.asked: list[SubscriptionCommand] = []
        self.told: list[Down] = []
        self._up: deque[bytes] = deque()
        self._down: deque[bytes] = deque()
        self._is_flowing = False
        self.relayed = RelayedTopics(self._ask, lambda lane: self.tickets.get(lane, ""))
        self._origin: TopicsOfRelay | None = None
        self.connect()

    @property
    def origin(self) -> TopicsOfRelay:
        assert self._origin is not None
        return self._origin

    def connect(self) -> None:
        """Begin with another end at the origin."""
        self._origin = TopicsOfRelay(self._topics, self._tell, self, self._allows)
        self.relayed.renew()

    def cut(self) -> None:
        """Lose the line, and what is on it."""
        self.origin.close()
        self._up.clear()
        self._down.clear()
        self.relayed.reset()

    def confirm(self) -> None:
        """The other end has it all."""
        self.pending = 0
        self.origin.resume()

    def let_go(self) -> None:
        """Bring over what was held."""
        self.is_held = False
        self._flow()

    def pending_bytes(self) -> int:
        return self.pending

    def hearer(self, topics: SubscribesTopics | None = None) -> KeepingHearer:
        """A browser of the relay, or of others."""
        made = KeepingHearer()
        (topics or self.relayed).attach(made)
        return made

    def _ask(self, ask: AskTopic) -> None:
        command = Subscribe if b'"subscribe"' in ask.text else Unsubscribe
        self.asked.append(command.model_validate_json(ask.text))
        self._up.append(encode(ask))
        self._flow()

    def _tell(self, message: TopicState | TopicTick) -> None:
        self.told.append(message)
        self._down.append(encode(message))
        self._flow()

    def _flow(self) -> None:
        if self._is_flowing or self.is_held:
            return
        self._is_flowing = True
        try:
            while self._up or self._down:
                self._bring()
        finally:
            self._is_flowing = False

    def _bring(self) -> None:
        if self._down:
            match decode_down(self._down.popleft()):
                case TopicState(text):
                    self.relayed.take_state(text)
                case TopicTick() as tick:
                    self.relayed.take_tick(tick)
                case other:
                    raise AssertionError(other)
        else:
            ask = decode_up(self._up.popleft())
            assert isinstance(ask, AskTopic)
            self.origin.carry_out(ask, self.persons.get(ask.ticket))


@asynccontextmanager
async def line_to(
    source: TopicSource, allows: Callable[[str], bool] = _ALL
) -> AsyncGenerator[tuple[BrowserTopics, Line]]:
    """The topics of a source, and a line by which a relay has them."""
    topics = BrowserTopics(source)
    try:
        yield topics, Line(topics, allows)
    finally:
        await topics.close()


def texts(hearer: KeepingHearer) -> list[str]:
    """What came, of topics of texts."""
    return [text_of(one.payload) for one in hearer.came]

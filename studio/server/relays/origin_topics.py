"""The origin's end of a relay's topics: subscribes for all browsers of the relay, over one line."""

from __future__ import annotations

from collections import Counter
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, Final, Protocol

from pydantic import ValidationError

from studio.live.topics.frames import Tick, frame_of
from studio.outlet import GATE_BYTES
from studio.protocol.roles import owner_of
from studio.protocol.subscriptions import (
    LANE_COMMANDS,
    AskBulk,
    NotSubscribed,
    Subscribe,
    SubscriptionView,
    Unsubscribe,
)
from studio.server.backlog import Backlog
from studio.server.commands import malformed
from studio.server.relays.messages import TopicState, TopicTick
from studio.server.relays.topic_frames import with_lost

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from pydantic import BaseModel

    from studio.live.topics.frames import Chunk
    from studio.protocol.roles import Person
    from studio.protocol.subscriptions import SubscriptionCommand
    from studio.server.relays.messages import AskTopic
    from studio.server.surface import SubscribesTopics

RELAY_SUBSCRIPTIONS_MAX: Final = 400
"""Limit for one relay."""
_COMMAND_LIMIT_BYTES: Final = 4_096
_LATE_FRAME_BYTES: Final = 256 << 10
"""What waited goes in frames of about so many bytes, as far as the line takes them."""
_NOTHING: Final = frame_of((), 0)


def allowed_topics(patterns: Sequence[str]) -> Callable[[str], bool]:
    """Return what tells the topics that an origin sends to relays, by patterns as `/tf*`.

    Without patterns these are all.
    """
    return lambda topic: not patterns or any(fnmatchcase(topic, one) for one in patterns)


class LineLevel(Protocol):
    """A line whose other end confirms what came."""

    def pending_bytes(self) -> int:
        """Bytes taken and not confirmed yet."""
        ...


class TopicsOfRelay:
    """The data lane of one relay, by which the studio's topics are sent to it.

    Every subscription that is not refused is answered by its state and then by a tick that is kept
    for it: its latched messages, which may be none. On a line that is full, messages wait as they
    do for a slow browser. What is given up is added to what its channel lost.

    Args:
        topics: The studio's; this attaches itself.
        send: Puts a message on the line.
        line: Whoever gives it calls `resume` when bytes were confirmed.
        allows: Tells the topics that may be sent.
    """

    def __init__(
        self,
        topics: SubscribesTopics,
        send: Callable[[TopicState | TopicTick], object],
        line: LineLevel,
        allows: Callable[[str], bool],
    ) -> None:
        self._topics, self._send, self._line = topics, send, line
        self._allows = allows
        self._given_up = Counter[int]()
        """Messages by channel."""
        self._backlog = Backlog(self._count_given_up)
        self._commands: dict[int, tuple[Subscribe, Person | None]] = {}
        self._channels: dict[int, int] = {}
        """By subscription, as its state told last."""
        self._owed: dict[int, None] = {}
        """Subscriptions whose latched messages did not go, for the line was full."""
        self._person: Person | None = None
        """Whose command is carried out."""
        self._is_answered = self._is_serving = False
        topics.attach(self, most=RELAY_SUBSCRIPTIONS_MAX)

    def carry_out(self, ask: AskTopic, person: Person | None) -> None:
        """Subscribe or unsubscribe.

        Args:
            ask: What came.
            person: Who may see the document that it is about; None: nobody in particular.
        """
        if len(ask.text) > _COMMAND_LIMIT_BYTES:
            self._refuse(0, "So long a command is not read.")
            return
        try:
            command = LANE_COMMANDS.validate_json(ask.text)
        except ValidationError as error:
            self._refuse(0, malformed("command", error))
            return
        match command:
            case AskBulk():
                self._refuse(0, "A relay has no bulk lane.")
            case Subscribe() if not self._allows(command.topic):
                reason = f"{command.topic} is not sent to relays: ask the owner to allow it."
                self._refuse(command.subscription, reason)
            case Subscribe():
                self._commands[command.subscription] = (command, person)
                self._subscribe(command, person)
            case _:
                self._forget(command.subscription)
                self._carry_out(command, person)

    def resume(self) -> None:
        """Send what waited, as far as the line takes it."""
        while self._owed and self._is_open():
            subscription = next(iter(self._owed))
            del self._owed[subscription]
            if (found := self._commands.get(subscription)) is None:
                continue
            self._is_serving = True
            try:
                self._subscribe(*found)
            finally:
                self._is_serving = False
        while self._backlog and self._is_open():
            self._send_late()

    def review(self, has: Callable[[Person], bool]) -> None:
        """End what was subscribed of documents that may not be seen any more."""
        for subscription, (command, person) in tuple(self._commands.items()):
            if not owner_of(command.document) or person is None:
                continue
            if not (has(person) and person.sees(command.document)):
                self._forget(subscription)
                self._carry_out(Unsubscribe(subscription=subscription), None)
                self._refuse(subscription, "There is no such document.")

    def close(self) -> None:
        """Subscribe nothing more."""
        self._topics.detach(self)
        self._owed.clear()
        self._backlog.take_all()

    # What follows is for the studio's topics.

    def send(self, message: BaseModel, /) -> None:
        """Send a state at once: it is small, and messages are of no use without it."""
        if isinstance(message, SubscriptionView):
            self._channels[message.subscription] = message.channel
            self._given_up = Counter(
                {one: self._given_up[one] for one in {*self._channels.values()} & {*self._given_up}}
            )
        elif isinstance(message, NotSubscribed):
            self._forget(message.subscription)
            self._is_answered = True
        self._send(TopicState(message.model_dump_json().encode()))

    def take(self, tick: Tick, /) -> None:
        """Send what came; what cannot go now is kept as far as it is of worth."""
        if tick.kept_for >= 0:
            self._take_kept(tick)
        elif self._backlog or not self._is_open():
            self._backlog.add(tick.chunks)
        elif self._given_up:
            self._send(TopicTick(self._frame(tick.chunks)))
        else:
            self._send(TopicTick(tick.frame()))

    def sees(self, document: str, /) -> bool:
        """Whether the person whose command is carried out may look at a document."""
        person = self._person
        return not owner_of(document) or (person is not None and person.sees(document))

    def _subscribe(self, command: Subscribe, person: Person | None) -> None:
        self._is_answered = False
        self._carry_out(command, person)
        if not self._is_answered:
            self._send(TopicTick(_NOTHING, command.subscription))

    def _carry_out(self, command: SubscriptionCommand, person: Person | None) -> None:
        self._person = person
        try:
            self._topics.carry_out(self, command)
        finally:
            self._person = None

    def _take_kept(self, tick: Tick) -> None:
        self._is_answered = True
        if not (self._is_serving or self._is_open()):
            self._owed[tick.kept_for] = None
            return
        # What waits of its channel came before.
        for channel in {one.channel for one in tick.chunks}:
            if before := self._backlog.take_of(channel):
                self._send(TopicTick(self._frame(before)))
        self._send(TopicTick(self._frame(tick.chunks), tick.kept_for))

    def _send_late(self) -> None:
        chunks: list[Chunk] = []
        size = 0
        while self._backlog and size < _LATE_FRAME_BYTES:
            chunks.append(self._backlog.pop())
            size += chunks[-1].size
        self._send(TopicTick(self._frame(chunks)))

    def _frame(self, chunks: Sequence[Chunk]) -> bytes:
        given_up = self._given_up
        told = [with_lost(one, n) if (n := given_up[one.channel]) else one for one in chunks]
        return frame_of(told, self._backlog.dropped)

    def _count_given_up(self, chunk: Chunk) -> None:
        self._given_up[chunk.channel] += chunk.count

    def _is_open(self) -> bool:
        return self._line.pending_bytes() <= GATE_BYTES

    def _forget(self, subscription: int) -> None:
        self._commands.pop(subscription, None)
        self._channels.pop(subscription, None)
        self._owed.pop(subscription, None)

    def _refuse(self, subscription: int, reason: str) -> None:
        refused = NotSubscribed(subscription=subscription, reason=reason)
        self._send(TopicState(refused.model_dump_json().encode()))

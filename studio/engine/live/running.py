"""RunningDisplay: one display at work: its ears, its messages, and where its drawing stands."""

from __future__ import annotations

import logging
from contextlib import suppress
from typing import TYPE_CHECKING, Final

from studio.displays.catalogue import display_of_kind, displays_of_type
from studio.displays.display import Display, Received, Status, TopicRole
from studio.displays.drawing import NOTHING
from studio.engine.live.ear import Ear, on_wire, wish_for
from studio.engine.live.placing import Placing
from studio.engine.live.reasons import Facts, OnWire
from studio.errors import DisplayPropertyError, StudioError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from studio.displays.drawing import Drawing, Placed
    from studio.displays.properties import Value
    from studio.engine.live.display_list import DisplaySpec
    from studio.engine.live.ear import Hearing, Wish
    from studio.engine.live.placing import Lookup, Shown
    from studio.errors import FrameError
    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.types.library import TypeLibrary

_SILENT_S: Final = 5.0

_log = logging.getLogger(__name__)


class RunningDisplay:
    """Lives as long as its kind and topic are the same; on the loop, but for `listen` and `close`.

    Raises:
        DisplayError: There is no such kind.
    """

    def __init__(self, spec: DisplaySpec, types: TypeLibrary) -> None:
        self.spec, self._types = spec, types
        self.display: Display = display_of_kind(spec.kind)(types)
        for name, value in spec.values.items():
            with suppress(DisplayPropertyError):  # kept by another studio: the others still hold
                self.display.set(name, value)
        self.placing = Placing()
        self.drawn: Drawing = NOTHING
        """What stands in the scene."""
        self._ears: dict[str, Ear] = {}
        self._wire = OnWire()
        self._trouble = ""
        self._bad_message = ""

    @property
    def topics(self) -> tuple[str, ...]:
        """Of all its roles."""
        if not self.spec.topic:
            return ()
        return tuple(role.topic(self.spec.topic) for role in self.display.TOPICS)

    def set(self, name: str, value: Value) -> Value:
        """Change a property, and give the value that it took.

        Raises:
            DisplayPropertyError: It does not take the value.
        """
        self.display.set(name, value)
        return self.display.values[name]

    def listen(self, hearing: Hearing, publishers: Sequence[Sequence[GraphEndpoint]]) -> None:
        """Listen as fits who publishes now: those of each of `topics`, in their order.

        In a thread. What cannot be heard is told by `facts`.
        """
        roles = self.display.TOPICS
        self._trouble = ""
        for role, endpoints in zip(roles, publishers, strict=False):
            wish = wish_for(role, self.spec.topic, self.spec.listening, endpoints)
            try:
                self._listen_as(hearing, role, wish)
            except StudioError as error:
                if not role.name:
                    self._trouble = str(error)
        if roles and publishers:
            self._wire = on_wire(roles[0], publishers[0], self._types, connected=True)

    def deafen(self) -> None:
        """Stop listening, as when the connection is no more; in a thread."""
        ears, self._ears = self._ears, {}
        for ear in ears.values():
            ear.close()
        self._wire = OnWire()

    def step(self, lookup: Lookup, now_ns: int) -> Shown | None:
        """Take what came, and give what is to be drawn now; None: all is as it was."""
        for role, ear in tuple(self._ears.items()):
            for received in ear.mailbox.take():
                self._take(received, role)
        try:
            drawing = self.display.draw(now_ns)
        except StudioError as error:
            self._bad_message, drawing = str(error), NOTHING
        self.placing.offer(drawing, now_ns)
        return self.placing.step(lookup, now_ns)

    def reset(self) -> None:
        """Forget what came: time jumped."""
        self.display.reset()
        self.placing.renew()

    def wish(self) -> Wish | None:
        """How the main topic is listened to; None: it is not."""
        ear = self._ears.get("")
        return ear.wish if ear else None

    def rate_hz(self, now_ns: int) -> float:
        """Messages on the main topic in a second."""
        ear = self._ears.get("")
        return ear.mailbox.rate_hz(now_ns) if ear else 0.0

    def age_s(self, now_ns: int) -> float | None:
        """How long ago the last one came."""
        ear = self._ears.get("")
        age_ns = ear.mailbox.age_ns(now_ns) if ear else None
        return None if age_ns is None else age_ns / 1e9

    @property
    def lost(self) -> int:
        """Messages that fell out because too many came at once."""
        return sum(ear.mailbox.lost for ear in self._ears.values())

    def facts(self, now_ns: int, *, shown: bool) -> Facts:
        """What is known of why it shows what it shows."""
        ear, age_s = self._ears.get(""), self.age_s(now_ns)
        roles = self.display.TOPICS
        fitting = next((one for name in self._wire.types for one in displays_of_type(name)), None)
        drawing = self.placing.shown.drawing
        return Facts(
            self.spec,
            shown=shown,
            types=roles[0].types if roles else (),
            fitting_kind=fitting.KIND if fitting else "",
            wire=self._wire,
            heard=ear.mailbox.heard if ear else 0,
            silent_s=age_s if age_s is not None and age_s > self._patience_s else None,
            trouble=self._trouble,
            frames=tuple(_first_of_each(self.placing.troubles.values())),
            stamp_zero=bool(roles) and any(_has_no_time(one) for one in drawing.values()),
            statuses=self._statuses(),
            draws=any(placed.shapes for placed in drawing.values()),
        )

    @property
    def _patience_s(self) -> float:
        """What is latched says one thing and then nothing."""
        wish = self.wish()
        return float("inf") if wish and wish.latched else _SILENT_S

    def _statuses(self) -> tuple[Status, ...]:
        said = self.display.statuses()
        if not self._bad_message:
            return said
        return (_bad(self._bad_message), *said)

    def _take(self, received: Received, role: str) -> None:
        try:
            self.display.take(received, role)
            self._bad_message = ""
        except StudioError as error:
            self._bad_message = str(error)
        except Exception:  # noqa: BLE001 - a message of a kind that nobody thought of must not end the rest
            _log.exception("A message on %s could not be drawn.", self.spec.topic)
            self._bad_message = "A message could not be drawn: the terminal says why."

    def _listen_as(self, hearing: Hearing, role: TopicRole, wish: Wish) -> None:
        ear = self._ears.get(role.name)
        if ear is not None and ear.wish == wish:
            return
        if ear is not None:
            ear.close()
            del self._ears[role.name]
        self._ears[role.name] = Ear(hearing, wish, role)


def _first_of_each(errors: Iterable[FrameError]) -> Iterator[FrameError]:
    """Of errors that say the same, one."""
    return iter({str(error): error for error in errors}.values())


def _has_no_time(placed: Placed) -> bool:
    return placed.stamp_ns == 0 and not placed.follows


def _bad(sentence: str) -> Status:
    return Status("error", "bad_message", sentence)

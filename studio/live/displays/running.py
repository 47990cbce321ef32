"""RunningDisplay: one display at work: its ears, its messages, and where its drawing stands."""

from __future__ import annotations

import logging
import math
import threading
import time
from contextlib import suppress
from itertools import chain
from typing import TYPE_CHECKING, Final

from studio.displays.catalogue import display_of_kind, displays_of_type
from studio.displays.display import Display, Received, Status, TopicRole
from studio.displays.drawing import NOTHING
from studio.errors import DisplayPropertyError, StudioError
from studio.live.displays.ear import Ear, on_wire, wish_for
from studio.live.displays.placing import Placing
from studio.live.displays.reasons import Facts, OnWire

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from studio.displays.drawing import Drawing, Placed
    from studio.displays.properties import Value
    from studio.errors import FrameError
    from studio.live.displays.display_list import DisplaySpec
    from studio.live.displays.ear import Hearing, Wish
    from studio.live.displays.placing import Lookup, Shown
    from studio.live.displays.topics_now import TopicsNow
    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.types.library import TypeLibrary

_SILENT_S: Final = 5.0
_NOT_DRAWN: Final = "A message could not be drawn: the terminal says why."

_log = logging.getLogger(__name__)


class RunningDisplay:
    """Lives as long as its kind and topic are the same.

    All is the loop's, but for `listen`, `deafen` and `close`, which wait: they are for a thread.

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
        self._turn = threading.Lock()
        """Who listens and who ends that come from different threads."""
        self._closed = False
        self._wire = OnWire()
        self._instead = ""
        self._trouble = ""
        self._bad_message = ""
        self._placed_ns = 0

    @property
    def topics(self) -> tuple[str, ...]:
        """Of all its roles."""
        if not self.spec.topic:
            return ()
        return tuple(role.topic(self.spec.topic) for role in self.display.roles())

    def set(self, name: str, value: Value) -> Value:
        """Change a property, and give the value that it took.

        Raises:
            DisplayPropertyError: It does not take the value.
        """
        self.display.set(name, value)
        return self.display.values[name]

    def listen(
        self,
        hearing: Hearing,
        publishers_of: Callable[[str], Sequence[GraphEndpoint]],
        *,
        connected: bool = True,
    ) -> None:
        """Listen as fits who publishes now.

        What cannot be heard is told by `facts`.

        Args:
            hearing: By which it is heard.
            publishers_of: Those of a topic; raises a StudioError for what names none.
            connected: Whether the router is there.
        """
        with self._turn:
            if not self._closed:
                self._listen(hearing, publishers_of, connected=connected)

    def look_around(self, topics: TopicsNow) -> None:
        """Know what to listen to instead, as long as nobody publishes its topic; in a thread."""
        lacks = self._wire.publishers == 0
        self._instead = topics.instead_of(self.spec.topic, self.display) if lacks else ""

    def deafen(self) -> None:
        """Stop listening, as when the connection is no more."""
        with self._turn:
            ears, self._ears = self._ears, {}
            for ear in ears.values():
                ear.close()
            self._wire, self._instead = OnWire(), ""

    def close(self) -> None:
        """Stop listening for good, also if somebody is about to listen."""
        self._closed = True
        self.deafen()

    def step(self, lookup: Lookup, now_ns: int, at_once_s: float = math.inf) -> Shown | None:
        """Take what came, and give what is to be drawn now; None: all is as it was.

        Of each topic one message is taken, and more for so long; the rest waits for other steps.
        """
        until_s = time.perf_counter() + at_once_s
        for role, ear in tuple(self._ears.items()):
            for received in ear.mailbox.take():
                self._take(received, role)
                if time.perf_counter() > until_s:
                    break
        self.placing.offer(self._drawing(now_ns), now_ns)
        rests = bool(self.placing.shown.poses) and not self.placing.waits
        if rests and now_ns - self._placed_ns < self.display.interval_ns:
            return None
        self._placed_ns = now_ns
        return self.placing.step(lookup, now_ns)

    def reset(self) -> None:
        """Forget what came: time jumped, or nobody wants to see it.

        What is latched is told once, so it holds for all times.
        """
        wish = self.wish()
        if wish is None or not wish.latched:
            self.forget()

    def forget(self) -> None:
        """Show nothing of what came: it is of a connection that is no more."""
        self.display.reset()
        self.placing.forget()

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
        return None if age_ns is None else max(0.0, age_ns / 1e9)

    @property
    def lost(self) -> int:
        """Messages that fell out because too many came at once."""
        return sum(ear.mailbox.lost for ear in tuple(self._ears.values()))

    def facts(self, now_ns: int, *, shown: bool, more: tuple[Status, ...] = ()) -> Facts:
        """What is known of why it shows what it shows, with more that is to be said."""
        ear, age_s = self._ears.get(""), self.age_s(now_ns)
        roles = self.display.roles()
        of_types = (displays_of_type(name, self.spec.topic) for name in self._wire.types)
        fitting = next(chain.from_iterable(of_types), None)
        drawing = self.placing.shown.drawing
        return Facts(
            self.spec,
            shown=shown,
            types=roles[0].types if roles else (),
            fitting_kind=fitting.KIND if fitting else "",
            wire=self._wire,
            instead=self._instead,
            heard=ear.mailbox.heard if ear else 0,
            silent_s=age_s if age_s is not None and age_s > self._patience_s else None,
            trouble=self._trouble,
            frames=tuple(_first_of_each(self.placing.troubles.values())),
            frame=next((drawing[one].frame for one in self.placing.troubles if one in drawing), ""),
            stamp_zero=bool(roles) and any(_has_no_time(one) for one in drawing.values()),
            statuses=(*self._statuses(), *more),
            draws=any(placed.shapes for placed in drawing.values()),
            waits=self.placing.waits,
        )

    @property
    def _patience_s(self) -> float:
        """What is latched says one thing and then nothing."""
        wish = self.wish()
        return math.inf if wish and wish.latched else _SILENT_S

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
            self._not_drawn()

    def _drawing(self, now_ns: int) -> Drawing:
        try:
            return self.display.draw(now_ns)
        except StudioError as error:
            self._bad_message = str(error)
        except Exception:  # noqa: BLE001 - as in `_take`
            self._not_drawn()
        return NOTHING

    def _not_drawn(self) -> None:
        """The terminal says why, once: it may be so with every message."""
        if self._bad_message != _NOT_DRAWN:
            _log.exception("A message on %s could not be drawn.", self.spec.topic)
        self._bad_message = _NOT_DRAWN

    def _listen(
        self,
        hearing: Hearing,
        publishers_of: Callable[[str], Sequence[GraphEndpoint]],
        *,
        connected: bool,
    ) -> None:
        self._trouble = ""
        roles = self.display.roles()
        for gone in self._ears.keys() - {role.name for role in roles}:
            self._ears.pop(gone).close()
        for role, topic in zip(roles, self.topics, strict=False):
            try:
                publishers = publishers_of(topic)
                if not role.name:
                    self._wire = on_wire(role, publishers, self._types, connected=connected)
                self._listen_as(hearing, role, publishers)
            except StudioError as error:
                if not role.name:
                    self._wire = OnWire(connected=True, lost=not connected)
                    self._trouble = str(error)

    def _listen_as(
        self, hearing: Hearing, role: TopicRole, publishers: Sequence[GraphEndpoint]
    ) -> None:
        ear, spec = self._ears.get(role.name), self.spec
        before = ear.wish if ear else None
        wish = wish_for(role, spec.topic, spec.listening, publishers, before)
        if ear is not None:
            if wish == before:
                return
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

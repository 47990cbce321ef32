"""RunningDisplay: a display with its subscriptions, and the poses of its drawing."""

from __future__ import annotations

import logging
import math
import time
from contextlib import suppress
from itertools import chain
from typing import TYPE_CHECKING, Final

from studio.displays.catalogue import displays_of_type
from studio.displays.display import Received, Status
from studio.displays.drawing import NOTHING
from studio.errors import DisplayPropertyError, StudioError
from studio.live.displays.placing import Placing
from studio.live.displays.reasons import Facts
from studio.live.topics.request import Request, SubscriptionState

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from studio.displays.display import Display, TopicRole
    from studio.displays.drawing import Drawing, Placed
    from studio.displays.properties import Value
    from studio.errors import FrameError
    from studio.live.displays.display_list import DisplaySpec, Listening
    from studio.live.displays.placing import Lookup, Shown
    from studio.live.displays.topics_now import TopicsNow
    from studio.live.topics.request import Fit
    from studio.live.topics.source import TopicSource
    from studio.live.topics.subscription import Subscription

_SILENT_S: Final = 5.0
_WAITING_MAX: Final = 1_000
_NOT_DRAWN: Final = "A message could not be drawn: the terminal says why."

_log = logging.getLogger(__name__)


class RunningDisplay:
    """Lives as long as its kind and topic are the same; used on the event loop only."""

    def __init__(self, spec: DisplaySpec, display: Display) -> None:
        self.spec, self.display = spec, display
        display.topic = spec.topic
        for name, value in spec.values.items():
            with suppress(DisplayPropertyError):  # kept by another studio: the others still hold
                self.display.set(name, value)
        self.placing = Placing()
        self.drawn: Drawing = NOTHING
        """The drawing in the scene."""
        self._subscriptions: dict[str, Subscription] = {}
        """By role."""
        self._closed = False
        self._beginnings: dict[str, int] = {}
        """By role, as `_begun` was in the last epoch."""
        self._instead = ""
        self._bad_message = ""
        self._placed_ns = 0

    @property
    def shown(self) -> Shown:
        """What is drawn, and the poses of its groups in the fixed frame."""
        return self.placing.shown

    @property
    def topics(self) -> tuple[str, ...]:
        """The topics of all roles."""
        if not self.spec.topic:
            return ()
        return tuple(role.topic(self.spec.topic) for role in self.display.roles())

    def set(self, name: str, value: Value) -> Value:
        """Change a property, and return its new value.

        Raises:
            DisplayPropertyError: It does not take the value.
        """
        self.display.set(name, value)
        return self.display.values[name]

    def subscribe(self, source: TopicSource) -> bool:
        """Subscribe to the topics that it needs now; return whether that changed anything.

        `facts` reports what prevents one.
        """
        wanted: dict[str, Request] = {}
        if self.spec.topic and not self._closed:
            for role in self.display.roles():
                wanted[role.name] = request_for(role, self.spec.topic, self.spec.listening)
        for name, one in tuple(self._subscriptions.items()):
            if wanted.get(name) != one.request:
                self._subscriptions.pop(name).close()
        new = wanted.keys() - self._subscriptions.keys()
        for name in new:
            self._subscriptions[name] = source.subscribe(wanted[name])
        if new:
            self._beginnings = self._begun()
        return bool(new)

    def find_instead(self, topics: TopicsNow) -> None:
        """Find another topic to subscribe to while nobody publishes its own."""
        main = self._subscriptions.get("")
        lacks = main is not None and main.state.publishers == 0
        self._instead = topics.instead_of(self.spec.topic, self.display) if lacks else ""

    def unsubscribe(self) -> None:
        """Receive nothing, as when it is hidden."""
        subscriptions, self._subscriptions = self._subscriptions, {}
        for one in subscriptions.values():
            one.close()
        self._instead = ""

    def close(self) -> None:
        """Receive nothing any more."""
        self._closed = True
        self.display.close()
        self.unsubscribe()

    def step(
        self,
        lookup: Lookup,
        now_ns: int,
        wall_ns: int | None = None,
        at_once_s: float = math.inf,
    ) -> Shown | None:
        """Take what came, and return what to draw now; None: nothing changed.

        Of each topic one message is taken, and more for so long; the rest waits for other steps.
        What is drawn is of `now_ns`, and transforms are waited for by `wall_ns`.
        """
        wall_ns = now_ns if wall_ns is None else wall_ns
        until_s = time.perf_counter() + at_once_s
        for role, subscription in self._subscriptions.items():
            type_name = subscription.fit.type_name if subscription.fit else ""
            for payload, _, received_ns in subscription.take_each():
                self._take(Received(type_name, payload, received_ns), role)
                if time.perf_counter() > until_s:
                    break
        self.placing.offer(self._drawing(now_ns), wall_ns)
        rests = bool(self.placing.shown.poses) and not self.placing.waits
        if rests and wall_ns - self._placed_ns < self.display.interval_ns:
            return None
        self._placed_ns = wall_ns
        return self.placing.step(lookup, wall_ns)

    def reset(self) -> None:
        """Forget what was received: time jumped, or the display is hidden.

        Latched messages come only once, so they stay.
        """
        fit = self.fit
        if fit is None or not fit.latched:
            self.forget()

    @property
    def received(self) -> int:
        """Messages on the main topic since it was subscribed."""
        main = self._subscriptions.get("")
        return main.received if main else 0

    def begin_anew(self) -> None:
        """Forget what came and subscribe again with the next check: what is latched comes again."""
        self.unsubscribe()
        self.forget()
        self._bad_message = ""

    def begin_epoch(self) -> None:
        """Forget what came in another epoch; what would come again just so stays."""
        before, self._beginnings = self._beginnings, self._begun()
        if before == self._beginnings and before:
            self.placing.renew()
            return
        self.forget()
        for role, subscription in self._subscriptions.items():
            if before.get(role) == subscription.beginnings:
                subscription.give_again()  # it stays as it was, and will not come by itself

    def _begun(self) -> dict[str, int]:
        """Return by role how often its subscription began anew."""
        return {role: one.beginnings for role, one in self._subscriptions.items()}

    def forget(self) -> None:
        """Show nothing of what came: it is of another connection."""
        self.display.reset()
        self.placing.forget()

    @property
    def fit(self) -> Fit | None:
        """QoS of the main subscription; None: not subscribed."""
        main = self._subscriptions.get("")
        return main.fit if main else None

    def rate_hz(self, now_ns: int) -> float:
        """Return how many messages come on the main topic in a second."""
        main = self._subscriptions.get("")
        return main.rate_hz(now_ns) if main else 0.0

    def age_s(self, now_ns: int) -> float | None:
        """Return how long ago the last one came."""
        main = self._subscriptions.get("")
        age_ns = main.age_ns(now_ns) if main else None
        return None if age_ns is None else max(0.0, age_ns / 1e9)

    @property
    def lost(self) -> int:
        """Messages that fell out because too many came at once."""
        return sum(one.dropped for one in self._subscriptions.values())

    def facts(self, now_ns: int, *, shown: bool, more: tuple[Status, ...] = ()) -> Facts:
        """Return the facts about what it shows; `more` are further statuses."""
        main, age_s = self._subscriptions.get(""), self.age_s(now_ns)
        state = main.state if main else SubscriptionState(self.spec.topic)
        roles = self.display.roles()
        of_types = (displays_of_type(name, self.spec.topic) for name in state.types)
        fitting = next(chain.from_iterable(of_types), None)
        drawing = self.placing.shown.drawing
        return Facts(
            self.spec,
            state,
            shown=shown,
            types=roles[0].types if roles else (),
            fitting_kind=fitting.KIND if fitting else "",
            instead=self._instead,
            received=self.received,
            silent_s=age_s if age_s is not None and age_s > self._patience_s else None,
            frames=tuple(_first_of_each(self.placing.troubles.values())),
            frame=next((drawing[one].frame for one in self.placing.troubles if one in drawing), ""),
            stamp_zero=bool(roles) and any(_has_no_time(one) for one in drawing.values()),
            statuses=(*self._statuses(), *more),
            draws=any(placed.shapes for placed in drawing.values()),
            waits=self.placing.waits,
        )

    @property
    def _patience_s(self) -> float:
        """How long a topic may be silent; a latched one is silent after its first message."""
        fit = self.fit
        return math.inf if fit and fit.latched else _SILENT_S

    def _statuses(self) -> tuple[Status, ...]:
        statuses = self.display.statuses()
        if not self._bad_message:
            return statuses
        return (_bad(self._bad_message), *statuses)

    def _take(self, received: Received, role: str) -> None:
        try:
            self.display.take(received, role)
            self._bad_message = ""
        except StudioError as error:
            self._bad_message = str(error)
        except Exception:  # noqa: BLE001 - an unforeseen message must not end the rest
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
        """Log the error, once: every message may cause it."""
        if self._bad_message != _NOT_DRAWN:
            _log.exception("A message on %s could not be drawn.", self.spec.topic)
        self._bad_message = _NOT_DRAWN


def request_for(role: TopicRole, topic: str, chosen: Listening) -> Request:
    """Return what is wanted of the topic of a role beside a main one."""
    return Request(
        role.topic(topic),
        role.types,
        newest_only=role.newest_only,
        reliable=role.chosen_reliable if chosen.reliable is None else chosen.reliable,
        latched=chosen.latched,
        depth=chosen.depth or role.depth,
        usually=(role.reliable, role.latched),
        as_known_here=True,
        waiting_max=_WAITING_MAX,
    )


def _first_of_each(errors: Iterable[FrameError]) -> Iterator[FrameError]:
    """Return one error of each message."""
    return iter({str(error): error for error in errors}.values())


def _has_no_time(placed: Placed) -> bool:
    return placed.stamp_ns == 0 and not placed.follows


def _bad(sentence: str) -> Status:
    return Status("error", "bad_message", sentence)

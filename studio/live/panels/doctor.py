"""The Doctor: what is wrong with the ROS 2 system, the document and the browser of who asks."""

from __future__ import annotations

import asyncio
import time
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Final, NamedTuple

from studio.debounce import Throttle
from studio.errors import NotJoinedError, RouterGoneError, StudioError
from studio.live.doctor.parameter_changes import ParameterChanges
from studio.live.doctor.seen import Seen, SeenBrowser
from studio.live.topics.request import Request
from studio.protocol.commands import Commands, Limits, Scope
from studio.protocol.doctor import DoctorReport, ExamineSystem, GetDoctorReport, SystemExamined

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Mapping

    from studio.live.connection.link import WireLink
    from studio.live.connection.ros_connection import RosConnection
    from studio.live.doctor.examination import Concluded, Examination
    from studio.live.doctor.report import Language
    from studio.live.doctor.seen import Answers, Heard, Here, SeenDocument, System, Unanswered
    from studio.live.doctor.watching import Watching
    from studio.protocol.connection import WireReport
    from studio.protocol.doctor import LookingBrowser, SubjectName
    from studio.protocol.listeners import Listener
    from studio.ros.graph.diagnosis import DistroHashes
    from studio.ros.node.samples import RawSample

LISTENS_S: Final = 3.0
"""After so long rates, clocks and frames are known of all that comes once a second."""
_ASK_EVERY_S: Final = 10.0
_LOOK_EVERY_S: Final = 0.5
_PLACE_EVERY_S: Final = 4.0
_FORGOTTEN_S: Final = 60.0
_EVENTS: Final = Request(
    "/parameter_events", ("rcl_interfaces/msg/ParameterEvent",), depth=1_000, as_known_here=True
)
_SINCE: Final = "the studio joined"
_READ_EVERY_S: Final = 0.5
_OFTEN: Final = Limits(bytes_max=2_000, per_second=4)
_SELDOM: Final = Limits(bytes_max=2_000, per_second=1)


class _Shared(NamedTuple):
    """What was seen, and what is concluded of it for all who ask."""

    at_s: float
    seen: Seen
    concluded: dict[SubjectName, Concluded]


@dataclass(slots=True)
class _Visit:
    """What is known of one system; `link` None: of the place where the studio would connect."""

    link: WireLink | None = None
    parameters: ParameterChanges | None = None
    """What is heard of parameters; None: only what watching hears."""
    watching: Watching | None = None
    hashes: DistroHashes | None = None
    turn: asyncio.Lock = field(default_factory=asyncio.Lock)
    """Held while a thread looks: all who ask meanwhile are told the same."""
    shared: _Shared | None = None
    system: System | None = None
    version: int = -1
    """Of the graph, when it was looked at."""
    answers: Answers | None = None
    asked_s: float = -_ASK_EVERY_S
    asking: asyncio.Task[None] | None = None


class Doctor:
    """Listens and asks while somebody wants to know, once for all who do.

    Args:
        connection: With the ROS 2 system.
        unanswered: Returns the studio's own calls and goals that were not answered.
    """

    def __init__(
        self, connection: RosConnection, unanswered: Callable[[], tuple[Unanswered, ...]]
    ) -> None:
        self._connection, self._unanswered = connection, unanswered
        self.document_of: Callable[[str], SeenDocument | None] = lambda _id: None
        """Returns what is known of an open document."""
        self.own_link: Callable[[str, str], Awaitable[WireLink | None]] = _nobodys
        """Returns the system of a person's own nodes, where a document of theirs is about it."""
        self._parameters: ParameterChanges | None = None
        self._epoch = connection.topics.epoch
        self._reading = Throttle(self._read_parameters, first_s=_READ_EVERY_S)
        self._visits: dict[WireLink | None, _Visit] = {}
        self._here: Here | None = None

    def listen(self) -> None:
        """Hear changes of parameters from now on, where a system is connected.

        Only who listened when a node declared them knows with which values it was started.
        """
        topics = self._connection.topics
        if self._parameters is not None:
            self._forget_another_system(self._parameters)
            return
        if topics.connection != "there":
            return
        loop = asyncio.get_running_loop()
        self._parameters = changes = ParameterChanges(lambda: topics.types, _SINCE)

        def take(sample: RawSample) -> None:  # in a thread of the source
            self._forget_another_system(changes)
            changes.take(sample.payload, sample.attachment.gid)
            if not loop.is_closed():
                loop.call_soon_threadsafe(self._reading.trigger)

        self._epoch = topics.epoch
        topics.subscribe(_EVENTS, take=take)

    def _forget_another_system(self, changes: ParameterChanges) -> None:
        if self._epoch != self._connection.topics.epoch:
            self._epoch = self._connection.topics.epoch
            changes.forget()

    async def _read_parameters(self) -> None:
        if self._parameters is not None:
            await asyncio.to_thread(self._parameters.read)

    async def close(self) -> None:
        """End all."""
        await self.let_go()
        await self._reading.close()

    async def examine(self, command: ExamineSystem, asker: Listener) -> SystemExamined:
        """Return what is found as of now; later answers know more."""
        seen, found = await self._found(command, asker)
        listened_s = seen.heard.listened_s if seen.heard else 0.0
        is_away = seen.system is None or not seen.system.is_connected
        return SystemExamined(
            request=command.request,
            listened_s=round(listened_s, 1),
            listens_s=LISTENS_S,
            is_complete=is_away or (seen.answers is not None and listened_s >= LISTENS_S),
            findings=found.findings,
            more=found.more,
            subjects=found.subjects,
        )

    async def report(self, command: GetDoctorReport, asker: Listener) -> DoctorReport:
        """Return the same as an HTML file."""
        seen, found = await self._found(command, asker)
        html = await asyncio.to_thread(_reported, seen, found, command.language)
        return DoctorReport(request=command.request, html=html)

    async def let_go(self) -> None:
        """Let go of all systems: a connection is about to end."""
        visits, self._visits = self._visits, {}
        for visit in visits.values():
            async with visit.turn:
                if visit.watching is not None:
                    await asyncio.to_thread(visit.watching.close)
            if visit.asking is not None:
                await asyncio.gather(visit.asking, return_exceptions=True)

    async def _found(self, command: LookingBrowser, asker: Listener) -> tuple[Seen, Examination]:
        """Add what concerns the asker alone to what is the same for all."""
        own = await self.own_link(command.document, asker.person)
        visit = self._visit_of(own or self._connection.current)
        async with visit.turn:
            if visit.shared is None or _is_due(visit.shared.at_s, _every_s(visit)):
                visit.shared = await self._looked_anew(visit)
            shared = visit.shared
        seen = replace(
            shared.seen,
            document=self.document_of(command.document),
            browser=SeenBrowser(command.renderer, command.draws_by_software),
        )
        return seen, await asyncio.to_thread(_completed, seen, shared.concluded)

    def _visit_of(self, link: WireLink | None) -> _Visit:
        """Return what is known of a system; those that nobody asks for any more are forgotten."""
        for other, visit in tuple(self._visits.items()):
            is_looking = other is link or visit.turn.locked()
            # One that was never seen had ended before.
            if not is_looking and (not visit.shared or _is_due(visit.shared.at_s, _FORGOTTEN_S)):
                del self._visits[other]  # what it listened to has ended by itself
        shared = self._parameters if link is self._connection.current else None
        return self._visits.setdefault(link, _Visit(link, shared))

    async def _looked_anew(self, visit: _Visit) -> _Shared:
        if self._here is None:
            self._here = await asyncio.to_thread(_look_here)
        seen = Seen(here=self._here, unanswered=self._unanswered())
        if visit.link is None:
            place = await asyncio.to_thread(_look_at_place, self._connection)
            seen = replace(seen, place=place)
        else:
            system, heard = await asyncio.to_thread(_looked, visit)
            self._ask_again(visit, system)
            seen = replace(seen, system=system, heard=heard, answers=visit.answers)
        concluded = await asyncio.to_thread(_concluded, seen)
        return _Shared(time.monotonic(), seen, concluded)

    def _ask_again(self, visit: _Visit, system: System) -> None:
        """Ask routers and nodes beside, for some do not answer."""
        is_asking = visit.asking is not None and not visit.asking.done()
        if system.is_connected and not is_asking and _is_due(visit.asked_s, _ASK_EVERY_S):
            visit.asking = asyncio.create_task(self._ask(visit, system))

    async def _ask(self, visit: _Visit, system: System) -> None:
        visit.answers = await asyncio.to_thread(_asked, visit, system)
        visit.asked_s = time.monotonic()


async def _nobodys(_document: str, _person: str) -> WireLink | None:
    """Return no system: the default of `own_link`."""
    return None


def _every_s(visit: _Visit) -> float:
    return _PLACE_EVERY_S if visit.link is None else _LOOK_EVERY_S


def _is_due(at_s: float, every_s: float) -> bool:
    return time.monotonic() - at_s >= every_s


# What follows runs in threads, and imports Zenoh.


def _looked(visit: _Visit) -> tuple[System, Heard]:
    """Raises: RouterGoneError: The connection ended meanwhile."""
    from studio.ros.wire.zenoh import ZError  # noqa: PLC0415

    link = visit.link
    assert link is not None
    try:
        system = _looked_at(visit, link)
        return system, _listening(visit, link).heard(system)
    except (NotJoinedError, ZError):
        raise RouterGoneError(link.endpoint) from None


def _listening(visit: _Visit, link: WireLink) -> Watching:
    from studio.live.doctor.watching import Watching  # noqa: PLC0415

    if visit.watching is None:
        visit.watching = Watching(link.context, link.types, parameters=visit.parameters)
    return visit.watching


def _looked_at(visit: _Visit, link: WireLink) -> System:
    """Return the graph, which is taken anew only when it changed."""
    from studio.live.doctor.asking import look  # noqa: PLC0415
    from studio.ros.graph.diagnosis import DistroHashes  # noqa: PLC0415

    visit.hashes = hashes = visit.hashes or DistroHashes(link.types)
    version, system = link.graph.version, visit.system
    if system is None or version != visit.version or system.is_connected != link.is_connected:
        own = frozenset({link.zid})
        system = look(link.context.wire, link.graph, link.types, hashes, own=own)
        visit.system, visit.version = system, version
    return system


def _asked(visit: _Visit, system: System) -> Answers | None:
    from studio.live.doctor.asking import ask  # noqa: PLC0415
    from studio.ros.wire.zenoh import ZError  # noqa: PLC0415

    if visit.link is None:
        return None
    try:
        return ask(visit.link.context.wire, system, visit.answers)
    except (StudioError, ZError):  # the connection ended meanwhile
        return visit.answers


def _look_at_place(connection: RosConnection) -> WireReport | None:
    from studio.live.connection.report import examine  # noqa: PLC0415

    try:
        return examine(connection.choice, ())
    except StudioError:
        return None  # the settings are not valid: the page says so where they are chosen


def _look_here() -> Here:
    from studio.live.doctor.asking import look_here  # noqa: PLC0415

    return look_here()


def _concluded(seen: Seen) -> dict[SubjectName, Concluded]:
    from studio.live.doctor.examination import SHARED, concluded  # noqa: PLC0415

    return concluded(seen, SHARED)


def _completed(seen: Seen, shared: Mapping[SubjectName, Concluded]) -> Examination:
    from studio.live.doctor.examination import (  # noqa: PLC0415
        OF_WHO_ASKS,
        concluded,
        examination_of,
    )

    return examination_of({**shared, **concluded(seen, OF_WHO_ASKS)})


def _reported(seen: Seen, found: Examination, language: Language) -> str:
    from studio.live.doctor.report import report_of  # noqa: PLC0415

    return report_of(seen, found, language)


COMMANDS: Final = Commands[Doctor](Scope.ROS)
COMMANDS.viewer(ExamineSystem, lambda one, c, who: one.examine(c, who), limits=_OFTEN)
COMMANDS.viewer(GetDoctorReport, lambda one, c, who: one.report(c, who), limits=_SELDOM)

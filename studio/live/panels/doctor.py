"""The Doctor: what is wrong with the ROS 2 system, the document and the browser of who asks."""

from __future__ import annotations

import asyncio
import time
from dataclasses import dataclass, replace
from datetime import datetime
from typing import TYPE_CHECKING, Final, NamedTuple

from studio.errors import NotJoinedError, RouterGoneError, StudioError
from studio.live.doctor.here import look_here
from studio.live.doctor.seen import Seen, SeenBrowser
from studio.protocol.commands import Commands, Limits, Scope
from studio.protocol.doctor import DoctorReport, ExamineSystem, GetDoctorReport, SystemExamined
from studio.settings import repository_or_wheel

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from studio.live.connection.link import WireLink
    from studio.live.connection.ros_connection import RosConnection
    from studio.live.doctor.examination import Concluded, Examination
    from studio.live.doctor.seen import Answers, Heard, Here, SeenDocument, System, Unanswered
    from studio.live.doctor.watching import Watching
    from studio.protocol.connection import WireReport
    from studio.protocol.doctor import LookingBrowser, SubjectName
    from studio.ros.graph.diagnosis import DistroHashes

LISTENS_S: Final = 3.0
"""After so long rates, clocks and frames are known of all that comes once a second."""
_ASK_EVERY_S: Final = 10.0
_LOOK_EVERY_S: Final = 0.5
_PLACE_EVERY_S: Final = 4.0
_OFTEN: Final = Limits(bytes_max=2_000, per_second=4)
_SELDOM: Final = Limits(bytes_max=2_000, per_second=1)


@dataclass(slots=True)
class _Visit:
    """What is known of one connection."""

    link: WireLink
    watching: Watching
    hashes: DistroHashes
    system: System | None = None
    version: int = -1
    """Of the graph, when it was looked at."""
    answers: Answers | None = None
    asked_s: float = -_ASK_EVERY_S
    asking: asyncio.Task[None] | None = None


class _Shared(NamedTuple):
    """What was seen, and what is concluded of it for all who ask."""

    at_s: float
    seen: Seen
    concluded: dict[SubjectName, Concluded]


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
        self._visit: _Visit | None = None
        self._turn = asyncio.Lock()
        """Held while a thread looks: all who ask meanwhile are told the same."""
        self._here: Here | None = None
        self._shared: _Shared | None = None

    async def examine(self, command: ExamineSystem) -> SystemExamined:
        """Return what is found as of now; later answers know more."""
        seen, found = await self._found(command)
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

    async def report(self, command: GetDoctorReport) -> DoctorReport:
        """Return the same as an HTML file."""
        seen, found = await self._found(command)
        html = await asyncio.to_thread(_reported, seen, found, command)
        return DoctorReport(request=command.request, html=html)

    async def let_go(self) -> None:
        """Let go of the connection, which is about to end."""
        async with self._turn:
            visit, self._visit, self._shared = self._visit, None, None
            if visit is not None:
                await asyncio.to_thread(visit.watching.close)
        if visit is not None and visit.asking is not None:
            await asyncio.gather(visit.asking, return_exceptions=True)

    async def _found(self, command: LookingBrowser) -> tuple[Seen, Examination]:
        """Add what concerns the asker alone to what is the same for all."""
        shared = await self._seen()
        seen = replace(
            shared.seen,
            document=self.document_of(command.document),
            browser=SeenBrowser(command.renderer, command.draws_by_software),
        )
        return seen, await asyncio.to_thread(_completed, seen, shared.concluded)

    async def _seen(self) -> _Shared:
        """Look, unless somebody else did just now."""
        async with self._turn:
            if self._shared is None or not self._is_fresh(self._shared):
                seen = await self._looked_anew()
                concluded = await asyncio.to_thread(_concluded, seen)
                self._shared = _Shared(time.monotonic(), seen, concluded)
            return self._shared

    def _is_fresh(self, shared: _Shared) -> bool:
        was_joined = shared.seen.system is not None
        if was_joined != (self._connection.current is not None):
            return False
        return not _is_due(shared.at_s, _LOOK_EVERY_S if was_joined else _PLACE_EVERY_S)

    async def _looked_anew(self) -> Seen:
        if self._here is None:
            self._here = await asyncio.to_thread(_look_here)
        link, unanswered = self._connection.current, self._unanswered()
        if link is None:
            place = await asyncio.to_thread(_look_at_place, self._connection)
            return Seen(here=self._here, place=place, unanswered=unanswered)
        if self._visit is None or self._visit.link is not link:
            self._visit = await asyncio.to_thread(_begun, link)
        visit = self._visit
        system, heard = await asyncio.to_thread(_looked, visit)
        self._ask_again(visit, system)
        return Seen(self._here, None, system, heard, visit.answers, unanswered=unanswered)

    def _ask_again(self, visit: _Visit, system: System) -> None:
        """Ask routers and nodes beside, for some do not answer."""
        is_asking = visit.asking is not None and not visit.asking.done()
        if system.is_connected and not is_asking and _is_due(visit.asked_s, _ASK_EVERY_S):
            visit.asking = asyncio.create_task(self._ask(visit, system))

    async def _ask(self, visit: _Visit, system: System) -> None:
        visit.answers = await asyncio.to_thread(_asked, visit, system)
        visit.asked_s = time.monotonic()


def _is_due(at_s: float, every_s: float) -> bool:
    return time.monotonic() - at_s >= every_s


# What follows runs in threads, and imports Zenoh.


def _begun(link: WireLink) -> _Visit:
    from studio.live.doctor.watching import Watching  # noqa: PLC0415
    from studio.ros.graph.diagnosis import DistroHashes  # noqa: PLC0415

    return _Visit(link, Watching(link.context, link.types), DistroHashes(link.types))


def _looked(visit: _Visit) -> tuple[System, Heard]:
    """Raises: RouterGoneError: The connection ended meanwhile."""
    from studio.ros.wire.zenoh import ZError  # noqa: PLC0415

    try:
        system = _looked_at(visit)
        return system, visit.watching.heard(system)
    except (NotJoinedError, ZError):
        raise RouterGoneError(visit.link.endpoint) from None


def _looked_at(visit: _Visit) -> System:
    """Return the graph, which is taken anew only when it changed."""
    from studio.live.doctor.asking import look  # noqa: PLC0415

    link, version = visit.link, visit.link.graph.version
    system = visit.system
    if system is None or version != visit.version or system.is_connected != link.is_connected:
        own = frozenset({link.zid})
        system = look(link.context.wire, link.graph, link.types, visit.hashes, own=own)
        visit.system, visit.version = system, version
    return system


def _asked(visit: _Visit, system: System) -> Answers | None:
    from studio.live.doctor.asking import ask  # noqa: PLC0415
    from studio.ros.wire.zenoh import ZError  # noqa: PLC0415

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
    from studio.live.doctor.subjects.network import NAMES  # noqa: PLC0415

    return look_here(NAMES)


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


def _reported(seen: Seen, found: Examination, command: GetDoctorReport) -> str:
    from studio.live.doctor.report import About, report_html, words_of  # noqa: PLC0415

    words = words_of(repository_or_wheel("frontend_assets"), command.language)
    made = datetime.now().astimezone().strftime("%Y-%m-%d %H:%M:%S %Z")
    return report_html(found, About(command.language, facts_of(seen), made), words)


def facts_of(seen: Seen) -> tuple[tuple[str, str], ...]:
    """Return what was examined, by the names of its facts."""
    if seen.system is not None:
        place = (seen.system.endpoint, seen.system.domain, seen.system.profile.distro)
    elif seen.place is not None:
        place = (seen.place.endpoint, seen.place.domain, seen.place.distro)
    else:
        return ()
    router, domain, distro = place
    nodes = (("nodes", str(len(seen.system.others))),) if seen.system else ()
    return (("router", router), ("domain", str(domain)), ("distribution", distro), *nodes)


COMMANDS: Final = Commands[Doctor](Scope.ROS)
COMMANDS.viewer(ExamineSystem, lambda one, c, _: one.examine(c), limits=_OFTEN)
COMMANDS.viewer(GetDoctorReport, lambda one, c, _: one.report(c), limits=_SELDOM)

"""LessonRoom: who reads which lesson, how its checks stand, and who has done which step."""

from __future__ import annotations

import asyncio
import logging
from collections import defaultdict
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final, Protocol

from studio.classroom.members import now_s
from studio.course.lessons.checks import Concern
from studio.course.lessons.faults import faults_in
from studio.course.lessons.shelf import LESSONS_MAX
from studio.course.lessons.text import LessonText, read_lesson
from studio.documents.lessons.graphs import Graphs, Questions
from studio.documents.lessons.model_checks import model_verdict
from studio.documents.lessons.package_checks import package_verdict
from studio.documents.lessons.verdict import HOLDS, Verdict, missing
from studio.documents.lessons.views import check_views, lesson_view, step_view, tick_of
from studio.errors import StudioError
from studio.protocol import lessons as protocol
from studio.protocol.commands import Commands, Limits, Scope
from studio.protocol.lessons import (
    CheckView,
    CloseLesson,
    DeleteLesson,
    GetLessons,
    GetLessonTable,
    GetLessonText,
    LessonFault,
    LessonRead,
    LessonRow,
    Lessons,
    LessonState,
    LessonTable,
    LessonView,
    OpenLesson,
    ReadLesson,
    SaveLesson,
    SawPanel,
)
from studio.protocol.listeners import send
from studio.protocol.roles import owner_of

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Container, Hashable, Iterable, Mapping

    from studio.classroom.classroom import Classroom
    from studio.course.lessons.checks import Check
    from studio.course.lessons.shelf import Shelf
    from studio.documents.document import Document
    from studio.documents.lessons.package_checks import InspectedFolder
    from studio.live.connection.link import WireLink
    from studio.protocol.changes import Subject
    from studio.protocol.listeners import Listener

_LOOK_EVERY_S: Final = 0.5
_LINK_S: Final = 3.0
_NO_LINK: Final = missing("ros.none")
_WAITING: Final = missing("answer.waiting")
_PANELS_MAX: Final = 100
"""Panels that a page may have told of."""
_log = logging.getLogger(__name__)


class OpenDocuments(Protocol):
    """The engine."""

    def open_now(self, name: str) -> Document | None:
        """Return the document of that id if it is open; a resting copy is not woken."""
        ...


@dataclass(slots=True, eq=False)
class _Reader:
    """A page that has a lesson open."""

    page: Listener
    lesson: str
    text: LessonText
    document: str
    panels: set[str] = field(default_factory=set[str])
    ticks: dict[str, float] = field(default_factory=dict[str, float])
    """Of who only looks: nothing is kept of them."""
    sent: tuple[_Standing, tuple[float | None, ...]] | None = None
    link: WireLink | None = None
    owns_link: bool = False
    no_link: Verdict = _NO_LINK
    """Why there is none."""

    @property
    def asks_graph(self) -> bool:
        """Whether a check of the lesson is about the ROS system."""
        return any(one.concern is Concern.GRAPH for one in _checks_of(self.text))


@dataclass(frozen=True, slots=True, eq=False)
class _Standing:
    """How the checks of a lesson stand, for all who see the same."""

    text: LessonText
    """Held while its `id` names it among those that are looked at."""
    verdicts: dict[str, Verdict]
    checks: tuple[tuple[CheckView, ...], ...]
    """Of each step."""
    held: tuple[bool, ...]
    """Which steps are done if they were not before."""


class LessonRoom:
    """Looks at the checks of all lessons that somebody reads, once for all who see the same.

    Used on the event loop only.

    Args:
        shelf: Has the lessons.
        engine: Has the documents.
        classroom: Has the people, and keeps what they have done.
        link_of: Returns the ROS system of a person, and whether it is theirs alone.
        changed: Called with what changed: the list of lessons, or who reads and has done what.
        packages: Returns the opened folders of packages, as far as they were read.
    """

    def __init__(
        self,
        shelf: Shelf,
        engine: OpenDocuments,
        classroom: Classroom,
        link_of: Callable[[str], Awaitable[tuple[WireLink | None, bool]]],
        changed: Callable[[Subject], object],
        packages: Callable[[], Iterable[InspectedFolder]] = tuple,
    ) -> None:
        self._packages = packages
        self._shelf, self._engine, self._classroom = shelf, engine, classroom
        self._link_of, self._changed = link_of, changed
        self._readers: dict[Listener, _Reader] = {}
        self._opening: dict[Listener, object] = {}
        """What a page opens now; an older one that is found later counts no more."""
        self._graphs = Graphs()
        self._standings: dict[Hashable, _Standing] = {}
        """Of the last look."""
        self._looking: asyncio.Task[None] | None = None
        self._closed = False

    async def close(self) -> None:
        """Look at nothing more."""
        self._closed = True
        if self._looking is not None:
            self._looking.cancel()
            await asyncio.gather(self._looking, return_exceptions=True)
        await self._graphs.close()

    def detach(self, page: Listener) -> None:
        """Forget a page; it need not read."""
        self._opening.pop(page, None)
        if self._readers.pop(page, None):
            self._changed("ticks")

    # Texts

    async def lessons(self, command: GetLessons, asker: Listener) -> Lessons:
        """Return all lessons, with the asker's progress."""
        ticks = frozenset(self._kept_ticks(asker) or ())
        found = await asyncio.to_thread(self._views, ticks)
        return Lessons(request=command.request, lessons=tuple(found))

    def _views(self, ticks: Container[str]) -> list[LessonView]:
        """Return all lessons; in another thread, for it reads files."""
        found: list[LessonView] = []
        for lesson in self._shelf.lessons():
            try:
                found.append(lesson_view(lesson, lesson.read(), ticks))
            except StudioError as error:  # it went, or may not be read: the others are there
                _log.warning("%s", error)
        return found

    async def text(self, command: GetLessonText) -> protocol.LessonText:
        """Return the text of a lesson.

        Raises:
            LessonError: There is none, or it cannot be read.
        """
        lesson = await asyncio.to_thread(self._shelf.find, command.lesson)
        text = await asyncio.to_thread(lesson.text, command.language)
        return protocol.LessonText(request=command.request, text=text)

    async def save(self, command: SaveLesson) -> None:
        """Write a lesson; who reads it sees it at once.

        Raises:
            StudioError: Its name is taken, or the disk refuses it.
        """
        write = self._shelf.write
        lesson = await asyncio.to_thread(write, command.lesson, command.language, command.text)
        text = await asyncio.to_thread(lesson.read)
        for reader in self._readers.values():
            if reader.lesson == lesson.name:
                reader.text = text
        self._changed("lesson_list")

    async def delete(self, command: DeleteLesson) -> None:
        """Delete a lesson that was written in the page; errors as for `save`."""
        await asyncio.to_thread(self._shelf.delete, command.lesson)
        self._changed("lesson_list")

    async def read(self, command: ReadLesson) -> LessonRead:
        """Return what is faulty in a text, and its steps."""
        return await asyncio.to_thread(_read, command)

    # Reading

    async def open(self, command: OpenLesson, page: Listener) -> None:
        """Send a page how a lesson stands, from now on.

        Raises:
            LessonError: There is none, or it cannot be read.
        """
        this = self._opening[page] = object()
        try:
            lesson = await asyncio.to_thread(self._shelf.find, command.lesson)
            text = await asyncio.to_thread(lesson.read)
        finally:
            is_newest = self._opening.get(page) is this
            if is_newest:
                del self._opening[page]
        if not is_newest:  # another one was opened meanwhile, or none any more
            return
        before = self._readers.get(page)
        reader = _Reader(page, lesson.name, text, command.document)
        if before is not None and before.lesson == lesson.name:
            reader.panels, reader.ticks = before.panels, before.ticks
        self._readers[page] = reader
        self._changed("ticks")
        if self._looking is None or self._looking.done():
            self._looking = asyncio.create_task(self._keep_looking())

    def saw(self, command: SawPanel, page: Listener) -> None:
        """A panel was opened in a page that reads."""
        reader = self._readers.get(page)
        if reader is not None and len(reader.panels) < _PANELS_MAX:
            reader.panels.add(command.panel)

    async def _keep_looking(self) -> None:
        while self._readers and not self._closed:
            try:
                await self.look()
            except Exception:  # noqa: BLE001 - what fails once must not end it for all
                _log.exception("The checks of a lesson failed.")
            await asyncio.sleep(_LOOK_EVERY_S)
            if not self._readers:
                await self._graphs.close()

    async def look(self) -> None:
        """Look once at all that somebody reads, and tell them what changed."""
        readers = tuple(self._readers.values())
        await asyncio.gather(*(self._find_link(one) for one in readers if one.asks_graph))
        graphs = await self._graphs.look(self._questions(readers))
        standings: dict[Hashable, _Standing] = {}
        models: dict[tuple[str, str], Verdict] = {}
        has_new = False
        for reader in readers:
            if self._readers.get(reader.page) is not reader:
                continue
            group = self._group(reader)
            if group not in standings:
                verdicts = self._verdicts(reader, graphs, models)
                standings[group] = self._standing(group, reader.text, verdicts)
            has_new |= self._tell(reader, standings[group])
        self._standings = standings
        if has_new:
            self._changed("ticks")
            await self._classroom.keep_ticks()

    async def _find_link(self, reader: _Reader) -> None:
        try:
            async with asyncio.timeout(_LINK_S):
                reader.link, reader.owns_link = await self._link_of(reader.page.person)
            reader.no_link = _NO_LINK
        except TimeoutError:
            reader.link, reader.no_link = None, _WAITING
        except StudioError as error:
            reader.link, reader.no_link = None, missing("answer.failed", reason=error)
        except Exception:  # noqa: BLE001 - of one person: the others' lessons go on
            _log.exception("The ROS system of %s could not be found.", reader.page.person)
            reader.link, reader.no_link = None, _WAITING

    def _questions(self, readers: Iterable[_Reader]) -> dict[WireLink, Questions]:
        asked: dict[WireLink, Questions] = defaultdict(Questions)
        for reader in readers:
            if reader.link is None or not reader.asks_graph:
                continue
            checks = {
                one.line: one for one in _checks_of(reader.text) if one.concern is Concern.GRAPH
            }
            asked[reader.link].checks |= checks
            # It is theirs alone, or they have control of the class's.
            if reader.owns_link or self._classroom.has_control(reader.page):
                asked[reader.link].may_call |= checks.keys()
        return asked

    def _group(self, reader: _Reader) -> Hashable:
        """Return what is the same for all who see the same."""
        why = None if reader.link else (reader.no_link.code, *reader.no_link.found.values())
        document = self._document_of(reader)
        name = "" if document is None else document.id
        asked = {one.values.get("panel") for one in _checks_of(reader.text)}
        return id(reader.text), name, reader.link, why, frozenset(reader.panels & asked)

    def _document_of(self, reader: _Reader) -> Document | None:
        """Return what is checked: nothing that its page may not see, and no copy that rests."""
        is_seen = reader.page.sees(reader.document)
        return self._engine.open_now(reader.document) if is_seen else None

    def _standing(
        self, group: Hashable, text: LessonText, verdicts: dict[str, Verdict]
    ) -> _Standing:
        """Return how a lesson stands; the same as at the last look if nothing changed."""
        last = self._standings.get(group)
        if last is not None and last.verdicts == verdicts:
            return last
        return _Standing(
            text,
            verdicts,
            tuple(check_views(step, verdicts) for step in text.steps),
            tuple(
                bool(step.checks)
                and not step.faulty
                and all(verdicts[one.line].ok for one in step.checks)
                for step in text.steps
            ),
        )

    def _tell(self, reader: _Reader, standing: _Standing) -> bool:
        """Send a page how its lesson stands, if that changed; return whether a step is new."""
        ticks = self._ticks(reader)
        keys = [tick_of(reader.lesson, step) for step in reader.text.steps]
        new = [
            key
            for key, holds in zip(keys, standing.held, strict=True)
            if holds and key not in ticks
            if owner_of(reader.document) in {"", reader.page.person}  # what they did themselves
        ]
        ticks.update(dict.fromkeys(new, now_s()))
        done_s = tuple(map(ticks.get, keys))
        if reader.sent is None or reader.sent[0] is not standing or reader.sent[1] != done_s:
            reader.sent = standing, done_s
            steps = zip(reader.text.steps, standing.checks, done_s, strict=True)
            state = LessonState(
                lesson=reader.lesson, steps=tuple(step_view(*step) for step in steps)
            )
            send(reader.page, state)
        return bool(new)

    def _verdicts(
        self,
        reader: _Reader,
        graphs: Mapping[WireLink, dict[str, Verdict]],
        models: dict[tuple[str, str], Verdict],
    ) -> dict[str, Verdict]:
        graph = graphs.get(reader.link, {}) if reader.link else {}
        document = self._document_of(reader)
        found: dict[str, Verdict] = {}
        for one in _checks_of(reader.text):
            if one.concern is Concern.PAGE:
                is_seen = one.values["panel"] in reader.panels
                found[one.line] = HOLDS if is_seen else missing("opened.none")
            elif one.concern is Concern.GRAPH:
                found[one.line] = graph.get(one.line, reader.no_link)
            elif one.concern is Concern.PACKAGES:
                found[one.line] = package_verdict(one.values, self._packages())
            elif document is None:
                found[one.line] = missing("document.none")
            else:
                known = document.id, one.line
                if known not in models:
                    models[known] = model_verdict(one.kind, one.values, document)
                found[one.line] = models[known]
        return found

    # What is done

    def _ticks(self, reader: _Reader) -> dict[str, float]:
        kept = self._kept_ticks(reader.page)
        return reader.ticks if kept is None else kept

    def _kept_ticks(self, page: Listener) -> dict[str, float] | None:
        return self._classroom.ticks_of(page.person, page.role)

    async def table(self, command: GetLessonTable) -> LessonTable:
        """Return who has done which step.

        Raises:
            LessonError: There is no such lesson, or it cannot be read.
        """
        lesson = await asyncio.to_thread(self._shelf.find, command.lesson)
        steps = (await asyncio.to_thread(lesson.read)).steps
        keys = [tick_of(lesson.name, step) for step in steps]
        reading = {one.page.person for one in self._readers.values() if one.lesson == lesson.name}
        return LessonTable(
            request=command.request,
            lesson=lesson.name,
            steps=tuple(step_view(step) for step in steps),
            rows=tuple(
                LessonRow(
                    person=one.person,
                    name=one.name,
                    here=self._classroom.is_here(one.person),
                    reads=one.person in reading,
                    done_s=tuple(one.ticks.get(key) for key in keys),
                )
                for one in self._classroom.members
                if not one.removed
            ),
        )


def _read(command: ReadLesson) -> LessonRead:
    text = read_lesson(command.text)
    faults = faults_in(text, command.text)
    return LessonRead(
        request=command.request,
        faults=tuple(LessonFault(line=one.line, sentence=one.sentence) for one in faults),
        steps=tuple(step_view(step) for step in text.steps),
    )


def _checks_of(text: LessonText) -> Iterable[Check]:
    return (check for step in text.steps for check in step.checks)


_READ: Final = Limits(bytes_max=400_000, per_second=5)
_OFTEN: Final = Limits(bytes_max=1_000, per_second=10)
_TEXTS: Final = Limits(bytes_max=1_000, per_second=2 * LESSONS_MAX)
"""A page asks for all texts of a teacher's folders at once, in two tabs perhaps."""

COMMANDS: Final = Commands[LessonRoom](Scope.STUDIO)
COMMANDS.viewer(GetLessons, lambda room, c, who: room.lessons(c, who), limits=_OFTEN)
COMMANDS.viewer(GetLessonText, lambda room, c, _: room.text(c), limits=_TEXTS)
COMMANDS.viewer(OpenLesson, lambda room, c, who: room.open(c, who), limits=_OFTEN)
COMMANDS.viewer(CloseLesson, lambda room, _, who: room.detach(who), limits=_OFTEN)
COMMANDS.viewer(SawPanel, lambda room, c, who: room.saw(c, who), limits=_OFTEN)
COMMANDS.helper(GetLessonTable, lambda room, c, _: room.table(c), limits=_OFTEN)
COMMANDS.presenter(SaveLesson, lambda room, c, _: room.save(c), limits=_READ)
COMMANDS.presenter(DeleteLesson, lambda room, c, _: room.delete(c))
COMMANDS.presenter(ReadLesson, lambda room, c, _: room.read(c), limits=_READ)

"""LessonRoom: who reads which lesson, how its checks stand, and who has done which step."""

from __future__ import annotations

import asyncio
import logging
from collections import defaultdict
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final, Protocol

from studio.classroom.members import now_s
from studio.course.demos import LESSONS
from studio.course.lessons.checks import Concern
from studio.course.lessons.text import LessonText, read_lesson
from studio.documents.lessons.model_checks import model_verdict
from studio.documents.lessons.verdict import HOLDS, Verdict, missing
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
    StepView,
)
from studio.protocol.listeners import send

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Iterable

    from studio.classroom.classroom import Classroom
    from studio.course.lessons.checks import Check
    from studio.course.lessons.shelf import Lesson, Shelf
    from studio.course.lessons.text import Step
    from studio.documents.document import Document
    from studio.documents.lessons.graph_checks import GraphChecks
    from studio.live.connection.link import WireLink
    from studio.protocol.listeners import Listener

_LOOK_EVERY_S: Final = 0.5
_NOTHING: Final = missing("")
_NO_LINK: Final = missing("ros.none")
_PANELS_MAX: Final = 100
"""Panels that a page may have told of."""
_log = logging.getLogger(__name__)


class OpenDocuments(Protocol):
    """The engine."""

    def document(self, name: str) -> Document:
        """Return the open document of that id.

        Raises:
            StudioError: There is none.
        """
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
    sent: LessonState | None = None
    link: WireLink | None = None
    owns_link: bool = False
    no_link: Verdict = _NO_LINK
    """Why there is none."""


class LessonRoom:
    """Looks at the checks of all lessons that somebody reads, once for all who see the same.

    Used on the event loop only.

    Args:
        shelf: Has the lessons.
        engine: Has the documents.
        classroom: Has the people, and keeps what they have done.
        link_of: Returns the ROS system of a person, and whether it is theirs alone.
        changed: Called when somebody has done a step, or reads another lesson.
    """

    def __init__(
        self,
        shelf: Shelf,
        engine: OpenDocuments,
        classroom: Classroom,
        link_of: Callable[[str], Awaitable[tuple[WireLink | None, bool]]],
        changed: Callable[[], object],
    ) -> None:
        self._shelf, self._engine, self._classroom = shelf, engine, classroom
        self._link_of, self._changed = link_of, changed
        self._readers: dict[Listener, _Reader] = {}
        self._graphs: dict[WireLink, GraphChecks] = {}
        self._looking: asyncio.Task[None] | None = None
        self._closed = False

    async def close(self) -> None:
        """Look at nothing more."""
        self._closed = True
        if self._looking is not None:
            self._looking.cancel()
            await asyncio.gather(self._looking, return_exceptions=True)
        await self._let_go(set())

    def detach(self, page: Listener) -> None:
        """Forget a page; it need not read."""
        if self._readers.pop(page, None):
            self._changed()

    # Texts

    async def lessons(self, command: GetLessons, asker: Listener) -> Lessons:
        """Return all lessons, with the asker's progress."""
        found = await asyncio.to_thread(self._read_all)
        ticks = self._kept_ticks(asker) or {}
        return Lessons(
            request=command.request,
            lessons=tuple(_view(lesson, text, ticks) for lesson, text in found),
        )

    def _read_all(self) -> list[tuple[Lesson, LessonText]]:
        found: list[tuple[Lesson, LessonText]] = []
        for lesson in self._shelf.lessons():
            try:
                found.append((lesson, lesson.read()))
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
        self._changed()

    async def delete(self, command: DeleteLesson) -> None:
        """Delete a lesson that was written in the page; errors as for `save`."""
        await asyncio.to_thread(self._shelf.delete, command.lesson)
        self._changed()

    def read(self, command: ReadLesson) -> LessonRead:
        """Return what is faulty in a text, and its steps."""
        text = read_lesson(command.text)
        return LessonRead(
            request=command.request,
            faults=tuple(LessonFault(line=one.line, sentence=one.sentence) for one in text.faults),
            steps=tuple(_step_view(step, {}, None) for step in text.steps),
        )

    # Reading

    async def open(self, command: OpenLesson, page: Listener) -> None:
        """Send a page how a lesson stands, from now on.

        Raises:
            LessonError: There is none, or it cannot be read.
        """
        lesson = await asyncio.to_thread(self._shelf.find, command.lesson)
        text = await asyncio.to_thread(lesson.read)
        before = self._readers.get(page)
        reader = _Reader(page, lesson.name, text, command.document)
        if before is not None and before.lesson == lesson.name:
            reader.panels, reader.ticks = before.panels, before.ticks
        self._readers[page] = reader
        self._changed()
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
        await self._let_go(set())

    async def look(self) -> None:
        """Look once at all that somebody reads, and tell them what changed."""
        readers = tuple(self._readers.values())
        await asyncio.gather(*map(self._find_link, readers))
        graph = await self._look_at_graphs(readers)
        models: dict[tuple[str, str], Verdict] = {}
        has_new = False
        for reader in readers:
            if self._readers.get(reader.page) is reader:
                has_new |= self._tell(reader, graph.get(reader.link, {}), models)
        if has_new:
            self._changed()
            await self._classroom.keep_ticks()

    async def _find_link(self, reader: _Reader) -> None:
        try:
            reader.link, reader.owns_link = await self._link_of(reader.page.person)
            reader.no_link = _NO_LINK
        except StudioError as error:
            reader.link, reader.no_link = None, missing("answer.failed", reason=error)

    async def _look_at_graphs(
        self, readers: Iterable[_Reader]
    ) -> dict[WireLink | None, dict[str, Verdict]]:
        """Return how the checks of the graph stand, by system and line."""
        wanted: dict[WireLink, dict[str, Check]] = defaultdict(dict)
        callers: set[WireLink] = set()
        for reader in readers:
            checks = [one for one in _checks_of(reader.text) if one.concern is Concern.GRAPH]
            if reader.link is not None and checks:
                wanted[reader.link] |= {one.line: one for one in checks}
                if self._may_call(reader):
                    callers.add(reader.link)
        await self._let_go(set(wanted))
        found: dict[WireLink | None, dict[str, Verdict]] = {}
        for link, checks in wanted.items():
            looking = self._graphs.get(link) or self._graphs.setdefault(link, _graph_checks(link))
            try:
                found[link] = await looking.verdicts(checks.values(), may_call=link in callers)
            except StudioError as error:  # the connection ended meanwhile
                found[link] = dict.fromkeys(checks, missing("answer.failed", reason=error))
        return found

    def _may_call(self, reader: _Reader) -> bool:
        """Whether a service may be called for a reader: it is theirs, or they have control."""
        return reader.owns_link or self._classroom.has_control(reader.page)

    async def _let_go(self, kept: set[WireLink]) -> None:
        for link in self._graphs.keys() - kept:
            await self._graphs.pop(link).close()

    def _tell(
        self, reader: _Reader, graph: dict[str, Verdict], models: dict[tuple[str, str], Verdict]
    ) -> bool:
        """Send a page how its lesson stands, if that changed; return whether a step is new."""
        verdicts = {
            one.line: self._verdict(one, reader, graph, models) for one in _checks_of(reader.text)
        }
        ticks = self._ticks(reader)
        new = [
            key
            for step in reader.text.steps
            if step.checks and (key := _key(reader.lesson, step)) not in ticks
            if all(verdicts[one.line].ok for one in step.checks)
        ]
        ticks.update(dict.fromkeys(new, now_s()))
        state = LessonState(
            lesson=reader.lesson,
            steps=tuple(
                _step_view(step, verdicts, ticks.get(_key(reader.lesson, step)))
                for step in reader.text.steps
            ),
        )
        if state != reader.sent:
            reader.sent = state
            send(reader.page, state)
        return bool(new)

    def _verdict(
        self,
        check: Check,
        reader: _Reader,
        graph: dict[str, Verdict],
        models: dict[tuple[str, str], Verdict],
    ) -> Verdict:
        if check.concern is Concern.PAGE:
            return HOLDS if check.values["panel"] in reader.panels else missing("opened.none")
        if check.concern is Concern.GRAPH:
            return graph.get(check.line) or reader.no_link
        known = reader.document, check.line
        if known not in models:
            models[known] = self._of_model(check, reader.document)
        return models[known]

    def _of_model(self, check: Check, name: str) -> Verdict:
        try:
            document = self._engine.document(name)
        except StudioError:
            return missing("document.none")
        return model_verdict(check.kind, check.values, document)

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
        keys = [_key(lesson.name, step) for step in steps]
        reading = {one.page.person for one in self._readers.values() if one.lesson == lesson.name}
        return LessonTable(
            request=command.request,
            lesson=lesson.name,
            steps=tuple(_step_view(step, {}, None) for step in steps),
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


def _graph_checks(link: WireLink) -> GraphChecks:
    from studio.documents.lessons.graph_checks import GraphChecks  # noqa: PLC0415 - imports zenoh

    return GraphChecks(link)


def _checks_of(text: LessonText) -> Iterable[Check]:
    return (check for step in text.steps for check in step.checks)


def _key(lesson: str, step: Step) -> str:
    return f"{lesson}/{step.id}"


def _step_view(step: Step, verdicts: dict[str, Verdict], done_s: float | None) -> StepView:
    return StepView(
        id=step.id,
        heading=step.heading,
        done_s=done_s,
        checks=tuple(_check_view(one, verdicts.get(one.line, _NOTHING)) for one in step.checks),
    )


def _check_view(check: Check, verdict: Verdict) -> CheckView:
    return CheckView(
        kind=check.kind,
        line=check.line,
        values=dict(check.values),
        ok=verdict.ok,
        code=verdict.code,
        found=verdict.found,
    )


def _view(lesson: Lesson, text: LessonText, ticks: dict[str, float]) -> LessonView:
    demo = LESSONS.get(lesson.name)
    return LessonView(
        name=lesson.name,
        chapter=lesson.chapter,
        node=demo.node if demo and not lesson.own else "",
        has_keys=bool(demo and demo.has_keys and not lesson.own),
        own=lesson.own,
        writable=lesson.writable,
        steps=len(text.steps),
        done=sum(_key(lesson.name, step) in ticks for step in text.steps),
    )


_READ: Final = Limits(bytes_max=400_000, per_second=5)
_OFTEN: Final = Limits(bytes_max=1_000, per_second=10)

COMMANDS: Final = Commands[LessonRoom](Scope.STUDIO)
COMMANDS.viewer(GetLessons, lambda room, c, who: room.lessons(c, who), limits=_OFTEN)
COMMANDS.viewer(GetLessonText, lambda room, c, _: room.text(c))
COMMANDS.viewer(OpenLesson, lambda room, c, who: room.open(c, who), limits=_OFTEN)
COMMANDS.viewer(CloseLesson, lambda room, _, who: room.detach(who), limits=_OFTEN)
COMMANDS.viewer(SawPanel, lambda room, c, who: room.saw(c, who), limits=_OFTEN)
COMMANDS.helper(GetLessonTable, lambda room, c, _: room.table(c), limits=_OFTEN)
COMMANDS.presenter(SaveLesson, lambda room, c, _: room.save(c), limits=_READ)
COMMANDS.presenter(DeleteLesson, lambda room, c, _: room.delete(c))
COMMANDS.presenter(ReadLesson, lambda room, c, _: room.read(c), limits=_READ)

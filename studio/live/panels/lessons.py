"""LessonDesk: starts and ends the demos from pages, and tells which of them run."""

from __future__ import annotations

import asyncio
import itertools
from typing import TYPE_CHECKING, Final

from studio.errors import CommandError
from studio.live.panels.demo_run import DemoRun
from studio.nodes.demos.chapters import CHAPTERS, LESSONS, Lesson
from studio.nodes.demos.code import code_of
from studio.nodes.demos.starting import environment_for
from studio.protocol.commands import Commands, Scope
from studio.protocol.lessons import (
    CodeFile,
    DemoCode,
    DemoOutput,
    Demos,
    GetDemoCode,
    GetDemoOutput,
    GetDemos,
    GetLessons,
    Lessons,
    LessonView,
    PressKey,
    StartDemo,
    StopDemo,
)

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.live.connection.desk import WireDesk
    from studio.live.connection.link import WireLink

RUNNING_MAX: Final = 10
"""Each is a process of some 80 MB."""


class LessonDesk:
    """Of the loop; what is started meets the studio's connection, and ends with it."""

    def __init__(self, wire: WireDesk) -> None:
        self._wire = wire
        self._runs: dict[str, DemoRun] = {}
        """The last run of each demo."""
        self._numbers = itertools.count(1)
        self._sessions = _Sessions()
        self._closed = False

    def lessons(self, command: GetLessons) -> Lessons:
        """Tell which demos there are, in the order in which they are taught."""
        return Lessons(
            request=command.request,
            lessons=tuple(
                LessonView(demo=one.demo, chapter=chapter, node=one.node, has_keys=one.has_keys)
                for chapter, lessons in CHAPTERS.items()
                for one in lessons
            ),
        )

    async def demos(self, command: GetDemos) -> Demos:
        """Tell which demos run, those of others too."""
        elsewhere = await self._look()
        return Demos(
            request=command.request,
            demos=tuple(run.view() for run in self._runs.values()),
            elsewhere=elsewhere,
        )

    def output(self, command: GetDemoOutput) -> DemoOutput:
        """Tell what a demo printed after what is known; nothing of one that was never started."""
        run = self._runs.get(_lesson(command.demo).demo)
        if run is None:
            return DemoOutput(request=command.request, run=0, lines=(), last=0)
        lines, last = run.printed.after(command.after if command.run == run.number else 0)
        return DemoOutput(request=command.request, run=run.number, lines=lines, last=last)

    async def code(self, command: GetDemoCode) -> DemoCode:
        """Give the source code of a demo.

        Raises:
            CommandError: It is none.
        """
        found = await asyncio.to_thread(code_of, _lesson(command.demo).demo)
        files = tuple(CodeFile(name=name, text=text) for name, text in found.items())
        return DemoCode(request=command.request, files=files)

    async def start(self, command: StartDemo) -> None:
        """Start a demo.

        Raises:
            CommandError: It is none, or runs already, or too many do, or there is no connection.
        """
        lesson = _lesson(command.demo)
        strangers = await self._look()
        link = self._connected()
        if lesson.demo in strangers:
            raise CommandError(
                f"A node {lesson.node} is there already, which was not started from here: "
                "end it where it was started, for two of one name are taken for one."
            )
        self._demand_room(lesson)
        run = self._runs[lesson.demo] = DemoRun(lesson, next(self._numbers))
        await run.start(environment_for(link.settings))

    async def stop(self, command: StopDemo) -> None:
        """End a demo, and return when it has ended.

        Raises:
            CommandError: It does not run, or was not started from a page.
        """
        await self._under_way(command.demo).stop()

    def press(self, command: PressKey) -> None:
        """Press a key of a demo; errors as for `stop`."""
        run = self._under_way(command.demo)
        if not run.lesson.has_keys:
            raise CommandError(f"{command.demo} is not driven by keys.")
        run.press(command.pressed)

    async def let_go(self) -> None:
        """End all: the connection that they share is about to."""
        await asyncio.gather(*(run.stop() for run in self._runs.values()))

    async def close(self) -> None:
        """End all, and start none any more."""
        self._closed = True
        await self.let_go()

    def _connected(self) -> WireLink:
        link = self._wire.current
        if self._closed or link is None:
            raise CommandError("Not connected with ROS 2: connect first.")
        if not link.is_connected:
            raise CommandError(
                f"The router at {link.endpoint} is gone: a demo would meet nobody until it is back."
            )
        return link

    def _demand_room(self, lesson: Lesson) -> None:
        under_way = [name for name, run in self._runs.items() if not run.is_over]
        if lesson.demo in under_way:
            raise CommandError(f"{lesson.demo} runs already.")
        if len(under_way) >= RUNNING_MAX:
            raise CommandError(f"{RUNNING_MAX} demos run already: stop one of them first.")

    def _under_way(self, name: str) -> DemoRun:
        run = self._runs.get(_lesson(name).demo)
        if run is None or run.is_over:
            raise CommandError(f"{name} does not run, or was not started from a page.")
        return run

    async def _look(self) -> tuple[str, ...]:
        """See whose nodes are there; gives the demos that others started."""
        link = self._wire.current
        there = await self._sessions.by_node(link) if link else {}
        for run in self._runs.values():
            run.see(there.get(run.lesson.node, frozenset()))
        return tuple(demo for demo in LESSONS if self._strangers(demo, there))

    def _strangers(self, demo: str, there: Mapping[str, frozenset[str]]) -> frozenset[str]:
        run = self._runs.get(demo)
        return there.get(LESSONS[demo].node, frozenset()) - (run.zids if run else frozenset())


def _lesson(name: str) -> Lesson:
    found = LESSONS.get(name)
    if found is None:
        raise CommandError(f"No demo is called {name[:100]}: the list in Lessons has them all.")
    return found


class _Sessions:
    """Sessions that nodes are of, by their full names; looked up anew when the graph changed."""

    def __init__(self) -> None:
        self._of: tuple[str, int] | None = None
        self._by_node: dict[str, frozenset[str]] = {}

    async def by_node(self, link: WireLink) -> dict[str, frozenset[str]]:
        """Tell them for a connection."""
        now = link.zid, link.graph.version
        if now != self._of:
            # Of thousands of nodes it takes its time.
            self._by_node = await asyncio.to_thread(_sessions_by_node, link)
            self._of = now
        return self._by_node


def _sessions_by_node(link: WireLink) -> dict[str, frozenset[str]]:
    found: dict[str, set[str]] = {}
    for node in link.graph.nodes():
        found.setdefault(node.path, set()).add(node.zid)
    return {path: frozenset(zids) for path, zids in found.items()}


COMMANDS: Final = Commands[LessonDesk](Scope.ROS)
COMMANDS.viewer(GetLessons, lambda one, c, _: one.lessons(c))
COMMANDS.viewer(GetDemos, lambda one, c, _: one.demos(c))
COMMANDS.viewer(GetDemoOutput, lambda one, c, _: one.output(c))
COMMANDS.viewer(GetDemoCode, lambda one, c, _: one.code(c))
COMMANDS.presenter(StartDemo, lambda one, c, _: one.start(c))
COMMANDS.presenter(StopDemo, lambda one, c, _: one.stop(c))
COMMANDS.presenter(PressKey, lambda one, c, _: one.press(c))

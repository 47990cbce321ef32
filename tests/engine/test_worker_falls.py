"""A worker process that is killed, at whatever moment: its robot comes back, nobody is told."""

from __future__ import annotations

import asyncio
import os
import signal
import sys
from contextlib import asynccontextmanager, suppress
from typing import TYPE_CHECKING

import pytest

from studio.description.client import DescriptionWorker
from studio.description.editing.sources import Sources
from studio.description.origins.origin_values import PartOrigin, PartOriginQuery
from studio.description.values import Edit, Expansion
from studio.engine.edit_loop import EditLoop, Target
from studio.packages.roots import ServedRoots
from tests.support.descriptions import policy_for, robot, write
from tests.support.open_documents import until

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator, Awaitable, Callable
    from pathlib import Path

    from studio.description.session import Answer
    from studio.engine.edit_loop import Outcome

pytestmark = [
    pytest.mark.timeout(60),
    pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGKILL"),
]

SOURCE = robot(
    '<xacro:arg name="side" default="left"/><xacro:property name="m" value="1"/>'
    '<link name="$(arg side)"><inertial><mass value="${m * 2}"/></inertial></link>'
)
AT = SOURCE.index('"1"') + 1
QUESTION = PartOriginQuery("link:left")


class Story:
    """A loop over one open robot, and what came of its runs."""

    def __init__(self, file: Path, worker: DescriptionWorker) -> None:
        roots = ServedRoots([file.parent])
        self.file = file
        self.outcomes: list[Outcome] = []
        self.sources = Sources(roots.read, roots.resolve, lambda _: True, {})
        self.loop = EditLoop(
            worker,
            self.sources,
            Target(str(file), policy_for(file.parent)),
            lambda one, _: self.outcomes.append(one),
        )

    @property
    def pid(self) -> int:
        """Of the worker's process."""
        assert self.loop.worker_pid is not None
        return self.loop.worker_pid

    async def edit(self, digit: str = "7") -> None:
        """Write another number, as a slider does."""
        edit = Edit(str(self.file), AT, AT + 1, digit.encode())
        self.sources.edit(edit, "m")
        await self.loop.edit((edit,))

    async def pass_argument(self) -> None:
        """Run with another argument."""
        self.sources.set_argument("side", "left")
        await self.loop.arguments_changed()

    async def reload(self) -> None:
        """Run with the file read anew."""
        await self.loop.reload((str(self.file),))

    async def ask(self) -> None:
        """Ask, and be answered."""
        assert isinstance(await self.loop.ask(QUESTION), PartOrigin)

    async def fall(self) -> None:
        """Kill the process, and wait until that was noticed."""
        pid = self.pid
        os.kill(pid, signal.SIGKILL)
        await until(lambda: not _is_there(pid))

    def check(self, mass: str) -> None:
        """Every run gave a robot, the last one with this mass."""
        assert all(isinstance(one, Expansion) for one in self.outcomes)
        written = [
            part.xml
            for one in self.outcomes
            if isinstance(one, Expansion)
            for part in one.changed_parts
        ]
        assert f'value="{mass}"' in written[-1]


def _is_there(pid: int) -> bool:
    with suppress(ProcessLookupError):
        os.kill(pid, 0)
        return True
    return False


@asynccontextmanager
async def opened(folder: Path, worker: DescriptionWorker | None = None) -> AsyncGenerator[Story]:
    """A story whose robot is open."""
    file = write(folder, {"a.xacro": SOURCE})
    story = Story(file, worker or DescriptionWorker())
    try:
        await story.loop.reopen()
        yield story
    finally:
        await story.loop.close()


WAYS: list[Callable[[Story], Awaitable[None]]] = [
    Story.edit,
    Story.pass_argument,
    Story.reload,
    Story.ask,
]


@pytest.mark.parametrize("way", WAYS)
def test_after_a_fall_that_nobody_saw_everything_goes_on(
    tmp_path: Path, way: Callable[[Story], Awaitable[None]]
):
    async def run() -> None:
        async with opened(tmp_path) as story:
            await story.edit("6")
            await story.fall()
            await way(story)
            await story.ask()
            await story.edit("8")
            story.check("16")

    asyncio.run(run())


@pytest.mark.parametrize("way", WAYS)
def test_a_process_that_falls_in_the_midst_of_what_it_was_asked_is_asked_again(
    tmp_path: Path, way: Callable[[Story], Awaitable[None]]
):
    async def run() -> None:
        async with opened(tmp_path) as story:
            os.kill(story.pid, signal.SIGSTOP)  # it cannot answer before it falls
            waiting = asyncio.ensure_future(way(story))
            await asyncio.sleep(0.05)
            await story.fall()
            await waiting
            await story.edit("8")
            story.check("16")

    asyncio.run(run())


def test_edits_made_while_a_process_falls_are_made_once(tmp_path: Path):
    async def run() -> None:
        async with opened(tmp_path) as story:
            os.kill(story.pid, signal.SIGSTOP)
            first = asyncio.ensure_future(story.edit("7"))
            await asyncio.sleep(0.05)
            edit = Edit(str(story.file), AT, AT, b"1")
            story.sources.edit(edit, "m")
            second = asyncio.ensure_future(story.loop.edit((edit,)))
            await story.fall()
            await asyncio.gather(first, second)
            story.check("34")

    asyncio.run(run())


def test_an_edit_behind_a_question_whose_process_falls_is_made(tmp_path: Path):
    async def run() -> None:
        async with opened(tmp_path) as story:
            os.kill(story.pid, signal.SIGSTOP)
            asking = asyncio.ensure_future(story.ask())
            await asyncio.sleep(0.05)
            editing = asyncio.ensure_future(story.edit("7"))
            await asyncio.sleep(0.05)
            await story.fall()
            await asyncio.gather(asking, editing)
            story.check("14")

    asyncio.run(run())


def test_a_process_that_falls_while_it_opens_is_followed_by_another(tmp_path: Path):
    async def run() -> None:
        async with opened(tmp_path) as story:
            os.kill(story.pid, signal.SIGSTOP)
            opening = asyncio.ensure_future(story.loop.reopen())
            await asyncio.sleep(0.05)
            await story.fall()
            await opening
            await story.edit("8")
            story.check("16")

    asyncio.run(run())


class FallingWorker(DescriptionWorker):
    """Falls as soon as it looks at what edits patched."""

    fell = False

    async def verify(self) -> Answer:
        assert self.pid is not None
        if not self.fell:
            self.fell = True
            os.kill(self.pid, signal.SIGKILL)
        return await super().verify()


def test_a_process_that_falls_while_it_checks_patches_is_opened_again(tmp_path: Path):
    async def run() -> None:
        worker = FallingWorker()
        async with opened(tmp_path, worker) as story:
            await story.edit("7")
            await until(lambda: len(story.outcomes) == 3)
            assert worker.fell
            await story.edit("8")
            story.check("16")

    asyncio.run(run())


def test_nothing_is_started_once_the_loop_is_closed(tmp_path: Path):
    async def run() -> None:
        async with opened(tmp_path) as story:
            await story.loop.close()
            with pytest.raises(asyncio.CancelledError):
                await story.loop.reopen()
            assert story.loop.worker_pid is None

    asyncio.run(run())

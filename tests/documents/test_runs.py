"""One run at a time, never without a robot; a worker that is killed gets its own again unseen."""

from __future__ import annotations

import asyncio
import gc
import os
import signal
import sys
from typing import TYPE_CHECKING

import pytest

from studio.description.client import DescriptionWorker
from studio.description.editing.sources import Sources
from studio.description.origins.origin_values import PartOrigin, PartOriginQuery
from studio.description.values import Edit, Expansion, NoReply
from studio.documents.runs import Runs
from studio.packages.roots import ServedRoots
from tests.support.descriptions import robot, write
from tests.support.loop_story import AT, ORIGIN, LoopStory, NotedWorker, loop_story, target_for
from tests.support.open_documents import Ear, until

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable
    from pathlib import Path

    from studio.description.session import Answer
    from studio.documents.runs import Outcome

kills_processes = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGSTOP")


def loop_over(file: Path, outcomes: list[Outcome], worker: DescriptionWorker | None = None) -> Runs:
    roots = ServedRoots([file.parent])
    sources = Sources(roots.read, roots.resolve, lambda _: True, {})
    target = target_for(file)
    worker = worker or DescriptionWorker()
    return Runs(worker, sources, target, lambda one, _: outcomes.append(one))


class CheckedWorker(DescriptionWorker):
    """A worker that tells when it has looked at what edits patched."""

    def __init__(self) -> None:
        super().__init__()
        self.answers: asyncio.Queue[Outcome] = asyncio.Queue()

    async def verify(self) -> Outcome:
        answer = await super().verify()
        self.answers.put_nowait(answer)
        return answer


def test_a_question_asked_while_the_robot_opens_costs_no_second_run(tmp_path: Path):
    file = write(tmp_path, {"a.xacro": robot('<link name="a"/>')})

    async def run() -> None:
        outcomes: list[Outcome] = []
        loop = loop_over(file, outcomes)
        try:
            opening = asyncio.create_task(loop.reopen())
            await asyncio.sleep(0)
            assert isinstance(await loop.ask(PartOriginQuery("link:a"), Ear()), PartOrigin)
            await opening
            assert [type(one) for one in outcomes] == [Expansion]
        finally:
            await loop.close()

    asyncio.run(run())


def test_after_a_quiet_moment_patches_are_looked_at_once_and_nothing_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    # On a busy machine edits come so late that the moment would lie between them.
    monkeypatch.setattr("studio.documents.runs.CHECK_AFTER_S", 2.0)
    source = robot('<xacro:property name="m" value="1"/><link name="a"/><m v="${m * 2}"/>')
    file = write(tmp_path, {"a.xacro": source})
    start = source.index('"1"') + 1

    async def run() -> None:
        outcomes: list[Outcome] = []
        worker = CheckedWorker()
        loop = loop_over(file, outcomes, worker)
        try:
            await loop.reopen()
            for digit in b"234":
                await loop.edit((Edit(str(file), start, start + 1, bytes([digit])),))
            assert worker.answers.empty()
            checked = await worker.answers.get()
            assert isinstance(checked, Expansion)
            assert checked.is_patch
            await loop.edit((Edit(str(file), start, start + 1, b"5"),))
            assert worker.answers.empty()
            assert len(outcomes) == 5
            patches = [one for one in outcomes if isinstance(one, Expansion) and one.is_patch]
            assert len(patches) == 4
        finally:
            await loop.close()

    asyncio.run(run())


def test_what_edits_leave_is_collected_when_they_are_checked_and_nobody_waits(tmp_path: Path):
    source = robot('<xacro:property name="m" value="1"/><link name="a"/><m v="${m * 2}"/>')
    file = write(tmp_path, {"a.xacro": source})
    start = source.index('"1"') + 1
    collected: list[int] = []

    def note(phase: str, info: dict[str, int]) -> None:
        if phase == "stop":
            collected.append(info["generation"])

    async def run() -> None:
        loop = loop_over(file, [])
        try:
            await loop.reopen()
            gc.callbacks.append(note)
            await loop.edit((Edit(str(file), start, start + 1, b"2"),))
            await until(lambda: bool(collected))
            assert collected == [1]
        finally:
            await loop.close()

    gc.disable()
    try:
        asyncio.run(run())
    finally:
        gc.callbacks.remove(note)
        gc.enable()


WAYS: list[Callable[[LoopStory], Awaitable[None]]] = [
    LoopStory.edit,
    LoopStory.pass_argument,
    LoopStory.reload,
    LoopStory.ask,
]


@kills_processes
@pytest.mark.parametrize("way", WAYS)
def test_after_a_fall_that_nobody_saw_everything_goes_on(
    tmp_path: Path, way: Callable[[LoopStory], Awaitable[None]]
):
    async def run() -> None:
        async with loop_story(tmp_path) as story:
            await story.edit("6")
            await story.fall()
            await way(story)
            await story.ask()
            await story.edit("8")
            story.check("16")

    asyncio.run(run())


@kills_processes
@pytest.mark.parametrize("way", WAYS)
def test_a_process_that_falls_in_the_midst_of_what_it_was_asked_is_asked_again(
    tmp_path: Path, way: Callable[[LoopStory], Awaitable[None]]
):
    async def run() -> None:
        async with loop_story(tmp_path) as story:
            story.stop()  # it cannot answer before it falls
            waiting = asyncio.ensure_future(way(story))
            await story.until_asked()
            await story.fall()
            await waiting
            await story.edit("8")
            story.check("16")

    asyncio.run(run())


@kills_processes
def test_edits_made_while_a_process_falls_are_made_once(tmp_path: Path):
    async def run() -> None:
        async with loop_story(tmp_path) as story:
            story.stop()
            first = asyncio.ensure_future(story.edit("7"))
            await story.until_asked()
            edit = Edit(str(story.file), AT, AT, b"1")
            second = asyncio.ensure_future(story.splice(edit))
            await story.fall()
            await asyncio.gather(first, second)
            story.check("34")

    asyncio.run(run())


@kills_processes
def test_an_edit_behind_a_question_whose_process_falls_is_made(tmp_path: Path):
    async def run() -> None:
        async with loop_story(tmp_path) as story:
            story.stop()
            asking = asyncio.ensure_future(story.ask())
            await story.until_asked()
            editing = asyncio.ensure_future(story.edit("7"))
            await asyncio.sleep(0)
            await story.fall()
            await asyncio.gather(asking, editing)
            story.check("14")

    asyncio.run(run())


@kills_processes
def test_an_edit_behind_a_question_that_took_too_long_is_made(tmp_path: Path):
    async def run() -> None:
        async with loop_story(tmp_path, NotedWorker(timeout_s=3.0)) as story:
            story.stop()
            asking = story.asked(ORIGIN)
            await story.until_asked()
            await story.edit("7")
            assert isinstance(await asking, NoReply)
            story.check("14")

    asyncio.run(run())


@kills_processes
def test_a_process_that_falls_while_it_opens_is_followed_by_another(tmp_path: Path):
    async def run() -> None:
        async with loop_story(tmp_path) as story:
            story.stop()
            opening = asyncio.ensure_future(story.loop.reopen())
            await story.until_asked()
            await story.fall()
            await opening
            await story.edit("8")
            story.check("16")

    asyncio.run(run())


class FallingWorker(NotedWorker):
    """Falls as soon as it looks at what edits patched."""

    fell = False

    async def verify(self) -> Answer:
        assert self.pid is not None
        if not self.fell:
            self.fell = True
            os.kill(self.pid, signal.SIGKILL)
        return await super().verify()


@kills_processes
def test_a_process_that_falls_while_it_checks_patches_is_opened_again(tmp_path: Path):
    async def run() -> None:
        worker = FallingWorker()
        async with loop_story(tmp_path, worker) as story:
            await story.edit("7")
            await until(lambda: len(story.outcomes) == 3)
            assert worker.fell
            await story.edit("8")
            story.check("16")

    asyncio.run(run())


@kills_processes
def test_nothing_is_started_once_the_loop_is_closed(tmp_path: Path):
    async def run() -> None:
        async with loop_story(tmp_path) as story:
            await story.loop.close()
            with pytest.raises(asyncio.CancelledError):
                await story.loop.reopen()
            assert story.loop.worker_pid is None

    asyncio.run(run())

"""Questions through the loop: behind the run under way, and never without a robot to ask about."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from studio.description.client import DescriptionWorker
from studio.description.editing.sources import Sources
from studio.description.origins.origin_values import PartOrigin, PartOriginQuery
from studio.description.values import Edit, Expansion
from studio.engine.edit_loop import EditLoop, Target
from studio.packages.roots import ServedRoots
from tests.support.descriptions import policy_for, robot, write

if TYPE_CHECKING:
    from pathlib import Path

    from studio.engine.edit_loop import Outcome

pytestmark = pytest.mark.timeout(60)


def loop_over(
    file: Path, outcomes: list[Outcome], worker: DescriptionWorker | None = None
) -> EditLoop:
    roots = ServedRoots([file.parent])
    sources = Sources(roots.read, roots.resolve, lambda _: True, {})
    target = Target(str(file), policy_for(file.parent))
    worker = worker or DescriptionWorker()
    return EditLoop(worker, sources, target, lambda one, _: outcomes.append(one))


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
            assert isinstance(await loop.ask(PartOriginQuery("link:a")), PartOrigin)
            await opening
            assert [type(one) for one in outcomes] == [Expansion]
        finally:
            await loop.close()

    asyncio.run(run())


def test_after_a_quiet_moment_patches_are_looked_at_once_and_nothing_is_told(tmp_path: Path):
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

"""Questions through the loop: behind the run under way, and never without a robot to ask about."""

from __future__ import annotations

import asyncio
import os
import signal
import sys
from typing import TYPE_CHECKING

import pytest

from studio.description.client import DescriptionWorker
from studio.description.queries import PartOrigin, PartOriginQuery
from studio.description.sources import Sources
from studio.description.values import Expansion
from studio.engine.edit_loop import EditLoop, Target
from studio.packages.roots import ServedRoots
from tests.support.descriptions import policy_for, robot, write

if TYPE_CHECKING:
    from pathlib import Path

    from studio.engine.edit_loop import Outcome

pytestmark = pytest.mark.timeout(60)


def loop_over(file: Path, outcomes: list[Outcome]) -> EditLoop:
    roots = ServedRoots([file.parent])
    sources = Sources(roots.read, roots.resolve, lambda _: True, {})
    target = Target(str(file), policy_for(file.parent))
    return EditLoop(DescriptionWorker(), sources, target, lambda one, _: outcomes.append(one))


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


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGKILL")
def test_a_question_after_a_fall_opens_the_robot_again(tmp_path: Path):
    file = write(tmp_path, {"a.xacro": robot('<link name="a"/>')})

    async def run() -> None:
        outcomes: list[Outcome] = []
        loop = loop_over(file, outcomes)
        try:
            await loop.reopen()
            assert loop.worker_pid is not None
            os.kill(loop.worker_pid, signal.SIGKILL)
            await loop.ask(PartOriginQuery("link:a"))
            assert isinstance(await loop.ask(PartOriginQuery("link:a")), PartOrigin)
        finally:
            await loop.close()

    asyncio.run(run())

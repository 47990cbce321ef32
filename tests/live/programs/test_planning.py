"""Plans of launch files, asked as a page asks."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from studio.errors import CommandError, NotRunnableError
from studio.protocol.launch_plans import CancelPlan, PlanLaunch
from tests.support.run_studio import run_studio, workspace

if TYPE_CHECKING:
    from pathlib import Path


def test_a_plan_has_arguments_and_nodes_and_follows_what_is_given(tmp_path: Path):
    async def run() -> None:
        ws = workspace(tmp_path / "ws")
        file = str(ws / "src/talk/launch/hall.launch.py")
        async with run_studio(tmp_path / "data", ws) as studio:
            plan = (await studio.ask(PlanLaunch(file=file)))["plan"]
            assert [one["name"] for one in plan["arguments"]] == ["name", "loud"]
            assert plan["arguments"][0]["choices"] == ["one", "two"]
            first, second = plan["nodes"]
            assert first["full_name"] == "/hall/one"
            assert first["remaps"] == [{"source": "said", "target": "heard"}]
            assert second["condition"]["holds"] is False
            given = PlanLaunch(file=file, arguments={"name": "two", "loud": "true"})
            plan = (await studio.ask(given))["plan"]
            assert plan["nodes"][0]["full_name"] == "/hall/two"
            assert plan["nodes"][1]["condition"]["holds"] is True

    asyncio.run(run())


def test_a_plan_is_given_up_and_the_next_one_is_made(tmp_path: Path):
    async def run() -> None:
        ws = workspace(tmp_path / "ws")
        slow = ws / "src/talk/launch/slow.launch.py"
        slow.write_text("import time\ntime.sleep(1000)\n")
        async with run_studio(tmp_path / "data", ws) as studio:
            asked = asyncio.create_task(studio.ask(PlanLaunch(file=str(slow))))
            while not studio.engine.programs.planning.is_busy:  # noqa: ASYNC110 - nothing tells us
                await asyncio.sleep(0.01)
            await studio.ask(CancelPlan())
            with pytest.raises(CommandError, match="given up"):
                await asked
            file = str(ws / "src/talk/launch/hall.launch.py")
            plan = (await studio.ask(PlanLaunch(file=file)))["plan"]
            assert len(plan["nodes"]) == 2

    asyncio.run(run())


def test_a_file_elsewhere_is_not_planned(tmp_path: Path):
    async def run() -> None:
        ws = workspace(tmp_path / "ws")
        file = ws / "src/talk/launch/hall.launch.py"
        allowed = tmp_path / "allowed"
        allowed.mkdir()
        (allowed / "link.launch.py").symlink_to(file)
        async with run_studio(tmp_path / "data", allowed) as studio:
            for path in (file, allowed / "link.launch.py", allowed / ".." / "ws" / "x.launch.py"):
                with pytest.raises(NotRunnableError, match="--allow-run"):
                    await studio.ask(PlanLaunch(file=str(path)))

    asyncio.run(run())

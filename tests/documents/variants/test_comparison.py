"""Two states of a robot compared by a worker of their own, followed, and drawn as a ghost."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

import pytest

from studio.errors import CommandError
from studio.protocol.documents import SetArgument
from studio.protocol.robot import SetDisplay, SetJoints
from studio.protocol.saving import Save
from studio.protocol.variants import (
    CompareVariants,
    DeleteVariant,
    RenameVariant,
    SaveVariant,
    Side,
)
from tests.support.open_documents import until
from tests.support.open_mast import OpenMast, open_mast, write_mast
from tests.support.viser_frames import joined

if TYPE_CHECKING:
    from pathlib import Path


PRESENT, SAVED = Side(kind="present"), Side(kind="saved")


@pytest.fixture
def mast(tmp_path: Path) -> Path:
    return write_mast(tmp_path)


def variant(name: str) -> Side:
    return Side(kind="variant", name=name)


def row(told: dict[str, Any], part: str, what: str) -> tuple[Any, Any]:
    (found,) = [one for one in told["rows"] if (one["part"], one["what"]) == (part, what)]
    return found["one"], found["other"]


def test_a_variant_with_a_gripper_has_links_and_joints_more(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with open_mast(mast, tmp_path / "data") as at:
            await at.ask(SetArgument(name="gripper", value="true"))
            await at.edit("reach", "0.5")
            await at.ask(SaveVariant(name="Gripper"))
            await at.apply("")
            pid = at.document.runs.worker_pid
            told = await at.compared(PRESENT, variant("Gripper"))
            assert row(told, "link:gripper", "link") == (None, "link")
            assert row(told, "joint:grip", "joint") == (None, "fixed")
            assert row(told, "joint:turn", "origin.z") == (0.4, 0.5)
            assert [(one["name"], one["one"], one["other"]) for one in told["inputs"]] == [
                ("gripper", "false", "true"),
                ("reach", "0.4", "0.5"),
            ]
            (changed,) = [one for one in told["rows"] if one["what"] == "origin.z"]
            assert changed["delta"] == pytest.approx(0.1)
            assert changed["percent"] == pytest.approx(25)
            assert changed["unit"] == "m"
            assert told["faults"] == []
            # The document itself was left alone.
            assert at.document.runs.worker_pid == pid
            assert "gripper" not in at.document.model.robot.links

    asyncio.run(run())


def test_the_table_follows_the_present_robot_and_the_disk(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with open_mast(mast, tmp_path / "data") as at:
            await at.edit("reach", "0.5")
            told = await at.compared(SAVED, PRESENT)
            assert row(told, "joint:turn", "origin.z") == (0.4, 0.5)
            await at.edit("reach", "0.6")
            await until(lambda: 0.6 in [one["other"] for one in at.ear.last("comparison")["rows"]])
            await at.ask(Save())
            await until(lambda: at.ear.last("comparison")["rows"] == [])
            mast.write_text(mast.read_text().replace('name="mast"', 'name="boom"'))
            mast.with_name("gripper.xacro").write_text("<robot/>")
            await until(lambda: at.document.model.robot.name == "boom")
            await until(lambda: at.ear.last("comparison")["rows"] == [])

    asyncio.run(run())


def test_a_side_that_does_not_run_is_told_and_the_other_listed(mast: Path, tmp_path: Path):
    mast.with_name("mast.variants.yaml").write_text(
        "variants:\n  - name: Broken\n    values:\n"
        "      - {file: mast.urdf.xacro, property: reach, text: '${nothing}'}\n"
    )

    async def run() -> None:
        async with open_mast(mast, tmp_path / "data") as at:
            told = await at.compared(PRESENT, variant("Broken"))
            (fault,) = told["faults"]
            assert "nothing" in fault
            assert row(told, "link:base", "link") == ("link", None)
            await at.edit("reach", "${0 / 0}")
            await until(lambda: len(at.ear.last("comparison")["faults"]) == 2)

    asyncio.run(run())


def test_sides_must_differ_and_be_there(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with open_mast(mast, tmp_path / "data") as at:
            with pytest.raises(CommandError, match="same"):
                await at.ask(CompareVariants(sides=(SAVED, SAVED)))
            with pytest.raises(CommandError, match="no variant"):
                await at.ask(CompareVariants(sides=(SAVED, variant("x"))))

    asyncio.run(run())


def test_a_comparison_goes_with_its_variant_and_knows_its_new_name(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with open_mast(mast, tmp_path / "data") as at:
            await at.edit("reach", "0.5")
            await at.ask(SaveVariant(name="A"))
            await at.apply("")
            await at.compared(PRESENT, variant("A"))
            await at.ask(RenameVariant(name="A", new_name="B"))
            sides = [PRESENT.model_dump(), variant("B").model_dump()]
            await until(lambda: at.ear.last("comparison")["sides"] == sides)
            assert not any(one["busy"] for one in at.ear.events[-3:] if "busy" in one)
            await at.ask(DeleteVariant(name="B"))
            await until(lambda: at.ear.last("comparison")["sides"] is None)

    asyncio.run(run())


def test_the_ghost_shows_the_other_robot_and_follows_the_joints(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with open_mast(mast, tmp_path / "data") as at:
            await at.ask(SetArgument(name="gripper", value="true"))
            told = await at.compared(PRESENT, SAVED)
            assert told["ghost"] is None
            await at.ask(SetDisplay(display="ghost", name="visible", value=True))
            await until(lambda: at.ear.last("comparison")["ghost"] == SAVED.model_dump())
            ghost = at.document.scene.ghost
            assert ghost.links == {"base", "tip"}
            peer, _ = await joined(at.document.scene)
            await at.ask(SetJoints(positions={"turn": 0.3}))
            turned = [one for one in peer.read() if one["type"] == "SetOrientationMessage"]
            assert {one["name"] for one in turned} == {"/robot/tip", "/robot/gripper", "/ghost/tip"}
            assert len({tuple(one["wxyz"]) for one in turned}) == 1
            await at.ask(CompareVariants())
            await until(lambda: ghost.links == set())

    asyncio.run(run())


async def is_shown(at: OpenMast, links: set[str]) -> None:
    """Wait until just these links of the ghost can be seen by somebody who comes."""
    async with asyncio.timeout(30):
        seen: set[str] | None = None
        while seen != links:
            _, sent = await joined(at.document.scene)
            visible = {one["name"]: one["visible"] for one in sent if "visible" in one}
            names = ("base", "tip", "gripper")
            seen = {name for name in names if visible.get(f"/ghost/{name}")}


def test_over_the_robot_only_what_differs_is_drawn(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with open_mast(mast, tmp_path / "data", gripper="true") as at:
            await at.edit("jaw", "0.5")
            await at.compared(PRESENT, SAVED)
            await at.ask(SetDisplay(display="ghost", name="visible", value=True))
            await is_shown(at, {"gripper"})
            await at.edit("reach", "0.6")
            await is_shown(at, {"tip", "gripper"})
            await at.ask(SetDisplay(display="ghost", name="beside", value=True))
            await is_shown(at, {"base", "tip", "gripper"})

    asyncio.run(run())


def test_beside_it_stands_clear_of_the_robot(mast: Path, tmp_path: Path):
    async def run() -> None:
        async with open_mast(mast, tmp_path / "data", gripper="true") as at:
            await at.edit("jaw", "0.5")
            await at.compared(PRESENT, SAVED)
            for name in ("beside", "visible"):
                await at.ask(SetDisplay(display="ghost", name=name, value=True))
            await until(lambda: at.ear.last("comparison")["ghost"] is not None)
            _, sent = await joined(at.document.scene)
            places = [one for one in sent if one.get("name") == "/ghost" and "position" in one]
            # Half of 1 m, half of the 0.1 m of the other, and a gap of a quarter of the wider one.
            assert list(places[-1]["position"]) == pytest.approx([0, -0.5 - 0.05 - 0.25, 0])

    asyncio.run(run())


def size_of(told: dict[str, Any], part: str, what: str) -> float:
    one, other = row(told, part, what)
    return other / one


def test_a_ur10e_is_longer_heavier_and_slower_than_a_ur5e(corpus: Path, tmp_path: Path):
    entry = corpus / "UniversalRobots+Universal_Robots_ROS2_Description/urdf/ur.urdf.xacro"

    async def run() -> None:
        async with open_mast(entry, tmp_path / "data", ur_type="ur5e", name="ur") as at:
            await at.ask(SetArgument(name="ur_type", value="ur10e"))
            told = await at.compared(SAVED, PRESENT)
            assert ("ur_type", "ur5e", "ur10e") in [
                (one["name"], one["one"], one["other"]) for one in told["inputs"]
            ]
            assert row(told, "link:upper_arm_link", "mass") == (8.058, 13.051)
            assert size_of(told, "robot", "reach") > 1.3
            assert size_of(told, "robot", "total_mass") > 1.4
            assert row(told, "joint:elbow_joint", "origin.x") == (-0.425, -0.6127)
            one, other = row(told, "joint:shoulder_pan_joint", "limit.velocity")
            assert other < one
            meshes = [one for one in told["rows"] if one["what"] == "visual.mesh"]
            assert all("ur5e" in one["one"] and "ur10e" in one["other"] for one in meshes)
            assert meshes

    asyncio.run(run())

"""Named poses of an open robot: found in files around it, kept beside it, taken by its joints."""

from __future__ import annotations

import asyncio
from contextlib import asynccontextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from studio.errors import CommandError, PosesFileError
from studio.protocol.documents import SetArgument
from studio.protocol.robot import ApplyPose, DeletePose, RenamePose, SavePose, SetJoints, ZeroJoints
from tests.support.open_documents import Ear, engine, opened, until
from tests.support.packages import write_package

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator

    from studio.documents.document import Document
    from studio.documents.engine import Engine
    from studio.protocol import Command


ARM = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="prefix" default=""/>
  <xacro:macro name="turning" params="name parent child more:=''">
    <link name="$(arg prefix)${child}"/>
    <joint name="$(arg prefix)${name}" type="revolute">
      <parent link="$(arg prefix)${parent}"/><child link="$(arg prefix)${child}"/>
      <limit lower="-2" upper="1" effort="1" velocity="1"/>
    </joint>
  </xacro:macro>
  <link name="$(arg prefix)base"/>
  <xacro:turning name="shoulder" parent="base" child="upper"/>
  <xacro:turning name="elbow" parent="upper" child="lower"/>
</robot>
"""
SRDF = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="prefix" default=""/>
  <group_state name="folded" group="all">
    <joint name="$(arg prefix)shoulder" value="-1.5"/><joint name="$(arg prefix)elbow" value="3"/>
    <joint name="gripper" value="0"/>
  </group_state>
</robot>
"""


def write_arm(folder: Path, **files: str) -> Path:
    """An arm with a package that configures MoveIt for it; more files by their name there."""
    package = write_package(folder / "arm_description", files={"urdf/arm.urdf.xacro": ARM})
    write_package(folder / "arm_moveit_config", files={"config/arm.srdf.xacro": SRDF})
    for name, text in files.items():
        path = folder / "arm_moveit_config/config" / f"{name}.srdf"
        path.write_text(text)
    return package / "urdf/arm.urdf.xacro"


class OpenArm:
    """One open document, asked as a page asks."""

    def __init__(self, made: Engine, document: Document, ear: Ear) -> None:
        self.made, self.document, self.ear = made, document, ear

    async def ask(self, command: Command) -> None:
        with_id = command.model_copy(update={"document": self.document.id})
        await self.made.execute(with_id, self.ear)

    @property
    def told(self) -> dict[str, Any]:
        return self.ear.last("poses")

    @property
    def names(self) -> list[tuple[str, str]]:
        return [(pose["kind"], pose["name"]) for pose in self.told["poses"]]

    def pose(self, name: str) -> dict[str, Any]:
        return next(pose for pose in self.told["poses"] if pose["name"] == name)

    @property
    def positions(self) -> dict[str, float]:
        return self.document.model.joints.by_name()


@asynccontextmanager
async def open_arm(entry: Path, data: Path, **arguments: str) -> AsyncGenerator[OpenArm]:
    async with engine(data) as made:
        document, ear = await opened(made, entry, **arguments)
        yield OpenArm(made, document, ear)


def test_who_comes_to_a_robot_that_nobody_watched_hears_its_poses(tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document = made.document(await made.open_path(write_arm(tmp_path / "src"), {}))
            await document.opened()
            ear = Ear()
            document.attach(ear)
            await until(lambda: [one["name"] for one in ear.last("poses")["poses"]] == ["folded"])

    asyncio.run(run())


def test_a_state_of_the_srdf_is_told_with_what_does_not_fit_and_is_taken(tmp_path: Path):
    async def run() -> None:
        async with open_arm(write_arm(tmp_path / "src"), tmp_path / "data") as arm:
            await until(lambda: arm.names == [("srdf", "folded")])
            pose = arm.pose("folded")
            assert pose["positions"] == {"shoulder": -1.5, "elbow": 3.0}
            assert (pose["unknown"], pose["beyond"]) == (["gripper"], ["elbow"])
            assert (pose["group"], Path(pose["file"]).name, pose["line"]) == (
                "all",
                "arm.srdf.xacro",
                3,
            )
            await arm.ask(ApplyPose(key=pose["key"]))
            assert arm.positions == {"shoulder": -1.5, "elbow": 1.0}

    asyncio.run(run())


def test_an_srdf_is_given_the_arguments_of_the_robot(tmp_path: Path):
    async def run() -> None:
        async with open_arm(write_arm(tmp_path / "src"), tmp_path / "data") as arm:
            await until(lambda: arm.names == [("srdf", "folded")])
            await arm.ask(SetArgument(name="prefix", value="left_"))
            await until(lambda: "left_elbow" in arm.pose("folded")["positions"])

    asyncio.run(run())


def test_a_changed_srdf_is_read_again(tmp_path: Path):
    async def run() -> None:
        async with open_arm(write_arm(tmp_path / "src"), tmp_path / "data") as arm:
            await until(lambda: arm.names == [("srdf", "folded")])
            path = Path(arm.pose("folded")["file"])
            path.write_text(SRDF.replace("folded", "packed"))
            await until(lambda: arm.names == [("srdf", "packed")])
            path.write_text("<robot")
            await until(lambda: arm.names == [])
            path.write_text(SRDF)
            await until(lambda: arm.names == [("srdf", "folded")])

    asyncio.run(run())


def test_files_that_come_while_the_robot_is_open_are_seen_and_those_that_go(tmp_path: Path):
    entry = write_arm(tmp_path / "src")
    config = tmp_path / "src/arm_moveit_config/config"
    srdf = (config / "arm.srdf.xacro").rename(tmp_path / "kept")

    async def run() -> None:
        async with open_arm(entry, tmp_path / "data") as arm:
            assert arm.names == []
            (config / "readme.txt").write_text("")
            srdf.rename(config / "new.srdf.xacro")
            await until(lambda: arm.names == [("srdf", "folded")])
            beside = entry.parent.parent / "config"
            beside.mkdir()
            (beside / "initial_positions.yaml").write_text("initial_positions:\n  shoulder: 0.5\n")
            await until(lambda: len(arm.names) == 2)
            (config / "new.srdf.xacro").unlink()
            await until(lambda: [kind for kind, _ in arm.names] == ["initial"])

    asyncio.run(run())


def test_states_of_other_robots_are_left_out(tmp_path: Path):
    async def run() -> None:
        other = SRDF.replace('name="arm"', 'name="other"').replace("folded", "theirs")
        strange = SRDF.replace("elbow", "knee").replace("folded", "strange")
        entry = write_arm(tmp_path / "src", other=other, strange=strange)
        async with open_arm(entry, tmp_path / "data") as arm:
            await until(lambda: ("srdf", "folded") in arm.names)
            assert arm.names == [("srdf", "folded")]

    asyncio.run(run())


def test_initial_positions_of_the_package_are_a_pose(tmp_path: Path):
    async def run() -> None:
        entry = write_arm(tmp_path / "src")
        config = entry.parents[1] / "config"
        config.mkdir()
        (config / "initial_positions.yaml").write_text("shoulder: 0.25\nelbow: !degrees -90\n")
        (config / "their_initial_positions.yaml").write_text("wheel: 1\n")
        async with open_arm(entry, tmp_path / "data") as arm:
            await until(lambda: ("initial", "initial_positions") in arm.names)
            assert ("initial", "their_initial_positions") not in arm.names
            await arm.ask(ApplyPose(key=arm.pose("initial_positions")["key"], duration_s=0.05))
            await until(
                lambda: arm.positions == {"shoulder": 0.25, "elbow": pytest.approx(-1.570796)}
            )

    asyncio.run(run())


def test_a_pose_is_kept_renamed_replaced_and_deleted_beside_the_robot(tmp_path: Path):
    async def run() -> None:
        entry = write_arm(tmp_path / "src")
        async with open_arm(entry, tmp_path / "data") as arm:
            await arm.ask(SetJoints(positions={"shoulder": 0.5, "elbow": -1.0}))
            await arm.ask(SavePose(name=" Reach "))
            assert arm.pose("Reach")["positions"] == {"shoulder": 0.5, "elbow": -1.0}
            file = entry.with_name("arm.poses.yaml")
            assert arm.told["path"] == str(file)
            await arm.ask(RenamePose(name="Reach", new_name="High"))
            await arm.ask(ZeroJoints())
            await arm.ask(SavePose(name="High", replace=True))
            assert (
                "  - name: High\n    joints:\n      shoulder: 0\n      elbow: 0\n"
                in file.read_text()
            )
            await arm.ask(DeletePose(name="High"))
            assert ("own", "High") not in arm.names

    asyncio.run(run())


def test_a_pose_outlives_the_studio_and_a_change_by_hand_is_seen(tmp_path: Path):
    async def run() -> None:
        entry = write_arm(tmp_path / "src")
        async with open_arm(entry, tmp_path / "data") as arm:
            await arm.ask(SavePose(name="Home"))
        async with open_arm(entry, tmp_path / "data") as arm:
            assert arm.names[0] == ("own", "Home")
            file = entry.with_name("arm.poses.yaml")
            file.write_text(
                file.read_text() + "  - name: Mine\n    joints: {elbow: 0.5, tail: 1}\n"
            )
            await until(lambda: ("own", "Mine") in arm.names)
            assert arm.pose("Mine")["unknown"] == ["tail"]
            file.write_text("poses: 7\n")
            await until(lambda: "line 1 must be a list" in arm.told["trouble"])
            assert ("own", "Mine") in arm.names
            with pytest.raises(PosesFileError):
                await arm.ask(SavePose(name="Other"))
            assert file.read_text() == "poses: 7\n"

    asyncio.run(run())


def test_what_cannot_be_done_is_a_sentence(tmp_path: Path):
    async def run() -> None:
        async with open_arm(write_arm(tmp_path / "src"), tmp_path / "data") as arm:
            await arm.ask(SavePose(name="Home"))
            for command, words in (
                (SavePose(name="Home"), "There is a pose"),
                (SavePose(name="  "), "needs a name"),
                (SavePose(name="two\nlines"), "needs a name"),
                (RenamePose(name="None", new_name="x"), "no pose"),
                (DeletePose(name="None"), "no pose"),
                (ApplyPose(key="own:None"), "not there any more"),
            ):
                with pytest.raises(CommandError, match=words):
                    await arm.ask(command)

    asyncio.run(run())


def test_a_robot_that_does_not_move_has_no_pose(tmp_path: Path):
    async def run() -> None:
        file = tmp_path / "stone.urdf"
        file.write_text('<robot name="stone"><link name="a"/></robot>')
        async with open_arm(file, tmp_path / "data") as stone:
            with pytest.raises(CommandError, match="no joint that moves"):
                await stone.ask(SavePose(name="Home"))

    asyncio.run(run())


def test_a_hostile_srdf_names_no_pose_and_harms_nobody(tmp_path: Path):
    async def run() -> None:
        bomb = '<robot name="arm">' + "<group_state>" * 20_000
        code = SRDF.replace("-1.5", "${__import__('os').system('false')}").replace("folded", "bad")
        entry = write_arm(tmp_path / "src", bomb=bomb, code=code, nul="group_state \0")
        async with open_arm(entry, tmp_path / "data") as arm:
            await until(lambda: arm.names == [("srdf", "folded")])

    asyncio.run(run())


def test_who_moves_a_joint_ends_the_way_to_a_pose(tmp_path: Path):
    async def run() -> None:
        async with open_arm(write_arm(tmp_path / "src"), tmp_path / "data") as arm:
            await until(lambda: arm.names == [("srdf", "folded")])
            await arm.ask(ApplyPose(key=arm.pose("folded")["key"], duration_s=5.0))
            await until(lambda: arm.positions["shoulder"] < 0)
            await arm.ask(SetJoints(positions={"shoulder": 0.75}))
            stood = arm.positions
            frames = len(arm.ear.frames)
            await arm.ask(SetJoints(positions={"elbow": stood["elbow"]}))
            assert arm.positions == stood
            assert len(arm.ear.frames) == frames + 1

    asyncio.run(run())

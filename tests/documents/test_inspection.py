"""What a real document answers to a page that measures its robot."""

from __future__ import annotations

import asyncio
import json
from typing import TYPE_CHECKING, Any

import pytest

from studio.protocol.edits import EditSite
from studio.protocol.robot import GetFrames, GetMasses
from studio.protocol.roles import Role
from tests.support.asked import ask_document
from tests.support.descriptions import robot, write
from tests.support.link_poses import FILE, link_poses
from tests.support.open_documents import Ear, engine, opened

if TYPE_CHECKING:
    from pathlib import Path

    from studio.documents.document import Document
    from studio.protocol import Command


TETRAHEDRON = """v 0 0 0
v 1 0 0
v 0 1 0
v 0 0 1
f 1 3 2
f 1 2 4
f 1 4 3
f 2 3 4
"""
BODY = """
<xacro:property name="height" value="0.5"/>
<link name="base"><inertial><origin xyz="0 0 0.1"/><mass value="2"/>
    <inertia ixx="0.3" iyy="0.2" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>
  <visual><geometry><mesh filename="solid.obj" scale="1 1 3"/></geometry></visual>
  <collision><geometry><box size="0.1 0.2 0.3"/></geometry></collision></link>
<link name="arm"><inertial><mass value="1"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  <visual><geometry><mesh filename="missing.obj"/></geometry></visual></link>
<link name="tip"/>
<joint name="turn" type="revolute"><parent link="base"/><child link="arm"/>
  <origin xyz="0 0 ${height}" rpy="0.1 0 0"/><axis xyz="0 0 1"/>
  <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="hold" type="fixed"><parent link="arm"/><child link="tip"/></joint>
"""


async def asked(document: Document, command: Command) -> dict[str, Any]:
    """What one who only looks is told."""
    ear = Ear(Role.GUEST)
    await ask_document(document, command, ear)
    (event,) = ear.events
    return event


def test_the_frames_of_all_joints_are_told_and_follow_an_edit(tmp_path: Path):
    files = {"a.urdf.xacro": robot(BODY), "solid.obj": TETRAHEDRON}
    file = write(tmp_path / "robot", files)

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, file)
            told = await asked(document, GetFrames(request=3))
            assert told["request"] == 3
            assert told["revision"] == ear.last("robot")["revision"]
            assert told["origins"] == {
                "turn": [0.0, 0.0, 0.5, 0.1, 0.0, 0.0],
                "hold": [0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            }
            site = ear.site("height")["id"]
            await ask_document(document, EditSite(site=site, text="0.75"), ear)
            again = await asked(document, GetFrames())
            assert again["origins"]["turn"][2] == 0.75

    asyncio.run(run())


def test_links_with_a_mass_are_told_with_the_room_of_their_shapes(tmp_path: Path):
    files = {"a.urdf.xacro": robot(BODY), "solid.obj": TETRAHEDRON}
    file = write(tmp_path / "robot", files)

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, _ = await opened(made, file)
            base, arm = (await asked(document, GetMasses()))["links"]
            assert base["link"] == "base"
            assert (base["mass_kg"], base["centre_m"]) == (2.0, [0.0, 0.0, 0.1])
            assert base["moments_kg_m2"] == pytest.approx([0.1, 0.2, 0.3])
            assert base["inertia_kg_m2"] == [0.3, 0.0, 0.0, 0.2, 0.0, 0.1]
            assert base["collision"]["volume_m3"] == pytest.approx(0.006)
            assert base["visual"]["volume_m3"] == pytest.approx(0.5)
            assert base["visual"]["is_exact"]
            assert (arm["visual"], arm["collision"]) == (None, None)

    asyncio.run(run())


def test_a_robot_without_masses_and_one_that_was_never_read_have_none(tmp_path: Path):
    bare = write(tmp_path / "bare", {"a.urdf": robot('<link name="base"/>')})
    broken = write(tmp_path / "broken", {"a.urdf.xacro": robot("<link name='${nothing}'/>")})

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            for file in (bare, broken):
                document, _ = await opened(made, file)
                assert (await asked(document, GetMasses()))["links"] == []
                assert (await asked(document, GetFrames()))["origins"] == {}

    asyncio.run(run())


def test_the_file_that_the_page_is_tested_with_is_what_yourdfpy_says_now(tmp_path: Path):
    found = json.loads(json.dumps(asyncio.run(link_poses(tmp_path / "data"))))
    kept = json.loads(FILE.read_text(encoding="utf-8"))
    assert found.keys() == kept.keys()
    for name in ("links", "joints", "origins", "positions", "masses"):
        assert found[name] == kept[name]
    assert found["centre"] == pytest.approx(kept["centre"], abs=1e-12)
    for link, pose in found["poses"].items():
        assert pose == pytest.approx(kept["poses"][link], abs=1e-12)

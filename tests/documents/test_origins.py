"""Questions of a page about a real document: where a part comes from, what a text shapes."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

import pytest

from studio.errors import CommandError
from studio.protocol.origins import GetEffects, GetOrigin
from studio.protocol.roles import Role
from tests.support.asked import ask_document
from tests.support.descriptions import robot, write
from tests.support.open_documents import Ear, engine, opened

if TYPE_CHECKING:
    from pathlib import Path

    from studio.documents.document import Document
    from studio.protocol import Command


BODY = """
<xacro:property name="reach" value="0.4"/>
<xacro:property name="width" value="0.1"/>
<xacro:property name="shade" value="0.5"/>
<xacro:property name="idle" value="1"/>
<material name="grey"><color rgba="${shade} ${shade} ${shade} 1"/></material>
<link name="base"><visual><geometry><box size="${width} 0.1 0.1"/></geometry>
  <material name="grey"/></visual></link>
<link name="arm"><visual><geometry><sphere radius="0.1"/></geometry></visual></link>
<link name="tip"/>
<joint name="turn" type="revolute"><parent link="base"/><child link="arm"/>
  <origin xyz="0 0 ${reach}"/><axis xyz="0 0 1"/>
  <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="hold" type="fixed"><parent link="arm"/><child link="tip"/></joint>
<xacro:arg name="extra" default="true"/>
<xacro:if value="$(arg extra)"><link name="more"/>
  <joint name="carry" type="fixed"><parent link="tip"/><child link="more"/></joint></xacro:if>
"""


async def asked(document: Document, command: Command, role: Role = Role.GUEST) -> dict[str, Any]:
    """What the asker alone hears."""
    ear = Ear(role)
    await ask_document(document, command, ear)
    (event,) = ear.events
    return event


async def effects(document: Document, ear: Ear, name: str) -> dict[str, Any]:
    return await asked(document, GetEffects(request=7, site=ear.site(name)["id"]))


def test_who_lights_up_is_known_from_the_robot(tmp_path: Path):
    file = write(tmp_path / "robot", {"a.urdf.xacro": robot(BODY)})

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, file)
            reach = await effects(document, ear, "reach")
            assert reach["request"] == 7
            assert (reach["changed_links"], reach["moved_links"]) == ([], ["arm", "tip", "more"])
            assert reach["counts"] == {"pose": 3}
            assert reach["parts"] == [{"part": "joint:turn", "aspects": ["pose"]}]
            width = await effects(document, ear, "width")
            assert (width["changed_links"], width["moved_links"]) == (["base"], [])
            shade = await effects(document, ear, "shade")
            assert (shade["changed_links"], shade["counts"]) == (["base"], {"color": 1})
            extra = await effects(document, ear, "extra")
            assert (extra["changed_links"], extra["counts"]) == (["more"], {})
            assert (extra["links_there"], extra["joints_there"]) == (1, 1)
            assert extra["decisions"] == 1
            idle = await effects(document, ear, "idle")
            assert (idle["parts"], idle["readers"]) == ([], [])

    asyncio.run(run())


def test_an_origin_holds_while_the_text_is_broken_and_follows_the_next_good_run(tmp_path: Path):
    file = write(tmp_path / "robot", {"a.urdf.xacro": robot(BODY)})

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, file)
            ask = GetOrigin(request=1, part="joint:turn")
            reach = ear.site("reach")["id"]

            async def height() -> str:
                told = (await asked(document, ask))["origin"]["attributes"]
                return next(one["value"] for one in told if one["element"] == "origin")

            assert await height() == "0 0 0.4"
            await document.edits.edit_site(reach, "${", "")
            assert document.last_run.failed
            assert await height() == "0 0 0.4"
            await document.edits.edit_site(reach, "0.5", "")
            assert await height() == "0 0 0.5"
            with pytest.raises(CommandError, match="joint:gone"):
                await asked(document, GetOrigin(part="joint:gone"))

    asyncio.run(run())

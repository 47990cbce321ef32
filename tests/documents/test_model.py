"""A drag through a whole document: what is seen at last, and what must not grow by it."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from tests.support.open_documents import Ear, engine, opened, until
from tests.support.packages import write_package
from tests.support.viser_frames import Peer, eventually, messages_of

if TYPE_CHECKING:
    from pathlib import Path

    from studio.documents.document import Document


BOX = """<?xml version="1.0"?>
<robot name="box" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="size" value="0.4"/>
  <xacro:property name="weight" value="1.0"/>
  <link name="base">
    <visual><geometry><box size="0.1 0.1 ${size}"/></geometry></visual>
    <inertial><mass value="${weight}"/><inertia ixx="1" iyy="1" izz="1"/></inertial>
  </link>
  <link name="tip"/>
  <joint name="turn" type="revolute">
    <parent link="base"/><child link="tip"/><origin xyz="0 0 ${size}"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
</robot>
"""


@pytest.fixture
def box(tmp_path: Path) -> Path:
    package = write_package(tmp_path / "box_description", files={"urdf/box.urdf.xacro": BOX})
    return package / "urdf" / "box.urdf.xacro"


async def looked_at(document: Document) -> Peer:
    """A page of the 3D view that has seen the document."""
    peer = Peer()
    peer.serving = asyncio.create_task(document.scene.serve(peer, lambda _: True))
    await eventually(lambda: bool(peer.frames))
    return peer


def heights(peer: Peer) -> list[float]:
    """Of the box, in the order in which the page was told of them."""
    messages = [message for frame in peer.frames for message in messages_of(frame)]
    props = [message.get("props") or message.get("updates") for message in messages]
    return [one["dimensions"][2] for one in props if one and "dimensions" in one]


def test_a_drag_shows_its_last_value_last_and_is_one_step_to_undo(box: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, box)
            peer = await looked_at(document)
            size = ear.site("size")["id"]
            texts = [f"{0.4 + 0.001 * number:.3f}" for number in range(1, 201)]
            edits = [document.edits.edit_site(size, text, "drag") for text in texts]
            await asyncio.gather(*edits)
            assert heights(peer)[-1] == 0.6
            assert ear.site("size")["text"] == "0.600"
            assert ear.last("history")["undo"] == ["size 0.4 → 0.600"]

    asyncio.run(run())


def test_edit_after_edit_leaves_no_more_behind_than_the_first(box: Path, tmp_path: Path):
    def kept(document: Document) -> tuple[int, ...]:
        viser = document.scene.viser.scene
        buffer = viser._websock_interface.get_message_buffer()  # pyright: ignore[reportPrivateUsage]
        book = document.sites
        spans, steps = document.sources.spans, document.sources.undo_labels
        return (
            len(buffer.message_from_id),
            len(book.sites),
            len(spans._since),  # pyright: ignore[reportPrivateUsage]
            len(steps),
        )

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, box)
            size = ear.site("size")["id"]
            await document.edits.edit_site(size, "0.401", "drag")
            first = kept(document)
            for number in range(2, 60):
                await document.edits.edit_site(size, f"{0.4 + 0.001 * number:.3f}", "drag")
            assert kept(document) == first

    asyncio.run(run())


def test_an_edit_tells_the_robot_only_when_the_page_would_see_a_difference(
    box: Path, tmp_path: Path
):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, box)
            told = [event["type"] for event in ear.events].count("robot")
            await document.edits.edit_site(ear.site("size")["id"], "0.5", "")
            assert [event["type"] for event in ear.events].count("robot") == told
            await document.edits.edit_site(ear.site("weight")["id"], "2.5", "")
            assert ear.last("robot")["links"][0]["mass_kg"] == 2.5

    asyncio.run(run())


def test_a_newcomer_after_many_edits_is_told_of_the_robot_as_it_is(box: Path, tmp_path: Path):
    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, box)
            await document.edits.edit_site(ear.site("weight")["id"], "3", "")
            newcomer = Ear()
            document.attach(newcomer)
            await until(lambda: bool(newcomer.events))
            assert newcomer.last("robot") == ear.last("robot")

    asyncio.run(run())

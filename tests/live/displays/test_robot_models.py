"""Robots of others as displays: described over a real router, their links where TF says."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

import pytest

from studio.nodes.robot_state_publisher import LATCHED, RobotStatePublisher
from studio.protocol.displays import AddDisplay, RemoveDisplay, SetDisplayProperty, SetFixedFrame
from studio.ros.messages import message
from studio.ros.parameters.parameter import Parameter
from tests.support.meshes import stl
from tests.support.open_documents import until
from tests.support.viser_frames import joined
from tests.support.wire import PATIENCE_S
from tests.support.wired_studio import STRING, Studio, studio

if TYPE_CHECKING:
    from pathlib import Path

    from studio.ros.client import Node

pytestmark = pytest.mark.network

CART = """<robot name="cart">
  <link name="hull"><visual><geometry><box size="1 1 {height}"/></geometry></visual></link>
  <link name="arm"><visual><geometry><sphere radius="0.2"/></geometry></visual></link>
  <joint name="lift" type="prismatic"><parent link="hull"/><child link="arm"/>
    <axis xyz="0 0 1"/><limit lower="0" upper="2" effort="1" velocity="1"/></joint>
</robot>"""


def cart(height: float = 1.0) -> str:
    return CART.format(height=height)


def told(tester: Node, prefix: str = "") -> dict[str, float]:
    """Tell of a cart again and again; the positions of its joints, as they are told next."""
    robot, positions = RobotStatePublisher(tester, prefix), {"lift": 0.5}
    robot.describe(cart())
    tester.create_timer(0.05, lambda: robot.place(positions))
    return positions


async def add(one: Studio, values: dict[str, str] | None = None, topic: str = "") -> str:
    """A RobotModel with these properties; its id."""
    await one.do(AddDisplay(kind="RobotModel", topic=topic))
    display: str = one.ear.last("live_displays")["displays"][-1]["id"]
    for name, value in (values or {}).items():
        await one.do(SetDisplayProperty(display=display, name=name, value=value))
    return display


def remarks(one: Studio, display: str) -> list[str]:
    told = [event for event in one.ear.events if event["type"] == "display_states"]
    states: list[dict[str, Any]] = told[-1]["states"] if told else []
    return [
        said["sentence"] for each in states if each["id"] == display for said in each["remarks"]
    ]


def poses(one: Studio, display: str) -> dict[str, tuple[float, ...] | None]:
    """Where the links of a robot stand in the fixed frame, m."""
    shown = one.document.live.shown(display)
    return {
        link: pose and tuple(round(part, 6) for part in pose[1])
        for link, pose in shown.poses.items()
    }


async def nodes(one: Studio) -> dict[str, dict[str, Any]]:
    """What a page that comes now is told to make, by name."""
    _, sent = await joined(one.document.scene)
    return {said["name"]: said["props"] for said in sent if "props" in said}


async def is_made(one: Studio, name: str, prop: str, value: object) -> None:
    async with asyncio.timeout(60):
        while (await nodes(one))[name][prop] != value:  # noqa: ASYNC110 - nothing tells us
            await asyncio.sleep(0.02)


def test_two_robots_of_one_description_stand_where_the_frames_of_their_prefixes_are(
    endpoint: str, tester: Node, tmp_path: Path
):
    async def run() -> None:
        told(tester, "r1/")
        positions = told(tester, "r2/")
        async with studio(endpoint, tmp_path) as one:
            first = await add(one, {"TF Prefix": "r1"})
            second = await add(one, {"TF Prefix": "/r2/"})
            assert one.ear.last("live_displays")["displays"][0]["topic"] == "/robot_description"
            await one.do(SetFixedFrame(frame="r1/hull"))
            expected = {"hull": (0.0, 0.0, 0.0), "arm": (0.0, 0.0, 0.5)}
            await until(lambda: poses(one, first) == expected)
            assert f"/live/{first}/arm/link.visual-0" in await nodes(one)
            await until(lambda: len(remarks(one, second)) == 2)
            assert all("r2/" in said and "r1/hull" in said for said in remarks(one, second))
            await one.do(SetFixedFrame(frame="r2/hull"))
            await until(lambda: poses(one, second).get("arm") == (0.0, 0.0, 0.5))
            positions["lift"] = 1.25
            await until(lambda: poses(one, second).get("arm") == (0.0, 0.0, 1.25))

    asyncio.run(run())


def test_a_description_that_comes_anew_is_drawn_and_a_broken_one_leaves_the_one_before(
    endpoint: str, tester: Node, tmp_path: Path
):
    async def run() -> None:
        out = tester.create_publisher(message(STRING), "/other", LATCHED)
        told(tester)
        out.publish(message(STRING)(data=cart()))
        async with studio(endpoint, tmp_path) as one:
            display = await add(one, topic="/other")
            await one.do(SetFixedFrame(frame="hull"))
            hull, arm = (f"/live/{display}/{link}/link.visual-0" for link in ("hull", "arm"))
            await until(lambda: poses(one, display).get("arm") is not None)
            before = await nodes(one)
            out.publish(message(STRING)(data=cart(3.0)))
            await is_made(one, hull, "dimensions", [1.0, 1.0, 3.0])
            assert (await nodes(one))[arm] == before[arm]
            for broken in ("<robot><link", '<robot><link name="${1 + 1"/></robot>', "<robot/>"):
                out.publish(message(STRING)(data=broken))
                await until(lambda: any("before stays" in said for said in remarks(one, display)))
                assert (await nodes(one))[hull]["dimensions"] == [1.0, 1.0, 3.0]
                out.publish(message(STRING)(data=cart(3.0)))
                await until(lambda: remarks(one, display) == ["Shown."])

    asyncio.run(run())


def test_a_description_that_can_be_read_in_part_is_shown_in_part_until_a_good_one_comes(
    endpoint: str, tester: Node, tmp_path: Path
):
    async def run() -> None:
        told(tester)
        out = tester.create_publisher(message(STRING), "/other", LATCHED)
        out.publish(message(STRING)(data=f'<!-- late --><?xml version="1.0"?>{cart()}'))
        async with studio(endpoint, tmp_path) as one:
            display = await add(one, topic="/other")
            await one.do(SetFixedFrame(frame="hull"))
            await until(lambda: poses(one, display).get("arm") is not None)
            await until(lambda: any("can be read" in said for said in remarks(one, display)))
            out.publish(message(STRING)(data=cart()))
            await until(lambda: remarks(one, display) == ["Shown."])

    asyncio.run(run())


def test_a_description_of_the_wire_reads_no_file(endpoint: str, tester: Node, tmp_path: Path):
    async def run() -> None:
        secret = tmp_path / "secret.xacro"
        secret.write_text('<robot><link name="secret"/></robot>')
        text = (
            '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
            f'<xacro:include filename="{secret}"/><link name="own"/></robot>'
        )
        out = tester.create_publisher(message(STRING), "/robot_description", LATCHED)
        out.publish(message(STRING)(data=text))
        async with studio(endpoint, tmp_path) as one:
            display = await add(one)
            await until(lambda: any("outside" in said for said in remarks(one, display)))
            assert poses(one, display) == {}

    asyncio.run(run())


def test_a_description_comes_from_the_parameter_of_a_node_and_follows_it(
    endpoint: str, tester: Node, tmp_path: Path
):
    async def run() -> None:
        told(tester)
        async with studio(endpoint, tmp_path) as one:
            source = {
                "Description Source": "Parameter",
                "Description Node": "/tester",
                "Description Parameter": "model",
            }
            display = await add(one, source)
            await one.do(SetFixedFrame(frame="hull"))
            await until(lambda: bool(remarks(one, display)))
            tester.declare_parameter("model", cart())
            await until(lambda: poses(one, display).get("arm") == (0.0, 0.0, 0.5))
            await until(lambda: remarks(one, display) == ["Shown."])
            described = Parameter("model", value=cart(2.0))
            tester.set_parameters([described])
            hull = f"/live/{display}/hull/link.visual-0"
            await is_made(one, hull, "dimensions", [1.0, 1.0, 2.0])
            await one.do(RemoveDisplay(display=display))

    asyncio.run(run())


def test_the_robot_of_the_document_and_one_of_a_file_stand_where_their_own_frames_are(
    endpoint: str, tmp_path: Path
):
    async def run() -> None:
        (tmp_path / "cart.urdf").write_text(cart())
        async with studio(endpoint, tmp_path) as one:
            own = await add(one, {"Description Source": "Document"})
            await until(lambda: poses(one, own).get("tip") == (0.5, 0.0, 0.0))
            file = await add(one, {"Description Source": "File", "Description File": "cart.urdf"})
            await until(lambda: len(remarks(one, file)) == 2)
            assert all("hull" in said or "arm" in said for said in remarks(one, file))
            fresh = tmp_path / "cart.urdf.new"
            fresh.write_text('<robot name="cart"><link name="mast"/></robot>')
            fresh.rename(tmp_path / "cart.urdf")  # as editors save
            await until(lambda: any("mast" in said for said in remarks(one, file)))
            (tmp_path / "cart.urdf").unlink()
            await until(
                lambda: any("What was there before stays" in said for said in remarks(one, file))
            )
            (tmp_path / "cart.urdf").write_text('<robot name="cart"><link name="boom"/></robot>')
            await until(lambda: any("boom" in said for said in remarks(one, file)))
            await one.do(
                SetDisplayProperty(display=file, name="Description File", value="/etc/passwd")
            )
            await until(lambda: any("passwd" in said for said in remarks(one, file)))

    asyncio.run(run())


def test_a_mesh_that_is_not_there_is_told_and_one_beside_the_document_is_drawn(
    endpoint: str, tester: Node, tmp_path: Path
):
    async def run() -> None:
        (tmp_path / "there.stl").write_bytes(stl())
        text = (
            '<robot name="r"><link name="base"><visual><geometry><mesh filename="there.stl"/>'
            '</geometry></visual><visual><geometry><mesh filename="package://gone/a.dae"/>'
            "</geometry></visual></link></robot>"
        )
        out = tester.create_publisher(message(STRING), "/robot_description", LATCHED)
        out.publish(message(STRING)(data=text))
        async with studio(endpoint, tmp_path) as one:
            display = await add(one)
            await until(lambda: any("gone" in said for said in remarks(one, display)))
            both = {f"/live/{display}/base/link.visual-{at}" for at in (0, 1)}
            async with asyncio.timeout(PATIENCE_S):
                while not both <= (await nodes(one)).keys():  # noqa: ASYNC110 - nothing tells us when
                    await asyncio.sleep(0.01)

    asyncio.run(run())

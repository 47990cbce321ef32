"""Displays over a real router: what others publish is drawn where TF says."""

from __future__ import annotations

import asyncio
import math
from typing import TYPE_CHECKING, Any

import pytest

from studio.errors import CommandError, DisplayError
from studio.live.displays import document_displays
from studio.live.displays.plugins import Plugins
from studio.protocol.connection import ConnectWire, DisconnectWire
from studio.protocol.displays import (
    AddDisplay,
    ArrangeDisplay,
    ArrangeGroup,
    DuplicateDisplay,
    GetTf,
    GetTopics,
    RemoveDisplay,
    RestoreDisplays,
    SetDisplayProperty,
    SetFixedFrame,
    SwitchDisplays,
)
from studio.ros.messages import message
from studio.ros.types.library import TypeLibrary
from tests.support.demos import node_at
from tests.support.open_documents import until
from tests.support.plugins import example
from tests.support.viser_frames import joined
from tests.support.wired_studio import TF, Studio, studio

if TYPE_CHECKING:
    from pathlib import Path

    from studio.ros.client import Node, Publisher

pytestmark = pytest.mark.network

POSE = "geometry_msgs/msg/PoseStamped"
NOW_S = 1_700_000_000


def stamped(frame: str, second: int = NOW_S) -> Any:  # noqa: ANN401
    header = message("std_msgs/msg/Header")(frame_id=frame)
    header.stamp.sec = second
    return header


def transform(parent: str, child: str, x_m: float, second: int = NOW_S) -> Any:  # noqa: ANN401
    one = message("geometry_msgs/msg/TransformStamped")(
        header=stamped(parent, second), child_frame_id=child
    )
    one.transform.translation.x = x_m
    one.transform.rotation.w = 1.0
    return message(TF)(transforms=[one])


def pose_at(frame: str, y_m: float, second: int = NOW_S) -> Any:  # noqa: ANN401
    one = message(POSE)(header=stamped(frame, second))
    one.pose.position.y = y_m
    one.pose.orientation.w = 1.0
    return one


def said(one: Studio, number: int = 0) -> list[str]:
    """Reasons that are given for a display, "" for all being well."""
    told = [event for event in one.ear.events if event["type"] == "display_states"]
    if not told or len(told[-1]["states"]) <= number:
        return []
    return [remark["reason"] for remark in told[-1]["states"][number]["remarks"]]


def listed(one: Studio) -> list[dict[str, Any]]:
    return one.ear.last("live_displays")["displays"]


async def places(one: Studio) -> list[list[float]]:
    """Where the groups of live displays are, and whether they are seen."""
    _, sent = await joined(one.document.scene)
    hidden = {
        said["name"]
        for said in sent
        if said["type"] == "SetSceneNodeVisibilityMessage" and not said["visible"]
    }
    return [
        [round(part, 6) for part in said["position"]]
        for said in sent
        if said["type"] == "SetPositionMessage"
        and said["name"].startswith("/live/")
        and said["name"] not in hidden
    ]


async def is_at(one: Studio, position: list[float]) -> None:
    async with asyncio.timeout(60):
        while position not in await places(one):  # noqa: ASYNC110 - nothing tells us when
            await asyncio.sleep(0.02)


async def draws(one: Studio, expected: bool) -> None:
    """Wait until something, or nothing, of the first display stands in the scene."""

    async def is_drawn() -> bool:
        _, sent = await joined(one.document.scene)
        return any(said.get("name", "").startswith("/live/d1/") for said in sent)

    async with asyncio.timeout(60):
        while await is_drawn() != expected:  # noqa: ASYNC110 - nothing tells us when
            await asyncio.sleep(0.02)


async def aim(one: Studio, poses: Publisher, pose: Any) -> None:  # noqa: ANN401
    """Show a pose's topic, and tell the pose once it is heard."""
    await one.do(AddDisplay(kind="Pose", topic=poses.topic_name))
    await until(lambda: bool(poses.get_subscription_count()))
    poses.publish(pose)


def test_a_pose_of_others_stands_where_their_transforms_put_its_frame_at_its_stamp(
    endpoint: str, tester: Node, tmp_path: Path
):
    async def run() -> None:
        poses = tester.create_publisher(message(POSE), "/goal", 10)
        tf = tester.create_publisher(message(TF), "/tf", 100)
        async with studio(endpoint, tmp_path) as one:
            await one.do(AddDisplay(kind="Pose", topic="/goal"))
            await one.do(SetFixedFrame(frame="odom"))
            assert listed(one)[0]["topic"] == "/goal"
            await until(
                lambda: bool(poses.get_subscription_count() and tf.get_subscription_count())
            )
            poses.publish(pose_at("cart", 2.0, NOW_S + 1))
            await until(lambda: said(one) == ["no_frame"])
            for second in range(4):
                tf.publish(transform("odom", "cart", 10.0 * second, NOW_S + second))
            await is_at(one, [10.0, 0.0, 0.0])
            await until(lambda: said(one) == ["ok"] or said(one) == [""])
            await one.do(SetFixedFrame(frame="cart"))
            await is_at(one, [0.0, 0.0, 0.0])

    asyncio.run(run())


def test_what_was_drawn_leaves_the_screen_with_the_connection(
    endpoint: str, tester: Node, tmp_path: Path
):
    async def run() -> None:
        poses = tester.create_publisher(message(POSE), "/aim", 10)
        async with studio(endpoint, tmp_path) as one:
            await aim(one, poses, pose_at("base", 2.0))
            await draws(one, True)
            await one.do(DisconnectWire())
            await draws(one, False)
            await until(lambda: said(one) == ["not_connected"])

    asyncio.run(run())


def test_the_robot_goes_where_its_root_link_is_in_the_fixed_frame(
    endpoint: str, tester: Node, tmp_path: Path
):
    async def run() -> None:
        tf = tester.create_publisher(message(TF), "/tf", 100)
        async with studio(endpoint, tmp_path) as one:
            await one.do(SetFixedFrame(frame="odom"))
            await until(lambda: one.ear.last("display_states")["fixed_frame_trouble"] != "")
            await until(lambda: bool(tf.get_subscription_count()))
            tf.publish(transform("odom", "base", 3.25))
            await until(lambda: one.ear.last("display_states")["fixed_frame_trouble"] == "")
            await one.do(GetTf(frame="base", seen_from="odom"))
            pose = one.ear.last("tf_frames")["pose"]
            assert pose["xyz"] == [3.25, 0.0, 0.0]
            assert pose["chain"] == ["odom", "base"]
            await one.do(GetTf(frame="tip", seen_from="odom"))
            assert one.ear.last("tf_frames")["pose"]["xyz"] == pytest.approx([3.75, 0.0, 0.0])
            tree = {each["name"]: each for each in one.ear.last("tf_frames")["frames"]}
            assert tree["base"]["publisher"] == tester.get_fully_qualified_name()
            assert (tree["tip"]["parent"], tree["tip"]["publisher"]) == ("upper", "this robot")
            _, sent = await joined(one.document.scene)
            moved = [each for each in sent if list(each.get("position", ())) == [3.25, 0.0, 0.0]]
            assert moved

    asyncio.run(run())


def test_tf_is_heard_as_long_as_somebody_asks_for_frames(
    endpoint: str, tester: Node, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(document_displays, "_ASKED_FOR_S", 0.5)

    async def run() -> None:
        tf = tester.create_publisher(message(TF), "/tf", 100)
        async with studio(endpoint, tmp_path, rewind_bytes=0) as one:  # else the past hears it, too
            await one.do(ConnectWire())
            await until(lambda: tf.get_subscription_count() == 0)
            frames: list[str] = []
            async with asyncio.timeout(60):
                while "odom" not in frames:
                    tf.publish(transform("odom", "base", 1.0))
                    await one.do(GetTf())
                    frames = [each["name"] for each in one.ear.last("tf_frames")["frames"]]
                    await asyncio.sleep(0.05)
            assert one.ear.last("tf_frames")["fixed"] == "base"
            await until(lambda: tf.get_subscription_count() == 0)

    asyncio.run(run())


def test_frames_of_an_opened_file_are_there_without_ros(tmp_path: Path):
    async def run() -> None:
        async with studio("tcp/127.0.0.1:1", tmp_path) as one:
            await one.do(GetTf(frame="tip", seen_from="upper"))
            answer = one.ear.last("tf_frames")
            assert answer["pose"]["xyz"] == pytest.approx([0.5, 0.0, 0.0])
            assert [each["name"] for each in answer["frames"]] == ["base", "tip", "upper"]
            await one.do(GetTf(frame="tip", seen_from="moon"))
            assert '"moon"' in one.ear.last("tf_frames")["trouble"]

    asyncio.run(run())


def test_in_a_fixed_frame_that_nobody_tells_of_all_rows_offer_the_same_one(tmp_path: Path):
    async def run() -> None:
        async with studio("tcp/127.0.0.1:1", tmp_path) as one:
            await one.do(AddDisplay(kind="TF"))
            await one.do(AddDisplay(kind="Axes"))
            axes = SetDisplayProperty(display="d2", name="Reference Frame", value="tip")
            await one.do(axes)
            await one.do(SetFixedFrame(frame="mop"))
            await until(
                lambda: (said(one), said(one, 1)) == (["not_connected_frame"], ["no_frame"])
            )
            states = one.ear.last("display_states")["states"]
            offers = [state["remarks"][0]["mend"]["command"]["frame"] for state in states]
            assert offers == ["base", "base"]

    asyncio.run(run())


def test_a_display_of_the_owners_own_keeps_its_place_while_its_file_is_not_here(tmp_path: Path):
    folder = tmp_path / "own"
    folder.mkdir()
    path = folder / "battery.py"
    path.write_text(example())

    async def with_its_folder() -> None:
        plugins = Plugins((folder,))
        plugins.start()
        await plugins.ready.wait()
        async with studio("tcp/127.0.0.1:1", tmp_path) as one:
            one.document.live.use(plugins)
            await one.do(AddDisplay(kind="plugins/Battery"))
            await one.do(SetDisplayProperty(display="d1", name="Low", value=0.7))
            await until(lambda: said(one) == ["no_topic"])
            assert (listed(one)[0]["name"], listed(one)[0]["values"]) == ("Battery", {"Low": 0.7})
            path.unlink()
            await until(lambda: said(one) == ["not_here"])
            path.write_text(example())
            await until(lambda: said(one) == ["no_topic"])
            assert listed(one)[0]["values"] == {"Low": 0.7}
            await plugins.close()

    async def without_it() -> None:
        async with studio("tcp/127.0.0.1:1", tmp_path) as one:
            await until(lambda: said(one) == ["not_here"])
            states = one.ear.last("display_states")["states"]
            assert "--displays" in states[0]["remarks"][0]["sentence"]
            await one.do(ArrangeDisplay(display="d1", name="Charge"))
            kept = one.document.live.kept.displays
            assert [(each.kind, each.name, dict(each.values)) for each in kept] == [
                ("plugins/Battery", "Charge", {"Low": 0.7})
            ]
            with pytest.raises(DisplayError, match="--displays"):
                await one.do(AddDisplay(kind="plugins/Battery"))

    asyncio.run(with_its_folder())
    asyncio.run(without_it())


def test_without_a_router_a_display_says_so_and_stays(tmp_path: Path):
    async def run() -> None:
        async with studio("tcp/127.0.0.1:1", tmp_path) as one:
            await one.do(AddDisplay(kind="Path", topic="/plan"))
            await until(lambda: said(one) == ["not_connected"])
            await one.do(GetTopics())
            assert one.ear.last("topics")["topics"] == []

    asyncio.run(run())


def test_topics_are_listed_with_the_display_that_shows_what_is_published(
    endpoint: str, tester: Node, tmp_path: Path
):
    async def run() -> None:
        tester.create_publisher(message(POSE), "/aim", 10)
        async with studio(endpoint, tmp_path) as one:
            await one.do(AddDisplay(kind="AccelStamped", topic="/aim"))
            await until(lambda: said(one) == ["other_type"])
            rows: dict[str, Any] = {}
            async with asyncio.timeout(60):
                while "/aim" not in rows:
                    await one.do(GetTopics())
                    rows = {row["name"]: row for row in one.ear.last("topics")["topics"]}
            assert (rows["/aim"]["kind"], rows["/aim"]["types"]) == ("Pose", [POSE])

    asyncio.run(run())


def test_a_topic_of_another_type_offers_the_display_that_shows_it(
    endpoint: str, tester: Node, tmp_path: Path
):
    async def run() -> None:
        tester.create_publisher(message(POSE), "/other", 10)
        async with studio(endpoint, tmp_path) as one:
            await one.do(AddDisplay(kind="Path", topic="/other"))
            await until(lambda: said(one) == ["other_type"])
            remark = one.ear.last("display_states")["states"][0]["remarks"][0]
            assert remark["mend"]["command"] == {
                "type": "add_display",
                "kind": "Pose",
                "topic": "/other",
            }

    asyncio.run(run())


def test_displays_are_set_arranged_copied_and_removed_and_are_there_the_next_time(tmp_path: Path):
    async def run() -> None:
        async with studio("tcp/127.0.0.1:1", tmp_path) as one:
            await one.do(AddDisplay(kind="Path"))
            await one.do(AddDisplay(kind="Range"))
            path, cone = (each["id"] for each in listed(one))
            await one.do(SetDisplayProperty(display=path, name="Alpha", value=7))
            assert listed(one)[0]["values"]["Alpha"] == 1.0
            await one.do(ArrangeDisplay(display=path, name="Plan", group="Nav", before=""))
            await one.do(DuplicateDisplay(display=path))
            await one.do(RemoveDisplay(display=cone))
            await one.do(SwitchDisplays(group="Nav", enabled=False))
            assert [(each["name"], each["group"]) for each in listed(one)] == [
                ("Plan", "Nav"),
                ("Plan 2", "Nav"),
            ]
            with pytest.raises(DisplayError):
                await one.do(AddDisplay(kind="Moon"))
            with pytest.raises(DisplayError):
                await one.do(SetDisplayProperty(display=path, name="Alpha", value="red"))
            with pytest.raises(CommandError):
                await one.do(RemoveDisplay(display=cone))
            with pytest.raises(CommandError):
                await one.do(ArrangeDisplay(display=path, name=" "))
            assert len(listed(one)) == 2
        async with studio("tcp/127.0.0.1:1", tmp_path) as again:
            assert [each["name"] for each in listed(again)] == ["Plan", "Plan 2"]
            assert listed(again)[0]["values"]["Alpha"] == 1.0
            assert again.ear.last("live_displays")["groups_off"] == ["Nav"]

    asyncio.run(run())


def test_groups_in_groups_are_moved_hidden_removed_and_put_back(tmp_path: Path):
    async def run() -> None:
        async with studio("tcp/127.0.0.1:1", tmp_path) as one:
            for kind in ("Path", "Range", "TF"):
                await one.do(AddDisplay(kind=kind))
            await one.do(ArrangeDisplay(display="d1", group=" Nav / Local "))
            await one.do(ArrangeDisplay(display="d2", group="Nav"))
            await one.do(ArrangeGroup(group="Nav", before=""))
            assert [each["id"] for each in listed(one)] == ["d3", "d1", "d2"]
            await one.do(ArrangeGroup(group="Nav", to="All/Nav", before="d3"))
            paths = [each["group"] for each in listed(one)]
            assert paths == ["All/Nav/Local", "All/Nav", ""]
            await one.do(SwitchDisplays(group="All", enabled=False))
            await until(lambda: said(one) == ["group_off"])
            remark = one.ear.last("display_states")["states"][0]["remarks"][0]
            assert remark["mend"]["command"]["group"] == "All"
            before = listed(one)
            await one.do(RemoveDisplay(group="All/Nav"))
            assert [each["id"] for each in listed(one)] == ["d3"]
            await one.do(RestoreDisplays(displays=("d1", "d2")))
            assert listed(one) == before
            assert one.ear.last("live_displays")["groups_off"] == ["All"]
            with pytest.raises(CommandError, match="too long ago"):
                await one.do(RestoreDisplays(displays=("d1",)))
            await one.do(SwitchDisplays(enabled=True))
            assert one.ear.last("live_displays")["groups_off"] == []
            with pytest.raises(CommandError, match="no group"):
                await one.do(RemoveDisplay())
            assert len(listed(one)) == 3

    asyncio.run(run())


def test_poses_of_another_form_are_told_of_and_not_drawn(endpoint: str, tmp_path: Path):
    types = TypeLibrary("jazzy")
    types.add_texts({POSE: "std_msgs/Header header\ngeometry_msgs/Pose pose\nfloat64 error_m\n"})

    async def run(stranger: Node) -> None:
        poses = stranger.create_publisher(types.message(POSE), "/strange_aim", 10)
        async with studio(endpoint, tmp_path) as one:
            await one.do(AddDisplay(kind="Pose", topic=poses.topic_name))
            await until(lambda: said(one) == ["other_hash"])
            with node_at(endpoint, "late") as known:
                known.create_publisher(message(POSE), poses.topic_name, 10)
                await until(lambda: said(one) == ["no_message"])
            await until(lambda: said(one) == ["other_hash"])

    with node_at(endpoint, "stranger", types) as stranger:
        asyncio.run(run(stranger))


def test_a_broken_message_says_so_and_what_was_drawn_before_stays(
    endpoint: str, tester: Node, tmp_path: Path
):
    async def run() -> None:
        poses = tester.create_publisher(message(POSE), "/aim2", 10)
        async with studio(endpoint, tmp_path) as one:
            await aim(one, poses, pose_at("tip", 0.0, 0))
            await is_at(one, [0.5, 0.0, 0.0])
            bad = pose_at("tip", 0.0, 0)
            bad.pose.position.x = math.nan
            poses.publish(bad)
            await until(lambda: said(one) not in (["ok"], [""], ["stamp_zero"]))

    asyncio.run(run())


def test_a_topic_without_a_slash_is_the_one_that_has_it_and_no_topic_says_so_alone(
    endpoint: str, tester: Node, tmp_path: Path
):
    async def run() -> None:
        poses = tester.create_publisher(message(POSE), "/aim3", 10)
        async with studio(endpoint, tmp_path) as one:
            await one.do(AddDisplay(kind="Pose", topic="/no topic"))
            await one.do(AddDisplay(kind="Pose", topic=" aim3 "))
            assert listed(one)[1]["topic"] == "/aim3"
            await until(lambda: said(one) == ["not_heard"])
            await until(lambda: bool(poses.get_subscription_count()))

    asyncio.run(run())


def test_while_no_page_is_there_nothing_is_heard(
    endpoint: str, tester: Node, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(document_displays, "_UNSEEN_S", 0.2)

    async def run() -> None:
        poses = tester.create_publisher(message(POSE), "/aim4", 10)
        async with studio(endpoint, tmp_path) as one:
            await one.do(AddDisplay(kind="Pose", topic="/aim4"))
            await until(lambda: bool(poses.get_subscription_count()))
            one.document.audience.remove(one.ear)
            await until(lambda: poses.get_subscription_count() == 0)
            one.document.attach(one.ear)
            await until(lambda: bool(poses.get_subscription_count()))

    asyncio.run(run())


def test_a_slider_that_is_drawn_along_is_kept_where_it_ended(tmp_path: Path):
    async def run() -> None:
        async with studio("tcp/127.0.0.1:1", tmp_path) as one:
            await one.do(AddDisplay(kind="Path"))
            path = listed(one)[0]["id"]
            for step in range(100):
                change = SetDisplayProperty(display=path, name="Alpha", value=step / 100)
                await one.do(change)
        async with studio("tcp/127.0.0.1:1", tmp_path) as again:
            assert listed(again)[0]["values"]["Alpha"] == 0.99

    asyncio.run(run())

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.displays.drawing import Placed, Points, Text
from studio.errors import SceneError
from studio.scene.opened_frames import Message, Slot, closed
from studio.scene.relayed import RelayedScene
from studio.scene.wire import Packer
from tests.support.live_shapes import UPRIGHT, at, every_shape
from tests.support.page_state import WatchingPeer, content_of
from tests.support.relayed_view import RelayedView, relayed
from tests.support.robots import rover
from tests.support.viser_frames import Peer, eventually, messages_of, types_of
from tests.support.watched_scene import URI, poses_of, robot_with_mesh, triangle

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.displays.drawing import Shape

SHAPES = every_shape()
HULL = "package://parts/hull.stl"


def cloud(count: int, size_m: float = 0.1, seed: int = 0) -> Points:
    numbers = np.random.default_rng(seed)
    positions = numbers.random((count, 3), np.float32)
    return Points(positions, numbers.integers(0, 255, (count, 3), np.uint8), size_m)


def drawn(**shapes: Shape) -> dict[str, Placed]:
    return {"scan": Placed("laser", 0, dict(shapes))}


def draw(view: RelayedView, action: tuple[str, int, int]) -> None:
    """One of the things that happen in a scene; which, and two numbers that it takes."""
    kind, one, two = action
    scene, live = view.scene, view.scene.live
    display = str(one % 3)
    poses = {"scan": at(two, 0), **{name: at(0, two) for name in SHAPES}}
    names = [name for index, name in enumerate(SHAPES) if (index * 7 + two) % 3 == 0]
    does: dict[str, Callable[[], Any]] = {
        "show": lambda: scene.show(rover(0.1 + 0.01 * (one % 3)), None),
        "show another": lambda: scene.show(robot_with_mesh(1 + one % 2, collision=two == 0), None),
        "mesh": lambda: scene.provide_mesh(URI, triangle(str(one)) if two else None),
        "hull": lambda: scene.provide_mesh(HULL, triangle("hull")),
        "pose": lambda: scene.set_poses(*moved(one, two)),
        "place": lambda: scene.place_robot((1.0, 0.0, 0.0, 0.0), (float(one), 0.0, 0.0)),
        "layer": lambda: scene.set_display(
            "robot", ("visual", "collision", "frames", "names", "axes", "com")[one % 6], two > 1
        ),
        "fade": lambda: scene.set_display("robot", "opacity", one / 8),
        "grid": lambda: scene.set_display("grid", "visible", bool(two % 2)),
        "ghost": lambda: scene.ghost.show(rover(0.1 + 0.01 * (one % 3))),
        "points": lambda: live.apply(display, drawn(c=cloud(one + 1, 0.1 + two, one)), poses),
        "fewer": lambda: live.apply(display, drawn(t=Text(f"{two}")), poses),
        "shapes": lambda: live.apply(
            display, {n: Placed("map", 0, {n: SHAPES[n]}) for n in names}, poses
        ),
        "move": lambda: live.place(display, {"scan": at(one, two) if two else None}),
        "hide": lambda: live.show(display, visible=two > 1),
        "drop": lambda: live.drop(display),
    }
    does[kind]()


def moved(one: int, two: int) -> tuple[tuple[str, ...], Any]:
    names, poses = poses_of(rover())
    poses[one % len(names), 4 + two % 3] += 0.1 * (1 + one)
    return names, poses


KINDS = (
    "show", "show another", "mesh", "hull", "pose", "place", "layer", "fade", "grid", "ghost",
    "points", "fewer", "shapes", "move", "hide", "drop",
)  # fmt: skip
DRAWS = st.tuples(st.sampled_from(KINDS), st.integers(0, 7), st.integers(0, 3))
HAPPENS = st.sampled_from(("flush", "stall", "go on", "slow line", "fast line", "cut", "join"))


@settings(max_examples=60, deadline=None)
@given(st.lists(st.one_of(DRAWS, HAPPENS), max_size=40))
def test_whatever_is_drawn_every_page_of_a_relay_has_what_a_page_of_the_origin_has(
    story: list[tuple[str, int, int] | str],
):
    async def scenario(view: RelayedView) -> None:
        steady, stalled = await view.seated(), await view.seated()
        peers = [steady, stalled]
        for event in story:
            if isinstance(event, tuple):
                draw(view, event)
            elif event == "join":
                peers.append(await view.seated())
            else:
                await happens(view, stalled, event)
        view.scene.flush()
        view.line.drain()
        stalled.drain()
        view.scene.flush()
        peers.append(await view.seated())
        wanted = await view.state_at_the_origin()
        for peer in peers:
            state = peer.look()
            assert state.nodes == wanted.nodes
            assert state.said == wanted.said
            assert state.ends_of_replay == 1

    relayed(scenario)


async def happens(view: RelayedView, stalled: Peer, event: str) -> None:
    match event:
        case "flush":
            view.scene.flush()
        case "stall":
            stalled.stall()
        case "go on":
            stalled.drain()
        case "slow line":
            view.line.stall()
        case "fast line":
            view.line.drain()
        case _:
            await view.cut()
            await view.connect()


def test_pages_in_step_get_the_very_bytes_of_the_origin():
    async def scenario(view: RelayedView) -> None:
        first, second = await view.seated(), await view.seated()
        assert first.frames[-1] is second.frames[-1] is view.line.carried[-1]
        view.scene.show(rover(), None)
        view.scene.flush()
        assert first.frames[-1] is second.frames[-1] is view.line.carried[-1]
        assert len(first.frames) == 2

    relayed(scenario)


def test_pages_that_missed_the_same_share_one_frame_of_what_still_counts():
    async def scenario(view: RelayedView) -> None:
        view.scene.show(rover(), None)
        view.scene.flush()
        slow, slower = await view.seated(), await view.seated()
        for peer in (slow, slower):
            peer.look()
            peer.stall()
        for x in range(1, 50):
            view.scene.set_poses(("mast",), np.array([[1.0, 0, 0, 0, x, 0, 0]]))
            view.scene.flush()
        slow.drain()
        slower.drain()
        assert slow.frames[0] is slower.frames[0]
        moves = [m for m in messages_of(slow.frames[0]) if m["type"] == "SetPositionMessage"]
        assert [m["position"] for m in moves] == [[49.0, 0.0, 0.0]]
        late, later = await view.seated(), await view.seated()
        assert late.frames[0] is later.frames[0]

    relayed(scenario)


def test_a_page_that_was_slow_gets_the_state_of_now_without_being_asked():
    async def scenario(view: RelayedView) -> None:
        slow = await view.seated()
        slow.look()
        slow.stall()
        view.scene.show(rover(), None)
        view.scene.flush()
        slow.go_on()
        await eventually(lambda: bool(slow.frames))
        assert slow.look() == await view.state_at_the_origin()

    relayed(scenario)


def test_a_page_that_comes_before_the_first_frame_waits_for_it():
    async def scenario() -> None:
        view = RelayedView()
        peer = WatchingPeer()
        peer.serving = asyncio.create_task(view.relay.serve(peer, lambda _: True))
        await asyncio.sleep(0)
        assert peer.frames == []
        await view.connect()
        assert peer.frames[0] is view.line.carried[0]
        assert peer.look() == await view.state_at_the_origin()
        view.relay.close()
        view.scene.close()
        await asyncio.sleep(0)

    asyncio.run(scenario())


def test_a_first_frame_that_comes_again_sends_what_differs_and_nothing_else():
    async def scenario(view: RelayedView) -> None:
        view.scene.show(rover(), None)
        view.scene.live.apply("7", drawn(c=cloud(9), t=Text("a")), {"scan": UPRIGHT})
        view.scene.live.apply("8", drawn(c=cloud(9)), {"scan": UPRIGHT})
        view.scene.flush()
        peer = await view.seated()
        peer.look()
        await view.cut()
        await view.connect()
        assert peer.frames == []
        await view.cut()
        view.scene.live.apply("7", drawn(c=cloud(5, seed=1)), {"scan": UPRIGHT})
        view.scene.live.drop("8")
        view.scene.set_poses(("mast",), np.array([[1.0, 0, 0, 0, 3, 0, 0]]))
        await view.connect()
        (frame,) = peer.frames
        told = [(m["type"].removesuffix("Message"), m["name"]) for m in messages_of(frame)]
        assert told == [
            ("RemoveSceneNode", "/live/8/scan/c.points"),
            ("RemoveSceneNode", "/live/8/scan"),
            ("RemoveSceneNode", "/live/8"),
            ("RemoveSceneNode", "/live/7/scan/t.plain"),
            ("SceneNodeUpdate", "/live/7/scan/c.points"),
            ("SetPosition", "/robot/mast"),
        ]
        assert peer.look() == await view.state_at_the_origin()

    relayed(scenario)


def test_another_origin_in_the_place_of_the_first_brings_its_view_to_all_pages():
    async def scenario(view: RelayedView) -> None:
        view.scene.show(rover(), None)
        view.scene.live.apply("7", drawn(c=cloud(9)), {"scan": UPRIGHT})
        view.scene.flush()
        steady, stalled = await view.seated(), await view.seated()
        await view.cut()
        stalled.stall()
        view.scene.close()
        other = RelayedView()
        other.relay.close()
        other.relay = view.relay
        other.scene.show(robot_with_mesh(), None)
        other.scene.flush()
        await other.connect()
        wanted = await other.state_at_the_origin()
        stalled.drain()
        assert steady.look() == wanted
        assert stalled.look() == wanted
        other.scene.close()

    relayed(scenario)


SPOILED: dict[str, Callable[[bytes], bytes]] = {
    "nothing": lambda _: b"",
    "nonsense": lambda _: b"nonsense",
    "short": lambda frame: frame[:-1],
    "long": lambda frame: frame + b"\0",
    "damaged": lambda frame: frame[:20] + b"\xff" + frame[21:],
    "length": lambda frame: bytes([frame[0] ^ 1]) + frame[1:],
    "packed length": lambda frame: frame[:8] + b"\xff" * 8 + frame[16:],
}


@pytest.mark.parametrize("how", SPOILED)
@pytest.mark.parametrize("is_first", [True, False])
def test_a_frame_that_is_none_is_refused_and_changes_nothing(how: str, is_first: bool):
    async def scenario(view: RelayedView) -> None:
        view.scene.show(rover(), None)
        view.scene.flush()
        peer = await view.seated()
        with pytest.raises(SceneError, match="not one of viser's"):
            view.relay.take(SPOILED[how](view.line.carried[-1]), is_first=is_first)
        assert len(peer.frames) == 1
        late = await view.seated()
        assert late.look() == peer.look() == await view.state_at_the_origin()

    relayed(scenario)


def test_a_frame_before_the_first_is_refused():
    async def scenario(view: RelayedView) -> None:
        with pytest.raises(SceneError, match="before the first"):
            RelayedScene(view.loop).take(view.line.carried[0], is_first=False)

    relayed(scenario)


def test_what_a_page_says_goes_nowhere_and_what_no_page_says_ends_it():
    async def scenario(view: RelayedView) -> None:
        polite, loud, rude = await view.seated(), await view.seated(), await view.seated()
        polite.send(type="ViewerCameraMessage")
        loud.send_raw(bytes(2 << 20))
        rude.send_raw(b"nonsense")
        await eventually(lambda: loud.closed_with == 1009 and rude.closed_with == 1007)
        assert polite.closed_with is None
        other = Peer()
        await view.relay.serve(other, lambda _: True, "viser-v0.0.1")
        assert other.closed_with == 1002

    relayed(scenario)


def test_closing_the_relay_ends_every_page_and_a_page_that_left_is_forgotten():
    async def scenario(view: RelayedView) -> None:
        gone, there = await view.seated(), await view.seated()
        gone.look()
        gone.leave()
        assert gone.serving is not None
        assert there.serving is not None
        await gone.serving
        view.scene.show(rover(), None)
        view.scene.flush()
        assert gone.frames == []
        view.relay.close()
        async with asyncio.timeout(60):
            await there.serving
        view.relay.take(view.line.carried[-1], is_first=False)
        await view.relay.serve(Peer(), lambda _: True)

    relayed(scenario)


def test_a_cloud_that_streams_is_kept_once():
    async def scenario(view: RelayedView) -> None:
        for number in range(20):
            view.scene.live.apply("7", drawn(c=cloud(100_000, seed=number)), {"scan": UPRIGHT})
            view.scene.flush()
        late = await view.seated()
        one_cloud = 100_000 * 9
        assert len(late.frames[0]) < one_cloud + 100_000
        assert late.look() == await view.state_at_the_origin()

    relayed(scenario)


def test_nodes_that_come_and_go_leave_nothing_behind():
    async def scenario(view: RelayedView) -> None:
        peer = await view.seated()
        before = view.relay.message_count
        for number in range(200):
            view.scene.live.apply("7", drawn(**{f"t{number}": Text("a")}), {"scan": UPRIGHT})
            view.scene.flush()
            peer.look()
        view.scene.live.drop("7")
        view.scene.flush()
        assert view.relay.message_count < before + 150
        assert "RemoveSceneNodeMessage" not in types_of(content_of((await view.seated()).frames[0]))

    relayed(scenario)


@pytest.mark.parametrize(
    "fields",
    [
        {"type": "RunJavascriptMessage", "source": "alert(1)"},
        {"type": "GuiHtmlMessage", "uuid": "a", "container_uuid": "root"},
        {"type": "GuiPlotlyMessage", "uuid": "a", "container_uuid": "root"},
        {"type": "LocalStorageClearMessage"},
        {"type": "ThemeConfigurationMessage", "titlebar_content": {"buttons": []}},
    ],
)
@pytest.mark.parametrize("is_first", [True, False])
def test_nothing_is_shown_that_would_act_in_the_page_of_who_looks(
    fields: dict[str, Any],
    is_first: bool,
):
    async def scenario(view: RelayedView) -> None:
        await view.connect()
        message = Message(fields["type"], Slot("k", None, None), msgspec.msgpack.encode(fields))
        with pytest.raises(SceneError, match="is no part of a 3D view"):
            view.relay.take(closed([message], 0.0, Packer()), is_first=is_first)
        assert (await view.seated()).look().ends_of_replay  # which it shows as before

    relayed(scenario)

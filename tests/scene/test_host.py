# viser's inside is looked at from outside here.
# pyright: reportPrivateUsage=false, reportUnknownMemberType=false, reportUnknownVariableType=false
from __future__ import annotations

import asyncio
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
import viser
from hypothesis import given, settings
from hypothesis import strategies as st
from viser import _messages

from studio.errors import SceneError
from studio.scene import VIEWER_MESSAGES, DocumentScene
from tests.support.robots import rover
from tests.support.viser_frames import Peer, eventually, joined, sit_down, types_of

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable

CAMERA = {
    "type": "ViewerCameraMessage",
    "wxyz": (1, 0, 0, 0),
    "position": (0, 0, 0),
    "fov": 1,
    "near": 0.1,
    "far": 10,
    "image_height": 100,
    "image_width": 100,
    "look_at": (1, 0, 0),
    "up_direction": (0, 0, 1),
}


def in_scene(scenario: Callable[[DocumentScene], Awaitable[None]]) -> None:
    """Run a scenario with a scene on a loop of its own."""

    async def run() -> None:
        scene = DocumentScene(asyncio.get_running_loop())
        try:
            await scenario(scene)
        finally:
            scene.close()
            await asyncio.sleep(0)

    asyncio.run(run())


def listening_sockets() -> set[str]:
    """Inodes of the sockets of this process that listen."""
    own = {link.readlink().name for link in Path("/proc/self/fd").iterdir() if link.is_symlink()}
    found: set[str] = set()
    for table in ("/proc/net/tcp", "/proc/net/tcp6"):
        for line in Path(table).read_text().splitlines()[1:]:
            fields = line.split()
            if fields[3] == "0A" and f"socket:[{fields[9]}]" in own:
                found.add(fields[9])
    return found


@pytest.mark.skipif(not Path("/proc/net/tcp").exists(), reason="needs Linux's list of sockets")
def test_a_scene_opens_no_port_and_starts_no_thread(capfd: pytest.CaptureFixture[str]):
    import threading

    async def scenario(_: DocumentScene) -> None:
        assert listening_sockets() == before
        assert set(threading.enumerate()) == threads

    before, threads = listening_sockets(), set(threading.enumerate())
    in_scene(scenario)
    assert capfd.readouterr() == ("", "")


def test_another_version_of_viser_is_refused_with_what_to_do(monkeypatch: pytest.MonkeyPatch):
    async def scenario() -> None:
        with pytest.raises(SceneError, match=r"install viser==1\.1\.1"):
            DocumentScene(asyncio.get_running_loop())

    monkeypatch.setattr(viser, "__version__", "9.9.9")
    asyncio.run(scenario())


def test_a_page_of_another_version_is_closed_as_a_protocol_error():
    async def scenario(scene: DocumentScene) -> None:
        peer = Peer()
        await scene.serve(peer, lambda _: True, "viser-v0.0.1")
        assert peer.closed_with == 1002
        assert peer.frames == []

    in_scene(scenario)


def test_one_who_joins_late_gets_the_whole_state_and_then_what_changes():
    async def scenario(scene: DocumentScene) -> None:
        scene.show(rover(), None)
        scene.flush()
        peer, state = await joined(scene)
        assert "/robot/upper%20arm/visual/0" in {m.get("name") for m in state}
        assert types_of(state)[-1] == "ReplayDoneMessage"
        scene.set_poses(("mast",), np.array([[1, 0, 0, 0, 1, 2, 3]]))
        scene.flush()
        assert types_of(peer.read()) == ["SetOrientationMessage", "SetPositionMessage"]

    in_scene(scenario)


def test_all_who_look_get_the_very_same_bytes():
    async def scenario(scene: DocumentScene) -> None:
        peers = [(await joined(scene))[0] for _ in range(3)]
        scene.show(rover(), None)
        scene.flush()
        frames = [peer.frames[-1] for peer in peers]
        assert frames[0] is frames[1] is frames[2]

    in_scene(scenario)


def test_an_atomic_batch_of_a_thousand_links_is_one_frame():
    async def scenario(scene: DocumentScene) -> None:
        from studio.robot.values import Link, Robot

        links = {f"link{number}": Link(f"link{number}") for number in range(1000)}
        scene.show(Robot("many", links), None)
        peer, _ = await joined(scene)
        poses = np.zeros((1000, 7))
        poses[:, 0] = 1
        scene.set_poses(tuple(links), poses)
        scene.flush()
        assert len(peer.frames) == 1
        assert len(peer.read()) == 2000

    in_scene(scenario)


def test_nothing_is_sent_from_the_middle_of_an_atomic_batch():
    async def scenario(scene: DocumentScene) -> None:
        peer, _ = await joined(scene)
        with scene.viser.atomic():
            scene.viser.scene.add_frame("/a")
            scene.flush()
            await asyncio.sleep(0)
            late = Peer()
            sit_down(scene, late)
            await asyncio.sleep(0.05)
            assert peer.frames == []
            assert late.frames == []
        await peer.until(lambda read: "FrameMessage" in types_of(read))
        await late.until(lambda read: "ReplayDoneMessage" in types_of(read))

    in_scene(scenario)


def test_a_stalled_page_costs_nothing_and_gets_the_state_of_now_when_it_reads_again():
    async def scenario(scene: DocumentScene) -> None:
        scene.show(rover(), None)
        slow, _ = await joined(scene)
        fast, _ = await joined(scene)
        slow.stall()
        pose = np.array([[1.0, 0, 0, 0, 0, 0, 0]])
        for number in range(200):
            pose[0, 4] = number
            scene.set_poses(("mast",), pose)
            scene.flush()
        assert slow.frames == []
        assert len(fast.read()) == 1 + 200
        slow.go_on()
        caught_up = await slow.until(lambda read: len(read) > 0)
        assert [m["position"] for m in caught_up if m["type"] == "SetPositionMessage"] == [
            [199.0, 0.0, 0.0]
        ]
        assert slow.frames == []

    in_scene(scenario)


def test_a_page_that_has_room_again_gets_the_state_of_now_at_once():
    async def scenario(scene: DocumentScene) -> None:
        scene.show(rover(), None)
        slow, _ = await joined(scene)
        slow.stall()
        for x in (1.0, 2.0):
            scene.set_poses(("mast",), np.array([[1.0, 0, 0, 0, x, 0, 0]]))
            scene.flush()
        with scene.viser.atomic():
            slow.drain()
            assert slow.frames == []
        slow.drain()
        assert [m["position"] for m in slow.read() if m["type"] == "SetPositionMessage"] == [
            [2.0, 0.0, 0.0]
        ]

    in_scene(scenario)


def test_a_stalled_page_hears_of_what_was_removed_meanwhile():
    async def scenario(scene: DocumentScene) -> None:
        slow, _ = await joined(scene)
        handle = scene.viser.scene.add_frame("/gone")
        scene.flush()
        slow.read()
        slow.stall()
        handle.remove()
        scene.flush()
        await joined(scene)  # viser sweeps tombstones that everybody has seen when one joins
        slow.go_on()
        caught_up = await slow.until(lambda read: len(read) > 0)
        assert ("RemoveSceneNodeMessage", "/gone") in {(m["type"], m["name"]) for m in caught_up}

    in_scene(scenario)


def test_a_message_that_leaves_out_one_page_reaches_all_others():
    async def scenario(scene: DocumentScene) -> None:
        first, _ = await joined(scene)
        second, _ = await joined(scene)
        message = _messages.RunJavascriptMessage("1")
        message.excluded_self_client = 0  # type: ignore[assignment]
        scene.viser._websock_server.queue_message(message)
        scene.flush()
        assert types_of(first.read()) == []
        assert types_of(second.read()) == ["RunJavascriptMessage"]

    in_scene(scenario)


def test_what_is_for_one_page_alone_reaches_it_alone():
    async def scenario(scene: DocumentScene) -> None:
        first, _ = await joined(scene)
        second, _ = await joined(scene)
        first.send(**CAMERA)
        await eventually(lambda: bool(scene.viser.get_clients()))
        next(iter(scene.viser.get_clients().values())).scene.add_frame("/mine")
        await first.until(lambda read: "FrameMessage" in types_of(read))
        assert second.read() == []

    in_scene(scenario)


def test_a_viewer_moves_its_camera_and_nothing_else():
    async def scenario(scene: DocumentScene) -> None:
        heard: list[str] = []
        server = scene.viser._websock_server
        for kind in (_messages.ViewerCameraMessage, _messages.GuiUpdateMessage):
            server.register_handler(kind, lambda _, message: heard.append(type(message).__name__))
        peer = Peer()
        sit_down(scene, peer, VIEWER_MESSAGES.__contains__)
        peer.send(type="GuiUpdateMessage", uuid="x", updates={})
        peer.send(**CAMERA)
        await eventually(lambda: bool(heard))
        assert heard == ["ViewerCameraMessage"]
        assert peer.closed_with is None

    in_scene(scenario)


def test_nobody_can_open_a_public_tunnel():
    async def scenario(scene: DocumentScene) -> None:
        asked: list[str] = []

        def allowed(name: str) -> bool:
            asked.append(name)
            return True

        peer = Peer()
        serving = sit_down(scene, peer, allowed)
        peer.send(type="ShareUrlRequest")
        peer.send(type="ShareUrlDisconnect")
        peer.leave()
        await serving
        assert asked == []
        handlers = scene.viser._websock_server._incoming_handlers
        assert _messages.ShareUrlRequest not in handlers

    in_scene(scenario)


def test_cameras_are_passed_on_at_most_once_a_while_and_the_newest_is_not_lost(
    monkeypatch: pytest.MonkeyPatch,
):
    # Longer than a busy machine takes to read a hundred of them.
    monkeypatch.setattr("studio.scene.host.CAMERA_PERIOD_S", 1.0)

    async def scenario(scene: DocumentScene) -> None:
        heard: list[float] = []
        server = scene.viser._websock_server
        server.register_handler(
            _messages.ViewerCameraMessage, lambda _, message: heard.append(message.fov)
        )
        peer = Peer()
        sit_down(scene, peer)
        for number in range(100):
            peer.send(**{**CAMERA, "fov": number})
        await eventually(lambda: heard[-1:] == [99.0])
        assert heard == [0.0, 99.0]

    in_scene(scenario)


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\xc1",
        b"nonsense",
        b"\x81\xa4type\x01",
        b"\x81\xa4type\xa7Nothing",
        b"\x82\xa4type\xb3ViewerCameraMessage\xa4wxyz\x01",
        b"\x81\xa4type\xb3ViewerCameraMessage",
    ],
)
def test_a_malformed_message_ends_that_connection_and_no_other(data: bytes):
    async def scenario(scene: DocumentScene) -> None:
        other, _ = await joined(scene)
        peer = Peer()
        serving = sit_down(scene, peer)
        peer.send_raw(data)
        async with asyncio.timeout(60):
            await serving
        assert peer.closed_with == 1007
        scene.viser.scene.add_frame("/after")
        scene.flush()
        assert "FrameMessage" in types_of(other.read())

    in_scene(scenario)


@settings(max_examples=200, deadline=None)
@given(st.binary(max_size=200))
def test_no_bytes_from_a_page_raise(data: bytes):
    async def scenario(scene: DocumentScene) -> None:
        peer = Peer()
        serving = sit_down(scene, peer)
        peer.send_raw(data)
        peer.leave()
        await serving

    in_scene(scenario)


def test_a_huge_message_ends_the_connection():
    async def scenario(scene: DocumentScene) -> None:
        peer = Peer()
        serving = sit_down(scene, peer)
        peer.send_raw(bytes(2 << 20))
        await serving
        assert peer.closed_with == 1009

    in_scene(scenario)


def test_closing_the_scene_ends_every_connection_without_an_error():
    async def scenario(scene: DocumentScene) -> None:
        peers = [(await joined(scene))[0] for _ in range(3)]
        scene.close()
        for peer in peers:
            assert peer.serving is not None
            async with asyncio.timeout(60):
                await peer.serving

    in_scene(scenario)


def test_a_page_that_left_is_forgotten():
    async def scenario(scene: DocumentScene) -> None:
        peer, _ = await joined(scene)
        peer.leave()
        assert peer.serving is not None
        await peer.serving
        scene.viser.scene.add_frame("/after")
        scene.flush()
        assert peer.frames == []
        server = scene.viser._websock_server
        assert server._client_state_from_id == {}
        assert server._broadcast_buffer.generator_cursors == {}

    in_scene(scenario)


def test_thirty_documents_are_cheap_and_independent():
    async def scenario(first: DocumentScene) -> None:
        others = [DocumentScene(asyncio.get_running_loop()) for _ in range(29)]
        peer, _ = await joined(first)
        for other in others:
            other.show(rover(), None)
            other.flush()
        assert peer.frames == []
        for other in others:
            other.close()

    in_scene(scenario)

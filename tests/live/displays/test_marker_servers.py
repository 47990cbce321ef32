"""Interactive markers over a real router: what a server shows, and what a page does with it."""

from __future__ import annotations

import asyncio
import math
import threading
import time
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING, Any

import pytest

from studio.displays.interactive_markers import InteractiveMarkersDisplay
from studio.errors import CommandError
from studio.live.displays import marker_servers
from studio.live.displays.scene_frames import SceneFrames
from studio.protocol.displays import (
    AddDisplay,
    RemoveDisplay,
    SetDisplayProperty,
    SetFixedFrame,
    SwitchDisplays,
)
from studio.protocol.markers import InteractWithMarker
from studio.ros.interactive_markers import (
    InteractiveMarkerClient,
    InteractiveMarkerServer,
    MenuHandler,
)
from studio.ros.interactive_markers.names import FeedbackEvent, Mode
from studio.ros.messages import message, shared_types
from tests.support.interactive_markers import control_of, moving_marker, pose_at
from tests.support.loop_watch import Stall, stalls
from tests.support.memory_source import MemorySource
from tests.support.open_documents import Ear, until
from tests.support.posed import Posed, arm
from tests.support.wired_studio import TF, Studio, studio

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator
    from pathlib import Path

    from studio.ros.client import Node
    from studio.ros.types.classes import MessageValue

pytestmark = pytest.mark.network

MODES = (Mode.MOVE_AXIS, Mode.BUTTON, Mode.MENU)


class Stage:
    """A server of somebody else, the studio with a display of it, and what the server heard."""

    def __init__(self, one: Studio, node: Node) -> None:
        self.studio, self.node = one, node
        self.types = node.wire.types
        self.heard: list[MessageValue] = []
        self.server = InteractiveMarkerServer(node, "/hands")
        self.display = ""

    async def show(self) -> None:
        """Add the display by the topic of updates."""
        await self.studio.do(AddDisplay(kind="InteractiveMarkers", topic="/hands/update"))
        self.display = self.studio.ear.last("live_displays")["displays"][-1]["id"]

    def insert(self, name: str, x: float = 0.0, **ways: Any) -> None:  # noqa: ANN401
        marker = moving_marker(self.types, name, MODES, **ways)
        marker.pose = pose_at(self.types, x, 0.0, 0.0)
        self.server.insert(marker, feedback_callback=self.heard.append)
        self.server.apply_changes()

    @property
    def views(self) -> dict[str, dict[str, Any]]:
        """What the page knows of the markers, by name."""
        events = [one for one in self.studio.ear.events if one["type"] == "interactive_markers"]
        displays: list[dict[str, Any]] = events[-1]["displays"] if events else []
        return {one["name"]: one for each in displays for one in each["markers"]}

    def place(self, name: str) -> float | None:
        """Where a marker is seen along x, in the fixed frame."""
        shown = self.studio.document.live.shown(self.display)
        pose = (
            shown.poses.get(f"m{self.views[name]['number']}-body") if name in self.views else None
        )
        return pose and round(pose[1][0], 6)

    @property
    def remarks(self) -> list[str]:
        events = [one for one in self.studio.ear.events if one["type"] == "display_states"]
        states: list[dict[str, Any]] = events[-1]["states"] if events else []
        return [one["sentence"] for each in states for one in each["remarks"]]

    def asked(self, name: str, action: str, **ways: Any) -> InteractWithMarker:  # noqa: ANN401
        number = self.views[name]["number"]
        return InteractWithMarker.model_validate(
            {"display": self.display, "marker": number, "control": 0, "action": action, **ways}
        )

    async def act(self, name: str, action: str, ear: Ear | None = None, **ways: Any) -> None:  # noqa: ANN401
        """Do something to a marker, from one page or another."""
        live = self.studio.document.live.markers
        await live.interact(self.asked(name, action, **ways), ear or self.studio.ear)

    def events(self) -> list[str]:
        """The feedback that the server heard, by the names of its events."""
        return [FeedbackEvent(one.event_type).name for one in self.heard]


@asynccontextmanager
async def stage(endpoint: str, folder: Path, node: Node) -> AsyncGenerator[Stage]:
    async with studio(endpoint, folder) as one:
        made = Stage(one, node)
        yield made
        made.server.shutdown()


def test_markers_are_shown_where_their_frames_are_and_go_with_their_server(
    endpoint: str, tmp_path: Path, tester: Node
):
    async def story() -> None:
        async with stage(endpoint, tmp_path, tester) as made:
            made.insert("one", x=0.25, frame="base")
            await made.show()
            settings = made.studio.ear.last("live_displays")["displays"][0]
            assert settings["topic"] == ""
            assert settings["values"]["Interactive Markers Namespace"] == "/hands"
            await until(lambda: made.place("one") == 0.25)
            assert [one["mode"] for one in made.views["one"]["controls"]] == [
                int(one) for one in MODES
            ]

            made.server.set_pose("one", pose_at(made.types, 0.5, 0.0, 0.0))
            made.insert("two", frame="upper")
            await until(lambda: made.place("one") == 0.5 and "two" in made.views)
            await until(lambda: made.remarks == ["Shown."])
            made.server.erase("two")
            made.server.apply_changes()
            await until(lambda: set(made.views) == {"one"})

            await made.studio.do(SwitchDisplays(display=made.display, enabled=False))
            await until(lambda: not made.views)
            await made.studio.do(SwitchDisplays(display=made.display, enabled=True))
            await until(lambda: made.place("one") == 0.5)

            made.server.shutdown()
            await until(
                lambda: not made.views and any("No server on /hands" in r for r in made.remarks)
            )
            made.server = InteractiveMarkerServer(tester, "/hands")
            made.insert("back", x=1.0)
            await until(lambda: made.place("back") == 1.0)
            await made.studio.do(RemoveDisplay(display=made.display))
            await until(lambda: not made.views)

    asyncio.run(story())


def test_a_drag_sends_what_rviz_sends_and_the_servers_poses_wait_for_its_end(
    endpoint: str, tmp_path: Path, tester: Node
):
    async def story() -> None:
        async with stage(endpoint, tmp_path, tester) as made:
            made.insert("one")
            await made.show()
            await until(lambda: made.place("one") == 0.0)
            await made.act("one", "press", mouse_point=(0.1, 0.2, 0.3))
            await made.act(
                "one", "move", position=(0.7, 0.0, 0.0), orientation=(2.0, 0.0, 0.0, 0.0)
            )
            await until(lambda: made.place("one") == 0.7)
            await until(lambda: len(made.heard) == 3)
            made.server.set_pose("one", pose_at(made.types, 9.0, 0.0, 0.0))
            made.insert("other")  # applies both
            await until(lambda: "other" in made.views)
            assert made.place("one") == 0.7, "it is held"
            await made.act("one", "hold")
            await made.act("one", "release", position=(0.8, 0.0, 0.0))
            await until(lambda: len(made.heard) == 6 and made.place("one") == 9.0)
            assert made.events() == [
                *(
                    "POSE_UPDATE",
                    "MOUSE_DOWN",
                    "POSE_UPDATE",
                    "KEEP_ALIVE",
                    "POSE_UPDATE",
                    "MOUSE_UP",
                )
            ]
            down, moved = made.heard[1], made.heard[2]
            assert (down.marker_name, down.control_name) == ("one", "move_axis")
            assert (down.client_id, down.header.frame_id) == ("/studio", "base")
            assert down.mouse_point_valid
            assert (down.mouse_point.x, down.mouse_point.z) == (0.1, 0.3)
            assert (moved.pose.position.x, moved.pose.orientation.w) == (0.7, 1.0)
            assert not moved.mouse_point_valid
            assert [one.pose.position.x for one in made.heard[4:]] == [0.8, 0.8]

    asyncio.run(story())


def test_buttons_and_menus_are_heard_and_programs_are_not_started(
    endpoint: str, tmp_path: Path, tester: Node
):
    async def story() -> None:
        menu = MenuHandler()
        chosen: list[int] = []
        menu.insert("Say", callback=lambda feedback: chosen.append(feedback.menu_entry_id))
        menu.insert("Box")
        menu.set_check_state(2, MenuHandler.UNCHECKED)
        menu.insert("Run", command_type=1, command="evil program")
        async with stage(endpoint, tmp_path, tester) as made:
            made.insert("one")
            menu.apply(made.server, "one")
            made.server.apply_changes()
            await made.show()
            await until(lambda: "one" in made.views)
            assert made.views["one"]["menu"] == [
                {"id": 1, "parent": 0, "title": "Say", "checked": None},
                {"id": 2, "parent": 0, "title": "Box", "checked": False},
                {"id": 3, "parent": 0, "title": "Run", "checked": None},
            ]
            for clicked in (True, False):
                await made.act("one", "press", control=1)
                await made.act("one", "release", control=1, clicked=clicked)
            await made.act("one", "select", control=2, entry=1)
            await until(lambda: chosen == [1] and len(made.heard) == 9)
            assert made.events().count("BUTTON_CLICK") == 1
            assert made.events()[2:5] == ["BUTTON_CLICK", "POSE_UPDATE", "MOUSE_UP"]
            with pytest.raises(CommandError, match="starts no programs"):
                await made.act("one", "select", entry=3)
            with pytest.raises(CommandError, match="not in the menu"):
                await made.act("one", "select", entry=4)

    asyncio.run(story())


def test_of_two_pages_the_first_holds_the_marker_until_it_lets_go_or_is_silent(
    endpoint: str, tmp_path: Path, tester: Node, monkeypatch: pytest.MonkeyPatch
):
    async def story() -> None:
        monkeypatch.setattr(marker_servers, "_SILENCE_S", 0.3)
        async with stage(endpoint, tmp_path, tester) as made:
            made.insert("one")
            await made.show()
            await until(lambda: made.place("one") == 0.0)
            other = Ear()
            await made.act("one", "press")
            for action in ("press", "move", "release"):
                with pytest.raises(CommandError, match='Somebody else moves "one"'):
                    await made.act("one", action, other, position=(5.0, 0.0, 0.0))
            assert made.place("one") == 0.0
            await until(lambda: made.events()[-1:] == ["MOUSE_UP"])  # the page says no more
            with pytest.raises(CommandError, match="not held any more"):
                await made.act("one", "move", position=(5.0, 0.0, 0.0))
            await made.act("one", "press", other)
            await made.act("one", "release", other)

    asyncio.run(story())


def test_a_server_that_dies_in_a_drag_ends_it(endpoint: str, tmp_path: Path, tester: Node):
    async def story() -> None:
        async with stage(endpoint, tmp_path, tester) as made:
            made.insert("one")
            await made.show()
            await until(lambda: made.place("one") == 0.0)
            await made.act("one", "press")
            asked = made.asked("one", "move", position=(1.0, 0.0, 0.0))
            made.server.shutdown()
            await until(lambda: not made.views)
            with pytest.raises(CommandError, match="not there any more"):
                await made.studio.document.live.markers.interact(asked, made.studio.ear)

    asyncio.run(story())


def test_a_marker_with_a_stamp_is_told_of_in_the_fixed_frame(
    endpoint: str, tmp_path: Path, tester: Node
):
    async def story() -> None:
        stamped = message("geometry_msgs/msg/TransformStamped")(child_frame_id="base")
        stamped.header.frame_id, stamped.header.stamp.sec = "map", 100
        stamped.transform.translation.x, stamped.transform.rotation.w = 10.0, 1.0
        transforms = tester.create_publisher(message(TF), "/tf", 10)
        tester.create_timer(0.05, lambda: transforms.publish(message(TF)(transforms=[stamped])))
        async with stage(endpoint, tmp_path, tester) as made:
            await made.studio.do(SetFixedFrame(frame="map"))
            marker = moving_marker(made.types, "one")
            marker.header.stamp.sec = 100
            made.server.insert(marker, feedback_callback=made.heard.append)
            made.insert("locked")
            await made.show()
            await until(lambda: made.place("one") == made.place("locked") == 10.0)
            for name in ("one", "locked"):
                await made.act(name, "press")
                await made.act(
                    name, "release", position=(1.0, 0.0, 0.0), mouse_point=(2.0, 0.0, 0.0)
                )
            await until(lambda: len(made.heard) == 8)
            of_stamped, of_locked = made.heard[3], made.heard[7]
            assert of_stamped.header.frame_id == "map"
            assert of_stamped.header.stamp.sec == 0
            assert (of_stamped.pose.position.x, of_stamped.mouse_point.x) == (11.0, 12.0)
            assert of_locked.header.frame_id == "base"
            assert of_locked.header.stamp.sec == 100, "the transform that it was placed by"
            assert (of_locked.pose.position.x, of_locked.mouse_point.x) == (1.0, 2.0)

    asyncio.run(story())


def test_ten_thousand_controls_and_numbers_of_no_sense_hold_up_nobody(
    endpoint: str, tmp_path: Path, tester: Node
):
    async def story() -> None:
        found: list[Stall] = []
        async with stage(endpoint, tmp_path, tester) as made:
            made.insert("warm")
            await made.show()
            await until(lambda: made.place("warm") == 0.0)
            many = moving_marker(made.types, "many", ())
            many.controls = [
                control_of(made.types, f"c{number}", Mode(3 + number % 4))
                for number in range(10_000)
            ]
            broken = moving_marker(made.types, "broken")
            broken.pose.position.x = math.nan
            for marker in (broken, moving_marker(made.types, "n" * 1_000_000), many):
                made.server.insert(marker)
            with stalls(0.05, found.append):
                made.server.apply_changes()
                await until(lambda: any("9," in one and "left out" in one for one in made.remarks))
                began = time.monotonic()
                await until(lambda: "many" in made.views and made.place("many") == 0.0)
                assert time.monotonic() - began < 10
            assert len(made.views["many"]["controls"]) == 997
            assert any("not finite" in one for one in made.remarks)
            assert any("1,000,000 letters" in one for one in made.remarks)
            made.server.set_pose("warm", pose_at(made.types, 2.0, 0.0, 0.0))
            made.server.apply_changes()
            await until(lambda: made.place("warm") == 2.0)
        assert not found, "\n".join(map(str, found))

    asyncio.run(story())


def test_a_server_is_left_that_is_let_go_of_while_it_is_being_joined(
    endpoint: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    joining, may_go_on, joined = threading.Event(), threading.Event(), threading.Event()
    join, topic = InteractiveMarkerClient.connect, "/hands/update"

    async def story() -> None:
        async with studio(endpoint, tmp_path) as one:
            link = await one.engine.ros.connection.link()

            def slowly(client: InteractiveMarkerClient, namespace: str) -> None:
                joining.set()
                may_go_on.wait(20)
                join(client, namespace)
                while not link.graph.subscriptions(topic):
                    time.sleep(0.01)
                joined.set()

            monkeypatch.setattr(InteractiveMarkerClient, "connect", slowly)
            display = InteractiveMarkersDisplay(shared_types())
            display.set("Interactive Markers Namespace", "/hands")
            frames = SceneFrames(Posed(arm()), MemorySource())
            servers = marker_servers.MarkerServers(frames, lambda _: None)
            servers.step({"d1": display}, link)
            await until(joining.is_set)
            servers.let_go()
            may_go_on.set()
            await until(joined.is_set)
            await until(lambda: not link.graph.subscriptions(topic))
            await servers.close()

    asyncio.run(story())


def test_without_a_namespace_the_display_says_what_to_do(
    endpoint: str, tmp_path: Path, tester: Node
):
    async def story() -> None:
        async with stage(endpoint, tmp_path, tester) as made:
            await made.studio.do(AddDisplay(kind="InteractiveMarkers"))
            await until(lambda: any("Choose the namespace" in one for one in made.remarks))
            made.display = made.studio.ear.last("live_displays")["displays"][-1]["id"]
            change = SetDisplayProperty(
                display=made.display, name="Interactive Markers Namespace", value="hands"
            )
            await made.studio.do(change)
            await until(lambda: any("There is no connection" in one for one in made.remarks))

    asyncio.run(story())

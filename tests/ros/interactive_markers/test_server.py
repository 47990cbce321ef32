"""An interactive marker server and a client, each in a session of its own at one router."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.ros.interactive_markers import (
    ClientState,
    ClientStatus,
    InteractiveMarkerClient,
    InteractiveMarkerServer,
    MenuHandler,
    client,
)
from studio.ros.interactive_markers.names import FeedbackEvent
from studio.ros.node.task import Future
from studio.ros.node.work import ReentrantCallbackGroup
from tests.support.interactive_markers import feedback_of, moving_marker, pose_at
from tests.support.node_pair import node_pair, spin_until

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from studio.ros.node.node import Node
    from studio.ros.types.classes import MessageValue


class Ends:
    """A server, a client, and all that the client was told."""

    def __init__(self, server_node: Node, client_node: Node) -> None:
        self.nodes = server_node, client_node
        self.types = server_node.wire.types
        self.server = InteractiveMarkerServer(server_node, "/markers")
        self.client = InteractiveMarkerClient(client_node, topic_namespace="/markers")
        self.markers: dict[str, MessageValue] = {}
        self.said: list[tuple[ClientStatus, str]] = []
        self.resets = 0
        self.client.set_initialize_callback(self._initialize)
        self.client.set_update_callback(self._update)
        self.client.set_reset_callback(self._reset)
        self.client.set_status_callback(lambda status, text: self.said.append((status, text)))

    def until(self, condition: Callable[[], bool]) -> None:
        """Let both work until a condition holds."""

        def holds() -> bool:
            self.client.update()
            return condition()

        spin_until(holds, *self.nodes)

    def is_running(self) -> bool:
        return self.client.state is ClientState.RUNNING

    def add(self, name: str, callback: Callable[[MessageValue], object] | None = None) -> None:
        self.server.insert(moving_marker(self.types, name), feedback_callback=callback)
        self.server.apply_changes()

    def of_server(self, name: str) -> MessageValue:
        found = self.server.get(name)
        assert found is not None
        return found

    def _initialize(self, answer: MessageValue) -> None:
        self.markers = {one.name: one for one in answer.markers}

    def _update(self, update: MessageValue) -> None:
        self.markers |= {one.name: one for one in update.markers}
        for one in update.poses:
            self.markers[one.name].pose = one.pose
        for name in update.erases:
            del self.markers[name]

    def _reset(self) -> None:
        self.resets += 1
        self.markers = {}


@pytest.fixture(scope="module")
def nodes() -> Iterator[tuple[Node, Node]]:
    with node_pair() as pair:
        yield pair


@pytest.fixture
def ends(nodes: tuple[Node, Node]) -> Iterator[Ends]:
    made = Ends(*nodes)
    yield made
    made.client.disconnect()
    made.server.shutdown()
    spin_until(lambda: not made.nodes[1].graph.has_server(*_SERVICE), *nodes)


_SERVICE = "/markers/get_interactive_markers", "visualization_msgs/srv/GetInteractiveMarkers"


def test_a_client_gets_what_was_there_and_each_change_after_it(ends: Ends):
    ends.add("first")
    ends.until(lambda: ends.is_running() and "first" in ends.markers)
    arrow, other = ends.markers["first"].controls[0].markers  # completed by the client
    assert (arrow.points[1].x, other.points[1].x) == (0.9, -0.9)

    ends.add("second")
    ends.server.set_pose("first", pose_at(ends.types, 1.0, 2.0, 3.0))
    assert ends.of_server("first").pose.position.x == 1.0, "pending"
    ends.server.apply_changes()
    ends.until(lambda: "second" in ends.markers and ends.markers["first"].pose.position.x == 1.0)
    ends.server.erase("second")
    assert ends.server.get("second") is None
    ends.server.apply_changes()
    ends.until(lambda: set(ends.markers) == {"first"})
    before = ends.server.seq_num
    ends.server.apply_changes()
    assert ends.server.seq_num == before, "nothing changed, so nothing was published"


def test_feedback_moves_the_marker_and_calls_the_function_of_its_type(ends: Ends):
    told: list[tuple[str, int]] = []
    ends.add("one", callback=lambda f: told.append(("default", f.event_type)))
    ends.server.set_callback("one", lambda f: told.append(("click", f.event_type)), 3)
    ends.until(ends.is_running)

    moved = feedback_of(ends.types, "one", FeedbackEvent.POSE_UPDATE, (0.5, 0.0, 0.0))
    clicked = feedback_of(ends.types, "one", FeedbackEvent.BUTTON_CLICK)
    for feedback in (moved, clicked):
        ends.client.publish_feedback(feedback)
    ends.until(lambda: len(told) == 2)
    assert told == [("default", FeedbackEvent.POSE_UPDATE), ("click", FeedbackEvent.BUTTON_CLICK)]
    assert moved.client_id == "/listener"
    assert ends.markers["one"].pose.position.x == 0.0, "not before apply_changes"
    ends.server.apply_changes()
    ends.until(lambda: ends.markers["one"].pose.position.x == 0.5)


def test_of_two_clients_the_one_that_began_is_heard(ends: Ends):
    told: list[str] = []
    ends.add("one", callback=lambda f: told.append(f.client_id))
    for client_id in ("anna", "ben", "anna"):
        feedback = feedback_of(ends.types, "one", FeedbackEvent.KEEP_ALIVE)
        feedback.client_id = client_id
        ends.server.process_feedback(feedback)
    assert told == ["anna", "anna"]


def test_a_menu_with_boxes_and_a_submenu_is_applied_and_calls_back(ends: Ends):
    clicked: list[int] = []
    menu = MenuHandler()
    first = menu.insert("First", callback=lambda f: clicked.append(f.menu_entry_id))
    below = menu.insert("Below", parent=first)
    hidden = menu.insert("Hidden")
    assert (first, below, hidden, menu.insert("Nowhere", parent=99)) == (1, 2, 3, None)
    menu.set_check_state(2, MenuHandler.CHECKED)
    menu.set_visible(3, False)
    ends.add("one")
    assert menu.apply(ends.server, "one")
    assert not menu.apply(ends.server, "nobody")
    ends.server.apply_changes()
    ends.until(lambda: "one" in ends.markers and bool(ends.markers["one"].menu_entries))
    entries = ends.markers["one"].menu_entries
    assert [(one.id, one.parent_id, one.title) for one in entries] == [
        (1, 0, "First"),
        (2, 1, "[x] Below"),
    ]
    selected = feedback_of(ends.types, "one", FeedbackEvent.MENU_SELECT)
    selected.menu_entry_id = 1
    ends.client.publish_feedback(selected)
    ends.until(lambda: clicked == [1])
    menu.setVisible(3, True)
    assert menu.reApply(ends.server)
    assert [one.title for one in ends.of_server("one").menu_entries][-1] == "Hidden"


def test_a_client_begins_again_when_an_update_is_missing(ends: Ends):
    ends.add("one")
    ends.until(lambda: ends.is_running() and "one" in ends.markers)
    before = ends.resets
    ends.server.seq_num += 5  # as if five updates were lost on the way
    ends.add("two")
    ends.until(lambda: ends.resets > before)
    assert any("out of order. 2 (expected) vs. 7 (received)" in text for _, text in ends.said)
    ends.until(lambda: ends.is_running() and set(ends.markers) == {"one", "two"})


def test_markers_are_gone_with_their_server_and_back_with_it(ends: Ends):
    ends.add("one")
    ends.until(lambda: ends.is_running() and "one" in ends.markers)
    ends.server.shutdown()
    ends.until(lambda: ends.client.state is ClientState.IDLE and not ends.markers)
    ends.until(lambda: any(text.startswith("No server") for _, text in ends.said))
    ends.server = InteractiveMarkerServer(ends.nodes[0], "/markers")
    ends.add("again")
    ends.until(lambda: set(ends.markers) == {"again"})


def test_an_answer_that_is_too_large_is_not_read_and_asked_for_again(
    ends: Ends, monkeypatch: pytest.MonkeyPatch
):
    ends.add("one")
    said: list[str] = []
    monkeypatch.setattr(client, "_BYTES_MAX", 10)
    other = InteractiveMarkerClient(ends.nodes[1], request_timeout_s=0.05)
    other.set_status_callback(lambda _status, text: said.append(text))
    other.connect("/markers")

    def until(condition: Callable[[], bool]) -> None:
        def holds() -> bool:
            other.update()
            return condition()

        ends.until(holds)

    until(lambda: any("bytes are more than 10" in text for text in said))
    assert other.state is ClientState.INITIALIZE
    monkeypatch.undo()
    until(lambda: other.state is ClientState.RUNNING)
    other.disconnect()


def test_a_server_that_never_answers_is_asked_again(nodes: tuple[Node, Node]):
    asked: list[object] = []
    server, other = nodes

    def refuse(request: object, response: object) -> None:
        asked.append((request, response))
        raise _SilenceError

    service = server.create_service(
        server.wire.types.service(_SERVICE[1]),
        "/silent/get_interactive_markers",
        refuse,
    )
    said: list[str] = []
    client = InteractiveMarkerClient(other, request_timeout_s=0.2)
    client.set_status_callback(lambda _status, text: said.append(text))
    client.connect("/silent")

    def is_asked_twice() -> bool:
        client.update()
        return len(asked) >= 2

    try:
        with pytest.raises(_SilenceError):
            spin_until(is_asked_twice, server, other)
        with pytest.raises(_SilenceError):
            spin_until(is_asked_twice, server, other)
        assert client.state is ClientState.INITIALIZE
        assert any("resending" in text for text in said)
    finally:
        client.disconnect()
        server.destroy_service(service)


def test_a_server_that_takes_longer_than_the_timeout_is_waited_for(nodes: tuple[Node, Node]):
    server, other = nodes

    async def slowly(_request: object, response: object) -> object:
        waited: Future[None] = Future()
        timer = server.create_timer(0.2, lambda: waited.set_result(None))
        await waited
        server.destroy_timer(timer)
        return response

    kind = server.wire.types.service(_SERVICE[1])
    service = server.create_service(
        kind, "/slow/get_interactive_markers", slowly, callback_group=ReentrantCallbackGroup()
    )
    client = InteractiveMarkerClient(other, request_timeout_s=0.1)
    client.connect("/slow")

    def is_running() -> bool:
        client.update()
        return client.state is ClientState.RUNNING

    spin_until(is_running, server, other)
    client.disconnect()
    server.destroy_service(service)


class _SilenceError(Exception):
    """Raised by a server instead of an answer."""


def test_updates_out_of_order_and_those_of_no_sense_end_nothing(ends: Ends):
    ends.add("one")
    ends.until(ends.is_running)
    publisher = ends.nodes[0].create_publisher(
        ends.types.message("visualization_msgs/msg/InteractiveMarkerUpdate"), "/markers/update", 10
    )
    update = ends.types.message("visualization_msgs/msg/InteractiveMarkerUpdate")
    before = ends.resets
    publisher.publish(update(seq_num=0, type=0))  # a keep-alive of ROS 1
    publisher.publish(update(seq_num=2**63, type=1))
    ends.until(lambda: ends.resets > before)
    ends.until(lambda: ends.is_running() and "one" in ends.markers)
    ends.client._receive(b"\x00\x01\x00\x00nonsense")  # pyright: ignore[reportPrivateUsage]
    ends.until(lambda: any("could not be read" in text for _, text in ends.said))
    assert ends.is_running()
    ends.nodes[0].destroy_publisher(publisher)


def test_a_client_of_a_name_that_nothing_can_have_says_so(nodes: tuple[Node, Node]):
    said: list[tuple[ClientStatus, str]] = []
    client = InteractiveMarkerClient(nodes[1])
    client.set_status_callback(lambda status, text: said.append((status, text)))
    client.connect("/no such name")
    assert said[-1][0] is ClientStatus.ERROR
    client.update()

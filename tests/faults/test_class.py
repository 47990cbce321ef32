"""What befalls a class: people who vanish, who flood, who act at once, and a router that goes."""

from __future__ import annotations

import gc
import itertools
import json
import socket
import struct
import sys
import threading
from contextlib import ExitStack, contextmanager, suppress
from typing import TYPE_CHECKING

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus

from studio.classroom import control as control_module
from studio.documents.engine import COMMANDS
from studio.documents.lessons import lesson_room
from studio.live.panels import driving
from studio.protocol.commands import COMMAND_LIMIT_BYTES
from studio.protocol.roles import Role
from studio.ros.messages import message
from studio.rviz.tools import POINT
from studio.server.commands import ControlLane
from tests.support.demos import heard, node_at
from tests.support.patience import Stopwatch
from tests.support.served_class import RawLane, served_class, text_frame
from tests.support.strangers import resident_bytes
from tests.support.wire import free_endpoint, router_at, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator

    from tests.support.classmates import Lane
    from tests.support.served_class import ServedClass

pytestmark = pytest.mark.network
MB = 1 << 20
MANY = 300


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[ServedClass]:
    with served_class(tmp_path_factory.mktemp("class")) as running:
        yield running


@pytest.fixture(autouse=True)
def _as_if_new(served: ServedClass, caplog: pytest.LogCaptureFixture) -> Iterator[None]:
    """Nobody is left of the test before, and nothing went wrong that only the log tells."""
    yield
    wait_until("all to be gone", lambda: not lanes())
    served.look(lambda: served.classroom.control.give(""))
    served.look(served.classroom.members.clear)
    assert caplog.messages == []


def lanes() -> list[ControlLane]:
    """Every control lane that anything in this process still holds."""
    gc.collect()
    return [one for one in gc.get_objects() if isinstance(one, ControlLane)]


def break_off(opened: socket.socket) -> None:
    """End a connection as a browser does that dies: without a word."""
    opened.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
    opened.close()


def text_of(served: ServedClass) -> bytes:
    rover = served.rover
    return served.look(lambda: rover.sources.text(rover.path))


def test_the_presenter_whose_browser_dies_in_a_drag_finds_all_and_takes_it_back_in_one_step(
    served: ServedClass,
):
    radius, before = served.site("wheel_radius"), text_of(served)
    with served.presenter() as browser, served.student("Ada") as (ada, person), ada.lane() as lane:
        page = RawLane(served.port, browser.cookie)
        for text in ("0.11", "0.12"):
            page.say("edit_site", document="rover", site=radius, text=text, gesture="drag")
        wait_until("the drag to be there", lambda: b'"0.12"' in text_of(served))
        break_off(page.socket)
        assert lane.ask("ask_control")["type"] == "done"
        wait_until("it to be noticed", lambda: len(lanes()) == 1)
        assert b'"0.12"' in text_of(served)
        assert lane.ask("zero_joints", document="rover")["kind"] == "NotInControlError"
        with browser.lane() as back:
            assert back.until("you", role="presenter")["has_control"] is True
            asking = back.until("class_state")["members"]
            assert [(one["person"], one["asks_s"] is not None) for one in asking] == [
                (person, True)
            ]
            assert back.ask("undo", document="rover")["type"] == "done"
        assert text_of(served) == before


def test_a_drag_whose_holder_vanishes_is_undone_in_one_step_once_control_is_back(
    served: ServedClass, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(control_module, "ABSENCE_S", 0.2)
    radius, before = served.site("wheel_radius"), text_of(served)
    with served.presenting() as presenter:
        member, cookie = served.member("Ada")
        page = RawLane(served.port, cookie)
        presenter.ask("give_control", person=member.person, document="rover")
        for text in ("0.11", "0.12"):
            page.say("edit_site", document="rover", site=radius, text=text, gesture="drag")
        wait_until("the drag to be there", lambda: b'"0.12"' in text_of(served))
        break_off(page.socket)
        presenter.until("control", holder="")
        assert b'"0.12"' in text_of(served)
        assert presenter.ask("undo", document="rover")["type"] == "done"
        assert text_of(served) == before


def test_a_copy_is_its_owners_at_every_door_until_it_is_shown(served: ServedClass):
    with (
        served.presenting() as presenter,
        served.student("Ada") as (ada, person),
        served.student("Bob") as (bob, _),
        ada.lane() as lane,
    ):
        assert lane.ask("open_copy", document="rover")["type"] == "done"
        copy, protocol = f"rover~{person}", "viser-v1.1.1"
        wait_until("its robot", lambda: ada.client.get(f"/api/documents/{copy}/urdf").is_success)
        doors = [f"/api/documents/{copy}/{one}" for one in ("urdf", "export/urdf", "export/page")]
        for door in doors:
            assert bob.client.get(door).status_code in {403, 404}, door
        with pytest.raises(InvalidStatus), bob.websocket(f"/d/{copy}/viser", protocol):
            pass
        presenter.ask("show_copy", document=copy)
        assert bob.client.get(doors[0]).is_success
        with bob.websocket(f"/d/{copy}/viser", protocol):
            pass
        presenter.ask("show_copy", document=copy, shown=False)
        assert bob.client.get(doors[0]).status_code in {403, 404}
        lane.ask("discard_copy", document=copy)


def test_a_stop_of_anybody_and_the_end_of_control_stop_what_is_driven(
    served: ServedClass, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(driving, "_SILENCE_S", 600.0)  # nothing else stops it
    endpoint, speeds = free_endpoint(), list[float]()
    with (
        served.presenting() as presenter,
        served.student("Ada") as (ada, person),
        served.student("Bob") as (bob, _),
        ada.lane() as driver,
        bob.lane() as other,
        router_at(endpoint),
        node_at(endpoint, "robot") as node,
    ):
        twist = message("geometry_msgs/msg/Twist")
        node.create_subscription(twist, "/cmd_vel", lambda one: speeds.append(one.linear.x), 10)
        assert presenter.ask("connect_wire", address=endpoint)["type"] == "done"
        for stop in (lambda: driver.ask("return_control"), lambda: other.ask("stop_robot")):
            presenter.ask("give_control", person=person, document="rover")
            driver.until("you", has_control=True)
            wait_until("it to be driven", lambda: is_driven(driver, speeds))
            assert stop()["type"] == "done"
            wait_until("it to be stopped", lambda: speeds[-1] == 0.0)
            presenter.ask("take_control", document="rover")
        presenter.ask("disconnect_wire")


def is_driven(lane: Lane, speeds: list[float]) -> bool:
    """Ask for half a metre per second; whether that comes."""
    lane.ask("drive", topic="/cmd_vel", x=0.5)
    return speeds[-1:] == [0.5]


def test_a_tool_publishes_for_who_has_control_and_for_nobody_else(served: ServedClass):
    endpoint = free_endpoint()
    with (
        served.presenting() as presenter,
        served.student("Ada") as (ada, person),
        ada.lane() as lane,
        router_at(endpoint),
        node_at(endpoint, "robot") as node,
    ):
        points = heard(node, POINT, "/clicked_point")
        assert presenter.ask("connect_wire", address=endpoint)["type"] == "done"
        tools = served.look(lambda: tuple(served.rover.live.tools.list))
        tool = next(one.id for one in tools if one.kind == "PublishPoint")
        use = {"document": "rover", "tool": tool, "y": 0.0}
        assert lane.ask("use_tool", x=1.0, **use)["kind"] == "NotInControlError"
        presenter.ask("give_control", person=person, document="rover")
        assert lane.ask("use_tool", x=2.0, **use)["type"] == "done"
        assert presenter.ask("use_tool", x=3.0, **use)["kind"] == "NotInControlError"
        presenter.ask("take_control", document="rover")
        assert lane.ask("use_tool", x=4.0, **use)["kind"] == "NotInControlError"
        assert presenter.ask("use_tool", x=5.0, **use)["type"] == "done"
        wait_until("the last point", lambda: bool(points) and points[-1].point.x == 5.0)
        presenter.ask("disconnect_wire")
    assert [one.point.x for one in points] == [2.0, 5.0]


def test_who_has_control_keeps_it_while_the_presenters_browser_is_dead(served: ServedClass):
    radius = served.site("wheel_radius")
    with served.presenter() as browser, served.student("Ada") as (ada, person), ada.lane() as lane:
        lane.ask("watch", document="rover")
        page = RawLane(served.port, browser.cookie)
        page.say("give_control", person=person, document="rover")
        lane.until("you", has_control=True)
        break_off(page.socket)
        wait_until("it to be noticed", lambda: len(lanes()) == 1)
        edit = {"document": "rover", "site": radius, "text": "0.13"}
        assert lane.ask("edit_site", **edit)["type"] == "done"
        with browser.lane() as back:
            assert back.until("control")["holder"] == person
            assert back.ask("edit_site", **edit)["kind"] == "NotInControlError"
            assert back.ask("take_control", document="rover")["type"] == "done"
            assert back.ask("undo", document="rover")["type"] == "done"
        lane.until("control", holder="")
        assert lane.ask("edit_site", **edit)["kind"] == "NotInControlError"


def test_of_two_who_ask_at_once_and_are_given_it_at_once_one_has_it_and_all_know_who(
    served: ServedClass,
):
    with ExitStack() as held:
        people = [held.enter_context(served.student(name)) for name in ("Ada", "Bob")]
        lanes = [held.enter_context(browser.lane()) for browser, _ in people]
        presenters = [held.enter_context(served.presenting()) for _ in people]
        at_once([(lane, "ask_control", {}) for lane in lanes])
        state = presenters[0].until("class_state", open=True)
        while sum(one["asks_s"] is not None for one in state["members"]) < len(people):
            state = presenters[0].until("class_state", open=True)
        assert len({one["asks_s"] for one in state["members"]}) == len(people)
        at_once(
            [
                (lane, "give_control", {"person": person, "document": "rover"})
                for lane, (_, person) in zip(presenters, people, strict=True)
            ]
        )
        holder = served.look(lambda: served.classroom.control.holder)
        assert holder in {person for _, person in people}
        for lane in (*lanes, *presenters):
            lane.ask("follow", following=True)  # all that came before has been read then
            assert lane.newest("control")["holder"] == holder
        has = [lane.newest("you")["has_control"] for lane in (*lanes, *presenters)]
        assert has == [*(person == holder for _, person in people), False, False]


def at_once(asked: list[tuple[Lane, str, dict[str, str]]]) -> None:
    """Let each of these ask in the same moment; all are done."""
    barrier, ends = threading.Barrier(len(asked)), list[str]()

    def ask(lane: Lane, kind: str, fields: dict[str, str]) -> None:
        barrier.wait()
        ends.append(lane.ask(kind, **fields)["type"])

    threads = [threading.Thread(target=ask, args=one) for one in asked]
    for one in threads:
        one.start()
    for one in threads:
        one.join()
    assert ends == ["done"] * len(asked)


def test_three_hundred_who_leave_at_once_leave_nothing_behind(
    served: ServedClass, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(control_module, "ABSENCE_S", 0.2)
    rover, copies = served.rover, served.engine.copies
    with served.presenting() as presenter, ExitStack() as held:
        people = [served.member(f"n{number}") for number in range(MANY)]
        pages = [RawLane(served.port, cookie) for _, cookie in people]
        for page in pages:
            held.callback(page.socket.close)
        holder, *others = [member.person for member, _ in people]
        with_copies = dict(zip(others[:2], pages[1:3], strict=True))
        for person, page in with_copies.items():
            page.say("open_copy", document="rover")
            wait_until("the copy", lambda one=person: is_known(served, f"rover~{one}"))
            page.say("watch", document=f"rover~{person}")
        for page in (pages[0], *pages[3:]):
            page.say("watch", document="rover")
            page.say("follow", following=True)
            page.say("open_lesson", document="rover", lesson="find_the_wheel")
        wait_until("all to look", lambda: len(rover.audience) == MANY - 2 + 1)
        opened = [
            served.look(lambda one=one: copies.document(f"rover~{one}")) for one in others[:2]
        ]
        wait_until("the copies to be looked at", lambda: all(len(one.audience) for one in opened))
        assert presenter.ask("give_control", person=holder, document="rover")["type"] == "done"
        assert presenter.newest("control")["holder"] == holder
        for page in pages:
            page.socket.close()
        presenter.until("control", holder="")
        state = presenter.newest("class_state")
        while any(one["here"] for one in state["members"]):
            state = presenter.until("class_state")
        assert len(state["members"]) == MANY
        wait_until("only the presenter's lane to be held", lambda: len(lanes()) == 1)
        assert [len(one.audience) for one in (rover, *opened)] == [1, 0, 0]
        assert presenter.ask("zero_joints", document="rover")["type"] == "done"


def is_known(served: ServedClass, name: str) -> bool:
    """Whether there is such a copy."""
    with suppress(Exception):
        served.engine.copies.check(name)
        return True
    return False


def test_checks_ticks_and_control_outlive_the_router(
    served: ServedClass, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(lesson_room, "_LOOK_EVERY_S", 0.05)
    endpoint = free_endpoint()
    with (
        served.presenting() as presenter,
        served.student("Ada") as (ada, person),
        ada.lane() as lane,
        ExitStack() as first,
    ):
        text = "# Sensor\n\ncheck: node /sensor runs\n"
        presenter.ask("save_lesson", lesson="sensor", text=text)
        first.enter_context(router_at(endpoint))
        with node_at(endpoint, "sensor"):
            assert presenter.ask("connect_wire", address=endpoint)["type"] == "done"
            presenter.ask("give_control", person=person, document="rover")
            lane.ask("open_lesson", document="rover", lesson="sensor")
            done_s = until_check(lane, "")
            first.close()
            assert until_check(lane, "ros.lost") == done_s
            assert served.look(lambda: served.classroom.control.holder) == person
            with router_at(endpoint):
                assert until_check(lane, "") == done_s
                assert served.look(lambda: served.classroom.control.holder) == person
                presenter.ask("disconnect_wire")
        presenter.ask("delete_lesson", lesson="sensor")


def until_check(lane: Lane, code: str) -> float | None:
    """Wait until the one check of a lesson stands so; when its step was done."""
    while True:
        (step,) = lane.until("lesson_state")["steps"]
        if step["checks"][0]["code"] == code:
            return step["done_s"]


def test_the_3d_view_of_a_copy_ends_for_others_when_it_is_hidden(served: ServedClass):
    with (
        served.presenting() as presenter,
        served.student("Ada") as (ada, person),
        served.student("Bob") as (bob, _),
        ada.lane() as lane,
    ):
        assert lane.ask("open_copy", document="rover")["type"] == "done"
        copy = f"rover~{person}"
        presenter.ask("show_copy", document=copy)
        protocol = "viser-v1.1.1"
        with (
            ada.websocket(f"/d/{copy}/viser", protocol) as own,
            bob.websocket(f"/d/{copy}/viser", protocol) as others,
        ):
            presenter.ask("show_copy", document=copy, shown=False)
            with suppress(ConnectionClosed):
                while True:
                    others.recv(timeout=30)  # its end, or a TimeoutError
            own.ping().wait(30)
        lane.ask("discard_copy", document=copy)


IDS_THAT_LEAD_OUT = ("rover~..%2F..%2Fx", "rover~..", "..%2Fx~ada", "rover~", "%2e%2e%2f%2e%2e")


@pytest.mark.parametrize("name", IDS_THAT_LEAD_OUT)
def test_no_address_leads_out_of_the_copies(served: ServedClass, name: str):
    before = sorted(served.folder.rglob("*"))
    with served.student("Ada") as (ada, _), served.presenter() as presenter:
        for browser in (ada, presenter):
            for path in (f"/api/documents/{name}/urdf", f"/api/documents/{name}/export/page"):
                assert browser.client.get(path).status_code in {403, 404}
            with pytest.raises(InvalidStatus) as refused, browser.websocket(f"/d/{name}/viser"):
                pass
            assert refused.value.response.status_code in {403, 404}
    assert sorted(served.folder.rglob("*")) == before


# A student who floods


def kinds_of_a_student() -> list[bytes]:
    """A command of every kind that a student may send without control, and of some they may not."""
    words = {
        "document": "rover",
        "request": 1,
        "text": "wheel",
        "name": "x",
        "part": "link:mast",
        "lesson": "talker",
        "panel": "origin",
    }
    made = [
        {"type": entry.permission.name}
        | {name: value for name, value in words.items() if name in entry.message.model_fields}
        for entry in COMMANDS
        if entry.permission.role in {Role.GUEST, Role.STUDENT}
    ]
    return [json.dumps(one).encode() for one in made]


def filled(length: int) -> bytes:
    """A command of so many bytes, larger than its kind may be."""
    begin, end = b'{"type":"set_name","request":1,"name":"', b'"}'
    return begin + b"x" * (length - len(begin) - len(end)) + end


FLOODS = {
    "every kind": lambda: b"".join(map(text_frame, kinds_of_a_student())) * 10,
    "whole documents": lambda: text_frame(b'{"type":"watch","document":"rover"}') * 1_000,
    "malformed": lambda: (
        b"".join(map(text_frame, (b"{", b"[]", b"null", b'{"type":5}', b""))) * 500
    ),
    "large": lambda: text_frame(filled(COMMAND_LIMIT_BYTES)),
    "too large": lambda: text_frame(filled(COMMAND_LIMIT_BYTES + 1)),
}


class Flood:
    """A student who sends the same again and again, and reads what is answered, or does not."""

    def __init__(self, lane: RawLane, part: bytes, *, reads: bool) -> None:
        self._socket, self._part = lane.socket, part
        self._socket.settimeout(0.2)
        self._end = threading.Event()
        self.stopped = threading.Event()
        """Set once nothing more was taken for a while, or the connection was ended."""
        works = (self._send, self._read) if reads else (self._send,)
        self._threads = [threading.Thread(target=one) for one in works]

    def begin(self) -> None:
        for one in self._threads:
            one.start()

    def end(self) -> None:
        self._end.set()
        for one in self._threads:
            one.join()
        self._socket.close()

    def _send(self) -> None:
        rest = self._part
        while not self._end.is_set():
            try:
                rest = rest[self._socket.send(rest) :] or self._part
            except TimeoutError:
                self.stopped.set()
            except OSError:
                self.stopped.set()
                return

    def _read(self) -> None:
        with suppress(ConnectionError):
            while not self._end.is_set():
                with suppress(TimeoutError):
                    if not self._socket.recv(1 << 16):
                        return


@contextmanager
def flooding(served: ServedClass, part: bytes) -> Generator[list[Flood]]:
    """Two students who flood."""
    floods = [
        Flood(RawLane(served.port, served.member(name)[1]), part, reads=reads)
        for name, reads in (("Eve", True), ("Mallory", False))
    ]
    try:
        for one in floods:
            one.begin()
        yield floods
    finally:
        for one in floods:
            one.end()


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
@pytest.mark.parametrize("what", FLOODS)
def test_a_student_who_floods_is_held_back_or_cut_off_and_the_presenter_edits_beside_it(
    served: ServedClass, what: str
):
    radius, part = served.site("wheel_radius"), FLOODS[what]()
    with served.presenting() as presenter:
        before, slowest_s, numbers = resident_bytes(), 0.0, itertools.count(1)
        with flooding(served, part) as floods:

            def edit() -> bool:
                nonlocal slowest_s
                watch = Stopwatch()
                text = f"0.1{next(numbers):03}"
                asked = {"document": "rover", "site": radius, "text": text, "gesture": "drag"}
                assert presenter.ask("edit_site", **asked)["type"] == "done"
                slowest_s = max(slowest_s, watch.s)
                return all(one.stopped.is_set() for one in floods)

            wait_until("the floods to be stopped", edit)
            for _ in range(5):
                edit()
            grown = resident_bytes() - before
        assert slowest_s < 1.0
        assert grown < 60 * MB
        assert presenter.ask("undo", document="rover")["type"] == "done"

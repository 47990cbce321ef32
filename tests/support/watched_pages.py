"""A page at a relay as its tests see it: both lanes are read all the time, and what came when."""

from __future__ import annotations

import json
import sys
import threading
import time
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any, Final
from urllib.parse import urlsplit

from websockets.exceptions import ConnectionClosed

from studio.scene import SUBPROTOCOL
from tests.support.classmates import Classmate
from tests.support.relays import wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

PATIENCE_S: Final = 60.0


def measured(text: str) -> None:
    """Print a figure, which `pytest -s` shows."""
    sys.stdout.write(f"{text}\n")


class WatchedPage:
    """The control lane of a page that shows the rover, and its 3D view."""

    def __init__(self, browser: Classmate, document: str = "rover") -> None:
        self.browser = browser
        self.events: list[tuple[float, dict[str, Any]]] = []
        """With the seconds of the monotonic clock at which each came."""
        self.frames_s: list[float] = []
        """When frames of the 3D view came."""
        self.ended = threading.Event()
        self._requests = 0
        self.control = browser.websocket("/control")
        self.view = browser.websocket(f"/d/{document}/viser", SUBPROTOCOL)
        self._threads = [
            threading.Thread(target=one, daemon=True) for one in (self._read, self._look)
        ]
        for one in self._threads:
            one.start()
        self.watching = self.ask("watch", document=document)

    def ask(self, kind: str, **fields: Any) -> int:  # noqa: ANN401
        """Send a command, and wait for nothing; its number."""
        self._requests += 1
        self.control.send(json.dumps({"type": kind, "request": self._requests, **fields}))
        return self._requests

    def answers(self, request: int) -> list[dict[str, Any]]:
        """How a command ended: nothing as long as it did not."""
        return [
            event
            for _, event in tuple(self.events)
            if event.get("request") == request and event["type"] in {"done", "refused"}
        ]

    def answer(self, request: int) -> dict[str, Any]:
        """How a command ended, once it has."""
        wait_until(lambda: self.answers(request) or self.ended.is_set(), "the answer", PATIENCE_S)
        (answer,) = self.answers(request)
        return answer

    def of(self, kind: str) -> list[dict[str, Any]]:
        """All events of a kind."""
        return [event for _, event in tuple(self.events) if event["type"] == kind]

    def newest(self, kind: str) -> dict[str, Any]:
        """The newest event of a kind, once there is one."""
        wait_until(lambda: self.of(kind), kind, PATIENCE_S)
        return self.of(kind)[-1]

    @property
    def sees_studio(self) -> str:
        """`there` or `away`, as the page was told last."""
        return str(self.newest("relay_state")["studio"])

    def text(self, site: str) -> str:
        """What a site has, as far as the page knows."""
        told = [one for event in self.of("sites") for one in event["changed"] if one["id"] == site]
        return str(told[-1]["text"]) if told else ""

    def position(self, joint: str) -> float | None:
        """Where a joint is, as far as the page knows."""
        told = self.of("joints")
        return told[-1]["positions"].get(joint) if told else None

    def frame_after(self, moment_s: float) -> bool:
        """Whether a frame of the 3D view has come since then."""
        return bool(self.frames_s) and self.frames_s[-1] > moment_s

    def close(self) -> None:
        """Leave."""
        for one in (self.control, self.view):
            one.close()
        for one in self._threads:
            one.join(PATIENCE_S)

    def _read(self) -> None:
        with suppress(ConnectionClosed):
            for message in self.control:
                if isinstance(message, str):
                    self.events.append((time.monotonic(), json.loads(message)))
        self.ended.set()

    def _look(self) -> None:
        with suppress(ConnectionClosed):
            for _ in self.view:
                self.frames_s.append(time.monotonic())


@contextmanager
def watched_page(browser: Classmate, document: str = "rover") -> Generator[WatchedPage]:
    """A page that has all of the document."""
    made = WatchedPage(browser, document)
    try:
        assert made.answer(made.watching)["type"] == "done"
        wait_until(lambda: made.frames_s, "the 3D view", PATIENCE_S)
        yield made
    finally:
        made.close()


@contextmanager
def gone_on_at_another(page: WatchedPage) -> Generator[WatchedPage]:
    """What the page does when its relay is gone: it goes where its relay said that one can."""
    (address,) = page.newest("relay_state")["others"]
    parts = urlsplit(str(address))
    other = Classmate(f"{parts.scheme}://{parts.netloc}{parts.path.removesuffix('join')}")
    try:
        answer = other.client.get(f"/join?{parts.query}")
        assert answer.status_code == 303
        assert "pass=" not in answer.headers["location"]
        with watched_page(other) as made:
            yield made
    finally:
        other.close()


class Mover:
    """The presenter, who changes a number of the rover and moves a joint, again and again."""

    def __init__(self, page: WatchedPage, site: str) -> None:
        self.page, self.site = page, site
        self.joint = next(iter(page.newest("joints")["positions"]))
        self.count = 0
        self.slowest_s = 0.0
        """The longest that an edit took, until the presenter's own page had its answer."""

    @property
    def text(self) -> str:
        """What the number is after the last move."""
        return f"0.5{self.count:03}"

    @property
    def position(self) -> float:
        """Where the joint is after the last move."""
        return self.count / 1000

    def move(self) -> None:
        """Change both, and wait until it is done."""
        self.count += 1
        began_s = time.monotonic()
        page = self.page
        edit = {"site": self.site, "text": self.text, "gesture": "drag"}
        moved = page.ask("set_joints", document="rover", positions={self.joint: self.position})
        edited = page.ask("edit_site", document="rover", **edit)
        for one in (moved, edited):
            assert page.answer(one)["type"] == "done"
        self.slowest_s = max(self.slowest_s, time.monotonic() - began_s)

    @property
    def steps(self) -> int:
        """How many steps can be undone, as far as the presenter was told."""
        return len(self.page.newest("history")["undo"])

    def times_told(self, event: str, field: str, person: str, moment: str) -> int:
        """How many moments the presenter is told of a person, once there is one."""

        def moments() -> set[float | None]:
            told = [one for each in self.page.of(event) for one in each[field]]
            return {one[moment] for one in told if one["person"] == person} - {None}

        wait_until(moments, f"{moment} of {person}", PATIENCE_S)
        return len(moments())

    def edit(self, text: str) -> None:
        """Change the number by a step of its own."""
        self.do("edit_site", document="rover", site=self.site, text=text)

    def give_control(self, page: WatchedPage) -> None:
        """Give a student control, and wait until their page knows it."""
        person = page.newest("you")["person"]
        wait_until(
            lambda: self._answered("give_control", person=person, document="rover") == "done",
            "control",
        )
        wait_until(lambda: page.newest("you")["has_control"], "the student's control")

    def take_control(self) -> None:
        """Take it back; what came before has all been done then."""
        self.do("take_control", document="rover")

    def do(self, kind: str, **fields: Any) -> None:  # noqa: ANN401
        """Have a command done."""
        assert self._answered(kind, **fields) == "done"

    def _answered(self, kind: str, **fields: Any) -> str:  # noqa: ANN401
        return str(self.page.answer(self.page.ask(kind, **fields))["type"])

    def is_shown(self, page: WatchedPage) -> bool:
        """Whether a page shows the last move."""
        at = page.position(self.joint)
        close = at is not None and abs(at - self.position) < 1e-6
        return close and page.text(self.site) == self.text

    def shown_within(self, page: WatchedPage, since_s: float, what: str) -> float:
        """Move until a page shows a move and its 3D view one, too; the seconds since then."""

        def shows() -> bool:
            self.move()
            moved_s = time.monotonic()
            end_s = moved_s + 0.5
            while time.monotonic() < end_s:
                if self.is_shown(page) and page.frame_after(since_s):
                    return True
                time.sleep(0.005)
            return False

        wait_until(shows, what, PATIENCE_S)
        return time.monotonic() - since_s

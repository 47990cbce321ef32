"""The studio behind a relay dies and comes back, is there twice, or is somebody else."""

from __future__ import annotations

import asyncio
import base64
import shutil
import signal
import sys
import time
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, cast

import pytest

from studio.server.relays.keys import parse_relay_line
from studio.server.relays.tickets import RoomIdentity
from studio.server.relays.uplink import Uplink
from tests.support.classmates import Classmate
from tests.support.cut_lines import cut_line
from tests.support.relays import free_port, served_relay, wait_until
from tests.support.server import running_studio
from tests.support.watched_pages import Mover, measured, watched_page

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.server.relays.line import Line
    from studio.server.relays.origin_end import OriginEnd
    from tests.support.relays import ServedRelay
    from tests.support.server import RunningStudio
    from tests.support.watched_pages import WatchedPage

pytestmark = pytest.mark.network
MODELS = Path(__file__).resolve().parents[2] / "models"
BACK_S = 20.0
"""Within this after its start a studio has its room at the relay, on a busy machine."""


@pytest.fixture(scope="module")
def relay() -> Generator[ServedRelay]:
    with served_relay() as made:
        yield made


class Studio:
    """A studio process that shares a rover by a relay, and its data folder."""

    def __init__(self, line: str, folder: Path, host: str, port: int) -> None:
        self.folder, self._port = folder, port
        self._words = ["open", str(folder / "rover_description"), "--share", "--host", host]
        self._words += ["--via", line]

    @contextmanager
    def running(self) -> Generator[RunningStudio]:
        with running_studio(self._words, self.folder / "data", port=self._port) as made:
            yield made

    def copied(self, line: str, folder: Path, host: str) -> Studio:
        """One with the same data at another address, as on another machine."""
        shutil.copytree(self.folder, folder)
        return Studio(line, folder, host, self._port)

    def holds(self, text: str) -> bool:
        """Whether an edit is kept for the next start."""
        wanted = base64.b64encode(text.encode())
        drafts = (self.folder / "data/drafts").glob("*.json")
        return any(wanted in one.read_bytes() for one in drafts)


def made_studio(relay: ServedRelay, folder: Path) -> Studio:
    shutil.copytree(MODELS / "rover_description", folder / "rover_description")
    return Studio(relay.line, folder, "127.0.0.1", free_port())


@contextmanager
def presenting(studio: RunningStudio) -> Generator[Mover]:
    """The presenter's page of a studio."""
    browser = Classmate(studio.origin)
    try:
        browser.client.get(f"/?token={studio.token}")
        with watched_page(browser) as page:
            wait_until(lambda: page.of("sites") and page.of("joints"), "the robot")
            yield Mover(page, site_of(page, "base_length"))
    finally:
        browser.close()


def site_of(page: WatchedPage, name: str) -> str:
    sites = [one for event in page.of("sites") for one in event["changed"]]
    return next(str(one["id"]) for one in sites if one["name"].endswith(name))


@contextmanager
def student_of(studio: RunningStudio, name: str) -> Generator[WatchedPage]:
    """The page of somebody who joins at the studio's relay."""
    *_, code = studio.next_line("Relay: ").split()
    browser = Classmate(studio.next_line("   or: ").split()[1].partition("join?")[0])
    try:
        wait_until(lambda: browser.client.get("/join").status_code == 200, "the form")
        assert browser.join(name, code).status_code == 303
        with watched_page(browser) as page:
            yield page
    finally:
        browser.close()


def relays_of(mover: Mover) -> dict[str, str]:
    """The one relay, as the presenter is told."""
    (only,) = mover.page.newest("relays")["relays"]
    return only


def test_while_the_studio_is_dead_the_last_picture_stays_and_all_goes_on_when_it_is_back(
    relay: ServedRelay, tmp_path: Path
):
    studio = made_studio(relay, tmp_path / "first")
    with ExitStack() as held:
        with studio.running() as running:
            page = held.enter_context(student_of(running, "Ada"))
            person = page.newest("you")["person"]
            with presenting(running) as mover:
                mover.shown_within(page, time.monotonic(), "a move")
                wait_until(lambda: studio.holds(mover.text), "its draft")
                site, text = mover.site, mover.text
            running.process.send_signal(signal.SIGKILL)
            died_s = time.monotonic()
            wait_until(lambda: page.sees_studio == "away", "the sentence that it is away", 10)
            measured(f"away {time.monotonic() - died_s:.2f} s after it died")
        page.ask("raise_hand", id="hand")
        assert page.text(site) == text
        with studio.running() as running, presenting(running) as mover:
            back_s = time.monotonic()
            assert page.ended.wait(BACK_S)  # pages come again, and ask anew for what they show
            again = held.enter_context(watched_page(page.browser))
            assert mover.shown_within(again, back_s, "the newest") < BACK_S
            measured(f"all goes on {time.monotonic() - back_s:.2f} s after the robot was there")
            assert again.newest("you")["person"] == person
            assert again.answer(again.ask("raise_hand", id="hand"))["type"] == "done"
            assert mover.times_told("class_state", "members", person, "hand_s") == 1
            see_that_the_later_has_the_room(relay, studio, tmp_path, (mover, again))


def see_that_the_later_has_the_room(
    relay: ServedRelay, studio: Studio, tmp_path: Path, at_first: tuple[Mover, WatchedPage]
) -> None:
    """Studios with the same data take the room over, the third while the line of the second is cut;
    each of before is told, and leaves it alone.
    """
    first, page = at_first
    endpoint, _, key = relay.line.partition("#")
    with ExitStack() as held:
        line = held.enter_context(cut_line(int(endpoint.rpartition(":")[2])))
        by_line = f"tls/127.0.0.1:{line.port}#{key}"
        second = studio.copied(by_line, tmp_path / "second", "127.0.0.2")
        third = studio.copied(relay.line, tmp_path / "third", "127.0.0.3")
        mover = held.enter_context(presenting(held.enter_context(second.running())))
        assert page.ended.wait(BACK_S)
        again = held.enter_context(watched_page(page.browser))
        see_that_it_has_the_room(relay, again, mover, [first])
        line.cut()
        last = held.enter_context(presenting(held.enter_context(third.running())))
        wait_until(lambda: relays_of(last)["state"] == "there", "the third to have it")
        line.go_on(resets=True)
        assert again.ended.wait(BACK_S)
        with watched_page(page.browser) as again:
            see_that_it_has_the_room(relay, again, last, [first, mover])


def see_that_it_has_the_room(
    relay: ServedRelay, page: WatchedPage, later: Mover, earlier: list[Mover]
) -> None:
    """What it does is shown, and what the others do is not, who were told why."""
    began_s = time.monotonic()
    for one in earlier:
        wait_until(lambda one=one: relays_of(one)["state"] == "refused", "the earlier to be told")
        assert "has taken it over: stop that one" in relays_of(one)["reason"]
    wait_until(lambda: relays_of(later)["state"] == "there", "the later to have it")
    later.shown_within(page, began_s, "a move of the later")
    session = relay.look(lambda: session_at(relay))
    for _ in range(10):
        for one in (*earlier, later):
            one.move()
        wait_until(lambda: later.is_shown(page), "each move of the later")
    assert relay.look(lambda: session_at(relay)) == session
    assert {relays_of(one)["state"] for one in earlier} == {"refused"}


def session_at(relay: ServedRelay) -> str:
    state = relay.room().state
    assert state is not None
    return state.session


class Forged:
    """The identity of somebody who has another's room in mind."""

    def __init__(self, room: str, public: bytes) -> None:
        self._own = RoomIdentity(bytes(32))
        self.id, self.public = room, public or self._own.public

    def sign(self, data: bytes) -> bytes:
        return self._own.sign(data)


@pytest.mark.parametrize(
    "public", [b"", RoomIdentity(bytes(range(32))).public], ids=["own key", "key of the room"]
)
def test_who_has_not_the_key_of_a_room_cannot_claim_it(relay: ServedRelay, public: bytes):
    owner = RoomIdentity(bytes(range(32)))
    forged = Forged(owner.id, public)

    async def claim() -> str:
        told = asyncio.Event()

        def end_of(line: Line, uplink: Uplink) -> OriginEnd:
            raise AssertionError("it has the room")

        uplink = Uplink(
            parse_relay_line(relay.line),
            lambda: cast("RoomIdentity", forged),
            "forged",
            end_of,
            told.set,
        )
        async with asyncio.timeout(60):
            await told.wait()
        await uplink.close()
        return uplink.reason

    assert "no relay of a studio" in asyncio.run(claim())
    assert owner.id not in relay.look(lambda: tuple(relay.relay.rooms))


@pytest.mark.sweep
@pytest.mark.skipif(sys.platform != "linux", reason="forks")
def test_within_five_seconds_of_the_return_of_a_studio_all_goes_on(
    relay: ServedRelay, tmp_path: Path
):
    studio = made_studio(relay, tmp_path / "first")
    with ExitStack() as held:
        with studio.running() as running:
            page = held.enter_context(student_of(running, "Ada"))
            running.process.send_signal(signal.SIGKILL)
            wait_until(lambda: page.sees_studio == "away", "the sentence that it is away", 10)
        with studio.running() as running:
            back_s = time.monotonic()
            assert page.ended.wait(BACK_S)
            again = held.enter_context(watched_page(page.browser))
            with presenting(running) as mover:
                assert mover.shown_within(again, back_s, "the newest") < 5.0

"""Pages at relays, which are classes of this process served as a relay serves; the presenter's."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

import pytest

from studio.classroom.relays import NoRelays
from studio.errors import CommandError
from studio.protocol.listeners import Audience, send
from studio.protocol.relays import Relays, RelayState, RelayView
from tests.support.served_class import ServedClass, served_class
from tests.support.studio_page import StudioPage, studio_context, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator
    from pathlib import Path

    from playwright.sync_api import Browser, Locator

    from studio.protocol.listeners import Listener

pytestmark = [pytest.mark.browser, pytest.mark.network]
LINE = "tls/192.0.2.7:8101#c2VjcmV0"
NOBODY = "http://127.0.0.1:9/join?pass=x"
STORED = "JSON.stringify([{...localStorage}, {...sessionStorage}])"
ENDPOINT = LINE.partition("#")[0]


class Told(NoRelays):
    """A relay, or a studio with relays, as far as its pages know."""

    def __init__(self, served: ServedClass) -> None:
        self.served = served
        self.relays: tuple[RelayView, ...] = ()
        self.lines: list[str] = []
        self.state: RelayState | None = None
        self._pages = Audience()
        self._attach, self._detach = served.classroom.attach, served.classroom.detach
        served.classroom.attach, served.classroom.detach = self.attach, self.detach
        served.classroom.relays = self

    def attach(self, listener: Listener) -> None:
        self._attach(listener)
        self._pages.add(listener)
        if self.state is not None:
            send(listener, self.state)

    def detach(self, listener: Listener) -> None:
        self._pages.remove(listener)
        self._detach(listener)

    def say(self, state: RelayState) -> None:
        self.state = state
        self.served.look(lambda: self._pages.send(state))

    def show(self, *relays: RelayView) -> None:
        self.relays = relays
        self.served.look(self._show)

    def _show(self) -> None:
        self._pages.send(Relays(relays=self.relays))

    def event(self) -> Relays:
        return Relays(relays=self.relays)

    async def add(self, line: str, /) -> None:
        if "#" not in line:
            raise CommandError("This is no line of a relay: copy the whole line.")
        self.lines.append(line)
        one = RelayView(endpoint=line.partition("#")[0], state="connecting")
        self.relays = (*self.relays, one)
        self._show()

    async def remove(self, endpoint: str, /) -> None:
        self.relays = tuple(one for one in self.relays if one.endpoint != endpoint)
        self._show()


@pytest.fixture(scope="module")
def told(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Told]:
    """A relay that outlives every test, and whose presenter has relays."""
    with served_class(tmp_path_factory.mktemp("there"), tuple) as served:
        yield Told(served)


@contextmanager
def tab(browser: Browser, url: str, cookie: str = "") -> Generator[StudioPage]:
    """A browser of somebody's own, with their cookie."""
    context = studio_context(browser)
    if cookie:
        name, _, value = cookie.partition("=")
        context.add_cookies([{"name": name, "value": value, "url": url}])
    try:
        made = StudioPage(context.new_page())
        made.open(url, view=False)
        yield made
    finally:
        context.close()


def shown(page: StudioPage, kind: str) -> Locator:
    return page.page.locator(f".bar.{kind}")


def test_while_the_studio_is_away_the_page_says_so_and_stays_as_it_is(browser: Browser, told: Told):
    _, cookie = told.served.member("Ada")
    told.say(RelayState(studio="there"))
    with tab(browser, f"{told.served.origin}/", cookie) as ada:
        told.say(RelayState(studio="away"))
        words = shown(ada, "away")
        words.get_by_text("The studio is away.").wait_for()
        assert words.get_attribute("role") == "status"
        assert ada.page.get_by_role("treeitem").first.is_visible()
        told.say(RelayState(studio="there"))
        words.wait_for(state="detached")
        assert ada.errors == []


def is_ready_to_look(page: StudioPage) -> bool:
    """Whether the worker that looks for other relays runs."""
    probes = [one for one in page.page.workers if one.url.endswith("/probe.js")]
    return bool(probes) and probes[0].evaluate("typeof onmessage") == "function"


@pytest.mark.sweep  # the story of a class at two relays moves on, too
def test_when_a_relay_goes_its_people_go_on_at_another_as_who_they_are(
    browser: Browser, told: Told, tmp_path: Path
):
    there = told.served
    bob, cookie = there.member("Bob")
    # The first of them is gone, too.
    others = NOBODY, f"{there.origin}/join?pass={cookie.partition('=')[2]}"
    with served_class(tmp_path / "going", lambda: others) as going:
        Told(going).say(RelayState(studio="there", others=others))
        _, cookie = going.member("Bob")
        with tab(browser, f"{going.origin}/", cookie) as page:
            wait_until("the page to know others", lambda: is_ready_to_look(page))
            shown_at: list[str] = []
            page.page.on("framenavigated", lambda frame: shown_at.append(frame.url))
            going.server.should_exit = True
            shown(page, "lost").get_by_text("This relay is gone: going on at another.").wait_for()
            page.page.wait_for_url(f"{there.origin}/d/rover")
            page.page.get_by_role("treeitem").first.wait_for()
            is_here = there.classroom.is_here
            wait_until("Bob to be here", lambda: there.look(lambda: is_here(bob.person)))
            assert f"{there.origin}/d/rover" in shown_at
            assert not any("pass=" in one for one in shown_at)
            assert page.page.evaluate("document.referrer") == ""
            assert "pass=" not in page.page.evaluate(STORED)


def relays_of(presenter: StudioPage) -> Locator:
    presenter.page.locator(".share-button").click()
    return presenter.page.get_by_role("region", name="Relays")


def test_the_presenter_adds_a_relay_by_its_line_sees_how_it_is_and_removes_it(
    browser: Browser, told: Told
):
    told.show()
    with tab(browser, told.served.url) as presenter:
        part = relays_of(presenter)
        part.get_by_text("studio relay", exact=True).wait_for()
        line = part.get_by_label("The relay's line")
        assert line.get_attribute("type") == "password"
        line.fill(" not a line ")
        line.press("Enter")
        presenter.page.get_by_text("This is no line of a relay").wait_for()
        line.fill(f"  {LINE}\n")
        part.get_by_role("button", name="Add").click()
        row = part.get_by_role("listitem").filter(has_text=ENDPOINT)
        row.get_by_text("connecting…").wait_for()
        assert line.input_value() == ""
        assert told.lines == [LINE]
        assert "c2VjcmV0" not in presenter.page.content()
        address = "http://192.0.2.7:8100/robots/join"
        told.show(
            RelayView(endpoint=ENDPOINT, state="there", address=address, people=41, lag_ms=3_400.0),
            RelayView(endpoint="tls/other.example:8101", state="refused", reason="The key is old."),
        )
        for words in ("connected", "41 people", "3 s behind", address):
            row.get_by_text(words, exact=True).wait_for()
        other = part.get_by_role("listitem").filter(has_text="other.example")
        other.get_by_text("The key is old.").wait_for()
        other.get_by_role("button", name="Remove the relay tls/other.example:8101").click()
        presenter.page.get_by_role("button", name="Remove relay").click()
        wait_until("one relay", lambda: [one.state for one in told.relays] == ["there"])
        assert presenter.errors == []

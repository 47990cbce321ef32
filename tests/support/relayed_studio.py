"""A shared studio with two relays that are processes, and pages that go from one to the other."""

from __future__ import annotations

import re
from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING, Final, NamedTuple

from tests.support.relays import relay_process
from tests.support.server import running_studio
from tests.support.studio_page import wait_until

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

    from tests.support.relays import RelayProcess
    from tests.support.server import RunningStudio
    from tests.support.studio_page import StudioPage

_NOTE_WHEN_SHOWN: Final = """if (window === top) {
  const look = setInterval(() => {
    if (document.querySelector("[role=treeitem]")) window.listedAfterMs ??= performance.now();
    const view = document.querySelector("iframe")?.contentWindow;
    const nodes = Object.keys(view?.__viserMutable?.nodeRefFromName ?? {});
    if (!nodes.some((name) => name.includes("/visual/"))) return;
    window.drawnAfterMs = performance.now();
    clearInterval(look);
  }, 20);
}"""
_PLACES: Final = """frame => {
  const nodes = frame.contentWindow.__viserMutable.nodeRefFromName;
  const links = Object.entries(nodes).filter(([name]) => name.includes("/visual/"));
  return Object.fromEntries(links.map(([name, node]) => [name, node.matrixWorld.elements]));
}"""
_OF_A_DEAD_RELAY: Final = re.compile(r"net::ERR_(CONNECTION|SOCKET|EMPTY_RESPONSE)")


class Addresses(NamedTuple):
    """Of the class at each relay."""

    first: str
    second: str


class RelayedStudio:
    """The studio and its relays.

    Browsers find the first relay as `localhost` and the second as `127.0.0.1`: cookies know no
    ports, and people must be known at the second without the cookie of the first.
    """

    def __init__(self, studio: RunningStudio, first: RelayProcess, second: RelayProcess) -> None:
        self.studio, self.first, self.second = studio, first, second
        _ = studio.class_code  # printed before, and kept
        links = [studio.next_line("   or: ").split()[1] for _ in range(2)]
        said = [one.partition("join?")[0] for one in links]
        self.addresses = Addresses(
            *(
                next(one for one in said if one.startswith(relay.address))
                for relay in (first, second)
            )
        )


@contextmanager
def relayed_studio(folder: Path, *words: str) -> Generator[RelayedStudio]:
    """The shared demo; `words` are more of its options."""
    with ExitStack() as held:
        first = held.enter_context(relay_process(folder / "first", name="localhost"))
        second = held.enter_context(relay_process(folder / "second"))
        options = ["--host", "127.0.0.1", "--via", first.line, "--via", second.line, *words]
        studio = running_studio(["demo", "--share", *options], folder / "data")
        yield RelayedStudio(held.enter_context(studio), first, second)


class ShownAfter(NamedTuple):
    """Seconds from the begin of a page until it listed the robot, and had it in its 3D view."""

    listed_s: float
    drawn_s: float


def note_when_shown(tab: StudioPage) -> None:
    """Have its pages from now on note when they show the robot."""
    tab.page.add_init_script(_NOTE_WHEN_SHOWN)


def shown_after(tab: StudioPage) -> ShownAfter:
    """Wait until the page shows the robot; how long it took."""
    wait_until("the robot to be drawn", lambda: bool(tab.page.evaluate("window.drawnAfterMs")))
    listed_ms, drawn_ms = tab.page.evaluate("[listedAfterMs, drawnAfterMs]")
    return ShownAfter(listed_ms / 1000, drawn_ms / 1000)


def complaints(tab: StudioPage) -> list[str]:
    """What its console said, without what the browser itself says of a relay that is gone."""
    return [one for one in tab.errors if not _OF_A_DEAD_RELAY.search(one)]


def same_places(one: StudioPage, other: StudioPage) -> bool:
    """Whether both 3D views have the same visuals at the same places."""
    found, wanted = (each.page.locator("iframe").evaluate(_PLACES) for each in (one, other))
    return found.keys() == wanted.keys() and all(
        abs(a - b) < 1e-6 for name in found for a, b in zip(found[name], wanted[name], strict=True)
    )

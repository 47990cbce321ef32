"""One studio for all files of tests, one tab for those of a file: each test finds the demo anew.

To start a studio takes two seconds of a processor, to open the demo again half of one; a tab that
opens it takes one more, and with the 3D view two and a half.
"""

from __future__ import annotations

import shutil
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from studio.live.displays.display_file import FOLDER as DISPLAYS
from studio.packages.recent import RecentFiles
from tests.support.server import running_studio
from tests.support.studio_page import VIEWPORT, StudioPage, studio_context

if TYPE_CHECKING:
    from collections.abc import Generator

    from httpx2 import Client
    from playwright.sync_api import Browser

    from tests.support.server import RunningStudio

MODELS: Final = Path(__file__).resolve().parents[2] / "models"
PACKAGE: Final = "rover_description"
ENTRY: Final = "urdf/rover.urdf.xacro"


class SharedDemo(NamedTuple):
    """A running demo, and its data folder."""

    studio: RunningStudio
    data: Path


class SharedTab:
    """A running demo, and a tab that may be opened at it; `data` is the studio's folder."""

    def __init__(self, browser: Browser, demo: SharedDemo) -> None:
        self._studio, self.data = demo
        self._context = studio_context(browser)
        self.page = self._context.new_page()

    def anew(self) -> RunningStudio:
        """The studio, in which nobody has done anything yet."""
        with self._emptied() as client:
            self._restore()
            _do(client, type="open_path", path=str(self.data / "models" / PACKAGE / ENTRY))
        return self._studio

    def instead(self, path: Path, **arguments: str) -> str:
        """Open another file instead of the demo, wherever it lies; its address."""
        # What was opened before may be opened again.
        RecentFiles(self.data).note(str(path), path.name, arguments, 0.0)
        with self._emptied() as client:
            events = _do(client, type="open_path", path=str(path), arguments=arguments)
        (name,) = (one["document"] for one in events if one["type"] == "opened")
        return f"{self._studio.origin}/d/{name}?token={self._studio.token}"

    def opened(self, url: str = "", *, view: bool = True) -> StudioPage:
        """The tab, in which the robot is drawn; without the 3D view, it is listed."""
        tab = StudioPage(self.page)
        tab.open(url or self._studio.url, view=view)
        return tab

    def close(self) -> None:
        self._context.close()

    @contextmanager
    def _emptied(self) -> Generator[Client]:
        """A client of the studio, in which nothing is open any more."""
        self._leave()
        with self._studio.client() as client:
            for document in client.get("/api/documents").json()["documents"]:
                _do(client, type="close_document", document=document["id"], discard=True)
            yield client

    def _leave(self) -> None:
        """The browser forgets everything but what programs and pictures of the page it has."""
        for other in self._context.pages:
            if other is not self.page:
                other.close()
        self.page.goto("about:blank")
        self.page.set_viewport_size(VIEWPORT)
        self._context.clear_cookies()
        kept = {"origin": self._studio.origin, "storageTypes": "all"}
        session: Any = self._context.new_cdp_session(self.page)
        session.send("Storage.clearDataForOrigin", kept)
        session.detach()

    def _restore(self) -> None:
        """The files of the robot, as they are shipped, and no others; and no displays."""
        shutil.rmtree(self.data / DISPLAYS, ignore_errors=True)
        shipped, copy = MODELS / PACKAGE, self.data / "models" / PACKAGE
        for path in copy.rglob("*"):
            if path.is_file() and not (shipped / path.relative_to(copy)).exists():
                path.unlink()
        for path in shipped.rglob("*"):
            there = copy / path.relative_to(shipped)
            if path.is_file() and there.read_bytes() != path.read_bytes():
                shutil.copyfile(path, there)


def _do(client: Client, **command: Any) -> list[dict[str, Any]]:  # noqa: ANN401
    """What the studio answers to a command."""
    return client.post("/api/commands", json=command).raise_for_status().json()["events"]


@contextmanager
def shared_demo(data: Path) -> Generator[SharedDemo]:
    """A demo that ends with the block; it prints an address for viewers, too."""
    with running_studio(["demo", "--viewer-link"], data) as studio:
        yield SharedDemo(studio, data)


@contextmanager
def shared_tab(browser: Browser, demo: SharedDemo) -> Generator[SharedTab]:
    """A tab at a demo, closed with the block."""
    shared = SharedTab(browser, demo)
    try:
        yield shared
    finally:
        shared.close()

"""Takes a picture of every display: `python -m tests.support.display_pictures FOLDER [name ...]`.

Real nodes tell what each one shows (see display_samples.py), one after the other is added to the
demo, and FOLDER gets `<name>-<theme>.png` in both themes. Names of samples take only those. What a
display has to say of itself is printed.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tests.support.display_samples import BASE, SAMPLES
from tests.support.panel_pictures import (
    SHOW_PANEL,
    THEMES,
    WINDOWS,
    pictures_into_folder,
    tab_of,
    wanted,
)
from tests.support.server import running_studio
from tests.support.studio_page import wait_until
from tests.support.told_samples import told
from tests.support.wire import running_router

if TYPE_CHECKING:
    from httpx2 import Client
    from playwright.sync_api import Browser

    from tests.support.display_samples import Sample
    from tests.support.studio_page import StudioPage

_EYE = {"position": [2.6, -2.3, 2.0], "target": [0.1, 0.1, 0.2]}
_STATE = """async (id) => {
  const script = document.querySelector('script[type="module"]').src;
  const model = new URL("../model/live-displays.js", script);
  const { displayStates, liveDisplays } = await import(model);
  const shown = liveDisplays.value.find((one) => one.name === id);
  const said = displayStates.value.get(shown?.id)?.remarks ?? [];
  return said.map(({ level, sentence }) => [level, sentence]);
}"""
_MAXIMIZE = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  (await import(new URL("../lib/commands.js", script))).commandById("maximize").run();
}"""
_LOOK = "(pose) => document.querySelector('iframe').contentWindow.studio3d.setCamera(pose, false)"


class DisplayCommands:
    """Asks the studio for displays, as the page would."""

    def __init__(self, client: Client, tab: StudioPage) -> None:
        self._client, self._tab = client, tab
        self._document = tab.page.url.partition("/d/")[2].partition("/")[0]

    def ask(self, **command: Any) -> None:  # noqa: ANN401
        answer = self._client.post("/api/commands", json={"document": self._document, **command})
        assert answer.is_success, answer.text

    def add(self, sample: Sample) -> None:
        """Add its display behind those that are there."""
        self.ask(type="add_display", kind=sample.kind, topic=sample.topic)
        made = self._displays()[-1]
        self.ask(type="arrange_display", display=made, name=sample.name)
        for name, value in sample.values.items():
            self.ask(type="set_display_property", display=made, name=name, value=value)

    def show(self, sample: Sample) -> list[list[str]]:
        """Add its display, wait until it is seen or says why not; gives what it says."""
        self.add(sample)
        said: list[list[str]] = []

        def is_shown() -> bool:
            said[:] = self._tab.page.evaluate(_STATE, sample.name)
            return [level for level, _ in said] == ["ok"]

        try:
            wait_until(f"{sample.name} to be shown", is_shown, 15)
        except AssertionError:
            sys.stdout.write(f"{sample.name}: not at its best\n")
        return said

    def clear(self) -> None:
        """Take all displays away."""
        for one in self._displays():
            self.ask(type="remove_display", display=one)

    def _displays(self) -> list[str]:
        script = """async () => {
          const script = document.querySelector('script[type="module"]').src;
          const { liveDisplays } = await import(new URL("../model/live-displays.js", script));
          return liveDisplays.value.map((one) => one.id);
        }"""
        return self._tab.page.evaluate(script)


def take(tab: StudioPage, folder: Path, name: str, *, moves: bool = False) -> None:
    """The page with a display, in both themes; one that moves never stands still."""
    tab.page.evaluate(_LOOK, _EYE)
    for theme in THEMES:
        tab.page.emulate_media(color_scheme=theme, reduced_motion="reduce")
        tab.picture() if moves else tab.settle()
        tab.page.screenshot(path=folder / f"{name}-{theme}.png")


def take_all(browser: Browser, folder: Path) -> None:
    """One studio and one page; each display alone."""
    samples = [one for one in SAMPLES if wanted(one.name)]
    with (
        tempfile.TemporaryDirectory() as data,
        running_router() as endpoint,
        told(endpoint, samples),
        running_studio(
            ["demo", "--connect", endpoint, "--router", "off"], Path(data) / "data"
        ) as studio,
        studio.client() as client,
        tab_of(browser, studio, "dark", WINDOWS[0]) as tab,
    ):
        commands = DisplayCommands(client, tab)
        commands.ask(type="connect_wire")
        commands.ask(type="set_fixed_frame", frame=BASE)
        tab.page.evaluate(SHOW_PANEL, "scene")
        tab.page.evaluate(_MAXIMIZE)
        for one in samples:
            for level, sentence in commands.show(one):
                sys.stdout.write(f"{one.name}: {level}: {sentence}\n")
            take(tab, folder, one.name, moves=one.kind.endswith("Trajectory"))
            commands.clear()


if __name__ == "__main__":
    sys.exit(pictures_into_folder(__doc__, take_all))

"""Takes a picture of every display: `python -m tests.support.display_pictures FOLDER [name ...]`.

Real nodes tell what each one shows (see display_samples.py), one after the other is added to the
demo, and FOLDER gets `<name>-<theme>.png` in both themes. Names of samples take only those. What a
display has to say of itself is printed.
"""

from __future__ import annotations

import sys
import tempfile
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from studio.nodes.robot_state_publisher import LATCHED
from studio.ros.messages import message
from studio.ros.types.plain import from_dict
from tests.support.demos import node_at
from tests.support.display_messages import pose
from tests.support.display_samples import BASE, FRAMES, SAMPLES
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
from tests.support.wire import running_router

if TYPE_CHECKING:
    from collections.abc import Generator, Iterable

    from httpx2 import Client
    from playwright.sync_api import Browser

    from studio.ros.client import Node
    from tests.support.display_samples import Sample
    from tests.support.studio_page import StudioPage

_PERIOD_S = 0.3
_EYE = {"position": [2.6, -2.3, 2.0], "target": [0.1, 0.1, 0.2]}
_STATE = """async (id) => {
  const script = document.querySelector('script[type="module"]').src;
  const { displayStates, liveDisplays } = await import(new URL("state/live.js", script));
  const shown = liveDisplays.value.find((one) => one.name === id);
  const said = displayStates.value.get(shown?.id)?.remarks ?? [];
  return said.map(({ level, sentence }) => [level, sentence]);
}"""
_MAXIMIZE = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  (await import(new URL("commands.js", script))).commandById("maximize").run();
}"""
_LOOK = "(pose) => document.querySelector('iframe').contentWindow.studio3d.setCamera(pose, false)"


@contextmanager
def told(endpoint: str, samples: Iterable[Sample]) -> Generator[None]:
    """A node tells of all samples and of their frames, again and again."""
    with node_at(endpoint, "teller") as node:
        _tell_frames(node)
        for one in samples:
            if one.type_name:
                _tell(node, one.topic, one.type_name, one.frame, one.fields)
            for topic, (type_name, fields) in one.beside.items():
                _tell(node, topic, type_name, one.frame, fields)
        yield


def _tell_frames(node: Node) -> None:
    kind = message("tf2_msgs/msg/TFMessage")
    rows = [
        {
            "header": {"frame_id": parent},
            "child_frame_id": child,
            "transform": {"translation": at["position"], "rotation": at["orientation"]},
        }
        for parent, child, xyz, wxyz in FRAMES
        for at in (pose(xyz, wxyz),)
    ]
    publisher = node.create_publisher(kind, "/tf_static", LATCHED)
    publisher.publish(from_dict(kind, {"transforms": rows}))


def _tell(node: Node, topic: str, type_name: str, frame: str, fields: dict[str, Any]) -> None:
    kind = message(type_name)
    publisher = node.create_publisher(kind, topic, 10)

    def tell() -> None:
        stamp = node.get_clock().now().to_msg()
        header = {"frame_id": frame, "stamp": {"sec": stamp.sec, "nanosec": stamp.nanosec}}
        if hasattr(kind(), "header"):
            told = {**fields, "header": header | fields.get("header", {})}
            publisher.publish(from_dict(kind, told))
        else:
            publisher.publish(from_dict(kind, fields))

    node.create_timer(_PERIOD_S, tell)


class Desk:
    """Asks the studio for displays, as the page would."""

    def __init__(self, client: Client, tab: StudioPage) -> None:
        self._client, self._tab = client, tab
        self._document = tab.page.url.partition("/d/")[2].partition("/")[0]

    def ask(self, **command: Any) -> None:  # noqa: ANN401
        answer = self._client.post("/api/commands", json={"document": self._document, **command})
        assert answer.is_success, answer.text

    def show(self, sample: Sample) -> list[list[str]]:
        """Add its display, wait until it is seen or says why not; gives what it says."""
        self.ask(type="add_display", kind=sample.kind, topic=sample.topic)
        (made,) = self._displays()
        self.ask(type="arrange_display", display=made, name=sample.name)
        for name, value in sample.values.items():
            self.ask(type="set_display_property", display=made, name=name, value=value)
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
          const { liveDisplays } = await import(new URL("state/live.js", script));
          return liveDisplays.value.map((one) => one.id);
        }"""
        return self._tab.page.evaluate(script)


def take(tab: StudioPage, folder: Path, name: str) -> None:
    """The page with a display, in both themes."""
    tab.page.evaluate(_LOOK, _EYE)
    for theme in THEMES:
        tab.page.emulate_media(color_scheme=theme, reduced_motion="reduce")
        tab.settle()
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
        desk = Desk(client, tab)
        desk.ask(type="connect_wire")
        desk.ask(type="set_fixed_frame", frame=BASE)
        tab.page.evaluate(SHOW_PANEL, "scene")
        tab.page.evaluate(_MAXIMIZE)
        for one in samples:
            for level, sentence in desk.show(one):
                sys.stdout.write(f"{one.name}: {level}: {sentence}\n")
            take(tab, folder, one.name)
            desk.clear()


if __name__ == "__main__":
    sys.exit(pictures_into_folder(__doc__, take_all))

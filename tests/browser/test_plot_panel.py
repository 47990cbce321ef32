"""The Plot panel in a recording: all of it at once, the moment moved, looked at closer, saved."""

from __future__ import annotations

import csv
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import pytest

from tests.support.number_bags import PATH, write_numbers
from tests.support.panel_pictures import SHOW_PANEL
from tests.support.studio_page import wait_until
from tests.support.timeline import LENGTH_S, Timeline, shown_bag

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Locator, Page

pytestmark = [pytest.mark.browser, pytest.mark.timeout(240)]

RATE_HZ: Final = 1_000
SPIKE_AT: Final = 7_001
DRAW: Final = """async (lines) => {
  const script = document.querySelector('script[type="module"]').src;
  const { series } = await import(new URL("../model/plotting.js", script));
  series.value = lines.map(([topic, path]) => ({ topic, path }));
}"""
PICTURE: Final = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  const { recordedPicture } = await import(new URL("../model/recorded-series.js", script));
  const picture = recordedPicture.value;
  return picture && {
    from_s: picture.range.from_s, to_s: picture.range.to_s, columns: picture.columns,
    answers: Object.fromEntries(picture.answers),
  };
}"""


def numbers() -> list[tuple[int, float]]:
    """A wave of ten seconds, with one message that is far off."""
    count = round(LENGTH_S * RATE_HZ) + 1
    step_ns = 10**9 // RATE_HZ
    return [(n * step_ns, 9.0 if n == SPIKE_AT else math.sin(n / 500)) for n in range(count)]


def write(file: Path) -> Path:
    return write_numbers(file, numbers())


class Plot:
    """The panel, in the words of who looks at it."""

    def __init__(self, timeline: Timeline) -> None:
        self.page: Page = timeline.tab.page
        self.page.evaluate(SHOW_PANEL, "plot")
        self.panel = self.page.get_by_role("region", name="Plot", exact=True)
        self.chart: Locator = self.panel.locator(".plot-chart .u-over")

    def exact(self, key: str) -> dict[str, Any]:
        """Wait until a line is there, every message of it; what was answered for all of them."""
        found: dict[str, Any] = {}

        def there() -> bool:
            nonlocal found
            found = self.page.evaluate(PICTURE) or {}
            answer = found.get("answers", {}).get(key)
            return answer is not None and answer["exact"]

        wait_until(f"{key} is read", there)
        return found

    def place(self, share: float) -> tuple[float, float]:
        """Return where the chart is, so far from its left."""
        box = self.chart.bounding_box()
        assert box is not None
        return box["x"] + box["width"] * share, box["y"] + box["height"] / 2


def test_a_recording_is_plotted_at_once_looked_at_closer_and_saved(
    browser: Browser, tmp_path: Path
):
    with shown_bag(browser, tmp_path, write) as timeline:
        plot = Plot(timeline)
        plot.page.evaluate(DRAW, [["/points", PATH], ["/points", ".header.frame_id"]])
        every_message_counts(plot)
        the_moment_is_moved(plot, timeline)
        a_wheel_looks_closer(plot)
        a_table_has_every_message(plot)
        timeline.button("Close").click()
        plot.panel.get_by_role("button", name="Show the whole recording").wait_for(state="detached")


def every_message_counts(plot: Plot) -> None:
    """Of each column the least and the largest: one message of ten thousand is seen."""
    key = f"/points{PATH}"
    picture = plot.exact(key)
    answer = picture["answers"][key]
    assert (picture["from_s"], picture["to_s"]) == (0.0, LENGTH_S)
    assert answer["count"] == len(numbers())
    width_s = LENGTH_S / picture["columns"]
    for n in (0, picture["columns"] // 3, int(SPIKE_AT / RATE_HZ / width_s)):
        inside = [
            value for at, value in numbers() if n * width_s <= at / 1e9 < (n + 1) * width_s - 1e-9
        ]
        shown = sorted((answer["first"][n], answer["second"][n]))
        assert shown == pytest.approx([min(inside), max(inside)], abs=0.003)
    assert max(answer["second"]) == 9.0 or max(answer["first"]) == 9.0
    trouble = plot.panel.get_by_text("a text lies there")
    trouble.wait_for()
    assert plot.panel.locator(".plot-coarse").count() == 0


def the_moment_is_moved(plot: Plot, timeline: Timeline) -> None:
    """A click shows that moment, everywhere; a line stands there."""
    pixel_s = LENGTH_S / plot.exact(f"/points{PATH}")["columns"]
    plot.page.mouse.click(*plot.place(0.25))
    timeline.rests_at(LENGTH_S * 0.25, 2 * pixel_s)
    plot.page.mouse.move(*plot.place(0.3))
    plot.page.mouse.down()
    plot.page.mouse.move(*plot.place(0.6), steps=5)
    plot.page.mouse.up()
    timeline.rests_at(LENGTH_S * 0.6, 2 * pixel_s)
    line = plot.panel.locator(".plot-now")

    def apart_px() -> float:
        box = line.bounding_box()
        return abs((box["x"] if box else 0) - plot.place(0.6)[0])

    wait_until("the line stands there", lambda: apart_px() < 3)
    plot.page.mouse.move(5, 5)
    shown = plot.panel.locator(".plot-legend output").first
    wait_until(
        "the value of then",
        lambda: any(
            abs(float(one) - math.sin(LENGTH_S * 0.6 * 2)) < 0.05
            for one in shown.inner_text().replace("\u2212", "-").split(" … ")
        ),
    )


def a_wheel_looks_closer(plot: Plot) -> None:
    """Around the pointer; the timeline as well; and a double click shows all again."""
    plot.page.mouse.move(*plot.place(0.7))
    for _ in range(12):
        plot.page.mouse.wheel(0, -100)
    key = f"/points{PATH}"
    wait_until("it is closer", lambda: width_of(plot.exact(key)) < LENGTH_S / 8)
    picture = plot.exact(key)
    assert picture["from_s"] < LENGTH_S * 0.7 < picture["to_s"]
    answer = picture["answers"][key]
    assert answer["before"][0] < picture["from_s"]
    assert answer["after"][0] > picture["to_s"]
    plot.page.mouse.dblclick(*plot.place(0.5))
    wait_until("all is seen", lambda: width_of(plot.exact(key)) == LENGTH_S)


def width_of(picture: dict[str, Any]) -> float:
    return picture["to_s"] - picture["from_s"]


def a_table_has_every_message(plot: Plot) -> None:
    with plot.page.expect_download() as download:
        plot.panel.get_by_role("button", name="Save every sample of the recording as CSV").click()
    with Path(download.value.path()).open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["value"]) for row in rows] == [value for _, value in numbers()]
    assert {row["path"] for row in rows} == {PATH}

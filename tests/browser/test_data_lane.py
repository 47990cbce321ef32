"""Topics on the page: one is echoed by a click, its numbers are drawn by a drag, none is lost."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.demos import running_demo
from tests.support.eight_numbers import SERIES, TOPIC, eight_numbers
from tests.support.server import running_studio
from tests.support.studio_page import PATIENCE_S, StudioPage, studio_page, wait_until
from tests.support.wire import free_endpoint, router_at

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

    from playwright.sync_api import Browser, Locator

    from tests.support.server import RunningStudio

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(400)]

MESSAGES = [2_000, pytest.param(30_000, marks=pytest.mark.sweep)]
"""Of two seconds, and of half a minute."""
_COUNTS = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  const { samplesOf } = await import(new URL("../model/plotting.js", script));
  const { series } = await import(new URL("../model/plotting.js", script));
  return series.value.map((one) => {
    const { values, begin, end, count } = samplesOf(one);
    const drawn = values.subarray(begin, end);
    return [count, drawn[0], drawn.every((value, n) => value === drawn[0] + n)];
  });
}"""
_SUBSCRIBED = """async (topic) => {
  const script = document.querySelector('script[type="module"]').src;
  const { topicSubscriptions } = await import(new URL("../model/plotting.js", script));
  return topicSubscriptions.value.get(topic)?.state === "receiving";
}"""
_COME = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  const { samplesOf } = await import(new URL("../model/plotting.js", script));
  const { series } = await import(new URL("../model/plotting.js", script));
  return samplesOf(series.value[0]).count;
}"""


@pytest.fixture
def endpoint() -> Generator[str]:
    with router_at(free_endpoint()) as router:
        yield router.endpoint.text


@pytest.fixture
def studio(endpoint: str, tmp_path: Path) -> Generator[RunningStudio]:
    words = ["demo", "--connect", endpoint, "--router", "off"]
    with running_studio(words, tmp_path / "data") as running:
        yield running


def topic(tab: StudioPage, name: str) -> Locator:
    return tab.page.locator(f"[id='topic-{name}']")


def field(tab: StudioPage, path: str) -> Locator:
    """A row of the message that is looked at."""
    return tab.page.locator(f"[id='echo-{path}']")


def see_topics(tab: StudioPage) -> None:
    """The layout for what is live, with a connection."""
    tab.page.keyboard.press("Control+2")
    panel = tab.page.get_by_role("region", name="Topics")
    panel.get_by_role("button", name="Connect", exact=True).click()


def see_ends(tab: StudioPage, node: str, reliability: str) -> None:
    """Who publishes the topic that is looked at, and how."""
    button = tab.page.get_by_role(
        "button", name="Publishers, subscribers and their quality of service"
    )
    button.click()
    ends = tab.page.locator(".topics-ends")
    wait_until("its publisher", lambda: node in (ends.text_content() or ""))
    assert reliability in (ends.text_content() or "")
    button.click()


def draw_all(tab: StudioPage) -> None:
    """One number by a drag, the others by their buttons."""
    field(tab, ".data").click()
    field(tab, ".data[0]").drag_to(tab.page.locator(".panel-body.plot"))
    for at in range(1, SERIES):
        row = field(tab, f".data[{at}]")
        row.hover()
        row.get_by_role("button", name=f"Draw .data[{at}] over time").click()
    lines = tab.page.get_by_role("list", name="Lines").get_by_role("listitem")
    wait_until("all lines", lambda: lines.count() == SERIES)


def count_all(tab: StudioPage, messages: int) -> None:
    """Every number as it was sent, all the time."""
    came = lambda: tab.page.evaluate(_COME)  # noqa: E731
    wait_until("half of them", lambda: came() > messages / 2)
    # Sent at 1 kHz, or as fast as a busy machine sends them.
    wait_until("all of them", lambda: came() >= messages, max(PATIENCE_S, messages / 200))
    expected = [[messages, 1 + at, True] for at in range(SERIES)]
    wait_until("every number as it was sent", lambda: tab.page.evaluate(_COUNTS) == expected)


@pytest.mark.parametrize("messages", MESSAGES)
def test_v2_v3_t1_t3_a_click_echoes_a_topic_and_a_drag_draws_every_number_as_it_was_sent(
    browser: Browser, studio: RunningStudio, endpoint: str, messages: int
):
    with (
        running_demo(endpoint, "talker") as talker,
        eight_numbers(endpoint) as eight,
        studio_page(browser, studio, view=False) as tab,
    ):
        see_topics(tab)
        topic(tab, "/chatter").click()
        said = field(tab, ".data").locator(".echo-value")
        wait_until("what the talker said", lambda: said.count() == 1)
        wait_until("that", lambda: said.inner_text() in talker.printed)
        shown = ("String", "Hz", "B/s")
        row = topic(tab, "/chatter")
        wait_until(
            "all of its row", lambda: all(one in (row.text_content() or "") for one in shown)
        )
        see_ends(tab, "/topic_helloworld_pub", "reliable")

        topic(tab, TOPIC).click()
        eight.wait_for_listeners(1)
        eight.publish_once()
        draw_all(tab)
        subscribed = lambda: tab.page.evaluate(_SUBSCRIBED, TOPIC)  # noqa: E731
        wait_until("the plot to be subscribed", subscribed)
        eight.publish_at_1_khz(messages)
        count_all(tab, messages)

        eight.end()
        silence = tab.page.get_by_text("Nobody publishes it now.")
        wait_until("that to be said", lambda: silence.count() == 1)
        assert tab.errors == []

"""The Doctor in the page: begun, mended by a click, live, filtered, shown elsewhere, and sent."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from studio.ros.messages import message
from studio.ros.parameters.parameter import Parameter
from studio.ros.qos import QoSProfile, ReliabilityPolicy
from tests.support.demos import node_at
from tests.support.panel_pictures import SHOW_PANEL
from tests.support.server import running_studio
from tests.support.studio_page import studio_page, wait_until
from tests.support.wire import running_router

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Locator

    from studio.ros.client import Node
    from tests.support.studio_page import StudioPage

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(240)]
STRING = message("std_msgs/msg/String")
BEST_EFFORT = QoSProfile(reliability=ReliabilityPolicy.BEST_EFFORT)


def begin(tab: StudioPage) -> Locator:
    """Nothing is examined, nor listened to, before somebody asks."""
    tab.page.evaluate(SHOW_PANEL, "doctor")
    panel = tab.page.locator("section.panel-body.doctor")
    panel.get_by_role("button", name="Examine").click()
    return panel


def card(panel: Locator, code: str) -> Locator:
    """The first finding of a code."""
    return panel.locator(f'article[data-code="{code}"]').first


def mend_by_a_click(tab: StudioPage, panel: Locator) -> None:
    """Not connected, then in an empty domain: each is mended by the button beside it."""
    card(panel, "not-connected").get_by_role("button", name="Connect", exact=True).click()
    card(panel, "other-domain").get_by_role("button", name="Join domain 0").click()
    wait_until("that is over", lambda: panel.locator('[data-code="other-domain"]').count() == 0)
    tab.page.locator(".ros-status").get_by_text("connected").wait_for()


def see_what_it_knows(panel: Locator) -> None:
    found = card(panel, "qos")
    found.get_by_text("Zenoh carries it, DDS would not.").wait_for()
    assert found.get_by_role("img").get_attribute("aria-label") == (
        "Who talks to whom: /talker, /chatter, /listener"
    )
    found.get_by_text("Evidence").click()
    found.get_by_text("/talker offers best effort, volatile").wait_for()
    found.get_by_text("ros2 topic info -v /chatter").wait_for()


def stay_true(panel: Locator, talker: Node) -> None:
    """What comes is seen without asking again, and what was unfolded stays so."""
    assert panel.locator('[data-code="type"]').count() == 0
    talker.create_publisher(message("std_msgs/msg/Int32"), "/chatter", 10)
    card(panel, "type").wait_for()
    assert card(panel, "qos").locator("details").get_attribute("open") is not None


def mend_a_parameter(tab: StudioPage, panel: Locator, listener: Node) -> None:
    """A node goes by a time that nobody publishes, until a click sets its parameter."""
    listener.set_parameters([Parameter("use_sim_time", value=True)])
    found = card(panel, "no-clock")
    found.get_by_role("button", name="Show parameters of /listener").wait_for()
    found.get_by_role("button", name="Set use_sim_time of /listener to false").click()
    wait_until("that is over", lambda: panel.locator('[data-code="no-clock"]').count() == 0)
    assert listener.get_parameter("use_sim_time").value is False
    # It ran before the studio joined.
    card(panel, "parameter-changed").get_by_text("at its start was not heard").wait_for()
    card(panel, "router-of-this-machine").get_by_role("button", name="Show connection").click()
    tab.page.get_by_role("dialog").get_by_role("button", name="Close").first.click()


def filter_findings(panel: Locator) -> None:
    cards = panel.locator("article")
    panel.get_by_role("searchbox").fill("best effort")
    wait_until("that one", lambda: cards.count() == 1)
    panel.get_by_role("button", name="Warnings: ").click()
    panel.get_by_text("none matches the filter").wait_for()
    panel.get_by_role("button", name="Warnings: ").click()
    panel.get_by_role("searchbox").fill("")
    card(panel, "type").wait_for()
    examined = panel.locator(".doctor-looked")
    assert "Clocks" in examined.inner_text()
    assert examined.locator("li.well").count() > 5


def save_the_report(tab: StudioPage, panel: Locator) -> None:
    with tab.page.expect_download() as saving:
        panel.get_by_role("button", name="Save the report").click()
    saved = Path(saving.value.path()).read_text(encoding="utf-8")
    assert saving.value.suggested_filename == "doctor.html"
    assert "/talker offers best effort" in saved
    assert "<script" not in saved


def show_it_elsewhere(tab: StudioPage, panel: Locator) -> None:
    card(panel, "qos").get_by_role("button", name="Show /chatter").click()
    tab.page.locator('section.topics tr[aria-selected="true"]', has_text="/chatter").wait_for()
    tab.page.evaluate(SHOW_PANEL, "doctor")
    card(panel, "no-publisher").get_by_role("button", name="Show /listener").click()
    tab.page.get_by_role("region", name="About /listener").wait_for()
    tab.page.evaluate(SHOW_PANEL, "doctor")
    panel.get_by_role("button", name="Stop", exact=True).click()
    panel.get_by_role("button", name="Examine", exact=True).wait_for()
    card(panel, "qos").wait_for()  # what was found stays to be read


def test_what_is_wrong_is_found_mended_shown_and_sent(browser: Browser, tmp_path: Path):
    with (
        running_router() as endpoint,
        node_at(endpoint, "talker") as talker,
        node_at(endpoint, "listener") as listener,
    ):
        talker.create_publisher(STRING, "/chatter", BEST_EFFORT)
        listener.create_subscription(STRING, "/chatter", print, 10)
        listener.create_subscription(STRING, "/nobody_here", print, 10)
        place = ["--connect", endpoint, "--router", "off", "--domain", "41"]
        with (
            running_studio(["demo", *place], tmp_path / "data") as studio,
            studio_page(browser, studio, view=False) as tab,
        ):
            panel = begin(tab)
            mend_by_a_click(tab, panel)
            see_what_it_knows(panel)
            stay_true(panel, talker)
            mend_a_parameter(tab, panel, listener)
            filter_findings(panel)
            save_the_report(tab, panel)
            show_it_elsewhere(tab, panel)
            assert tab.errors == []

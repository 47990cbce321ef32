"""What a panel says when the studio refuses what it asks, and that another try mends it."""

from __future__ import annotations

import json
import re
from typing import TYPE_CHECKING

import pytest

from tests.support.studio_page import wait_until

if TYPE_CHECKING:
    from playwright.sync_api import Locator, WebSocketRoute

    from tests.support.shared_tab import SharedTab
    from tests.support.studio_page import StudioPage

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(240)]

_SHOWS = {
    "get_outline": ("Files & macros", "wheel"),
    "get_masses": ("Masses", "base_link"),
    "get_urdf": ("URDF", "<robot"),
}
"""What each question is of: a panel, and a word of what it shows once it is answered."""


class WrongAddress:
    """On the way to the studio, some questions are sent on as if of a robot that is not open."""

    def __init__(self) -> None:
        self.kinds = set(_SHOWS)

    def route(self, lane: WebSocketRoute) -> None:
        studio = lane.connect_to_server()

        def on(message: str | bytes) -> None:
            asked = json.loads(message)
            wrong = asked["type"] in self.kinds
            studio.send(json.dumps(asked | {"document": "another"}) if wrong else message)

        lane.on_message(on)


def region(tab: StudioPage, name: str) -> Locator:
    tab.page.get_by_role("tab", name=re.compile(f"^{name}(,|$)")).first.click()
    return tab.page.locator(f"section[aria-label='{name}']")


def test_a_refused_question_is_said_and_asked_again(shared: SharedTab):
    wrong = WrongAddress()
    shared.anew()
    shared.page.route_web_socket("**/control*", wrong.route)
    tab = shared.opened(view=False)
    for kind, (name, word) in _SHOWS.items():
        panel = region(tab, name)
        said = panel.get_by_role("alert")
        wait_until(f"the refusal of {name}", lambda said=said: said.count() == 1)
        assert 'No document "another" is open' in said.inner_text()
        wrong.kinds.discard(kind)
        panel.get_by_role("button", name="Try again").click()
        wait_until(
            f"what {name} shows",
            lambda panel=panel, word=word: word in panel.inner_text(),
        )
        wait_until("no refusal", lambda panel=panel: panel.get_by_role("alert").count() == 0)
    assert tab.errors == []

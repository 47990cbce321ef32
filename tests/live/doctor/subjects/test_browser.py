"""The browser that asks."""

from __future__ import annotations

from studio.live.doctor.examination import examine
from studio.live.doctor.seen import Seen, SeenBrowser


def test_a_browser_that_draws_by_software_is_a_note():
    (found,) = examine(Seen(browser=SeenBrowser("SwiftShader", draws_by_software=True))).findings
    assert (found.code, found.level, found.evidence) == (
        "software-drawing",
        "note",
        ("SwiftShader",),
    )


def test_one_with_a_graphics_card_is_well():
    found = examine(Seen(browser=SeenBrowser("RTX", draws_by_software=False)))
    assert found.findings == ()
    (looked,) = (one for one in found.subjects if one.subject == "browser")
    assert (looked.state, looked.detail) == ("well", "RTX")

"""Relays whose clocks are an hour before and behind that of the studio."""

from __future__ import annotations

import time
from contextlib import ExitStack
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

import pytest

from tests.support.relays import relay_process, relayed_class, wait_until
from tests.support.shifted_clocks import with_clock
from tests.support.watched_pages import Mover, gone_on_at_another, watched_page

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.network


def test_people_join_work_and_change_relays_though_clocks_differ_by_two_hours(tmp_path: Path):
    with ExitStack() as held:
        relays = [
            held.enter_context(relay_process(tmp_path / f"relay {hours}", *with_clock(hours)))
            for hours in (1, -1)
        ]
        room = held.enter_context(relayed_class(tmp_path / "class", [one.line for one in relays]))
        browser = held.enter_context(room.served.presenter())
        own = held.enter_context(watched_page(browser))
        mover = Mover(own, room.served.site("base_length"))
        for name, relay in zip(("Ada", "Bob"), relays, strict=True):
            student = held.enter_context(room.student(name, relay.line.partition("#")[0]))
            page = held.enter_context(watched_page(student))
            mover.shown_within(page, time.monotonic(), "a move")
            mover.give_control(page)
            edit = {"site": mover.site, "text": f"0.4{len(name)}"}
            assert page.answer(page.ask("edit_site", document="rover", **edit))["type"] == "done"
            mover.take_control()
            wait_until(lambda page=page: page.newest("relay_state")["others"], "the other relay")
            with gone_on_at_another(page) as there:
                assert there.newest("you")["person"] == page.newest("you")["person"]
                assert urlsplit(there.browser.origin) != urlsplit(page.browser.origin)
                mover.shown_within(there, time.monotonic(), "a move at the other relay")

"""One token for all ends of a kind and name, kept until the last of them has gone."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import pytest

from studio.ros.wire.bridges.announcements import Announcements
from studio.ros.wire.zenoh import live_tokens
from tests.support.wire import session_pair, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.wire.session import WireSession

pytestmark = pytest.mark.network
HEAD = "@/1a/@ros2_lv"
FIRST = f"{HEAD}/MP/chatter/std_msgs§msg§String/:1:0:0,5"
OTHER = f"{HEAD}/MP/chatter/std_msgs§msg§String/:1:0:0,50"
SERVER = f"{HEAD}/SS/chatter/std_srvs§srv§Empty"
SUBSCRIPTION = f"{HEAD}/MS/chatter/std_msgs§msg§String/:1:0:0,5"
MARKER = f"{HEAD}/MP/marker/std_msgs§msg§String/:1:0:0,5"


class Met(NamedTuple):
    """What is announced, and a session that sees it."""

    announcements: Announcements
    other: WireSession

    clock: list[float]

    def shown(self) -> set[str]:
        return set(live_tokens(self.other.zenoh, f"{HEAD}/*/**", 5.0))


@pytest.fixture
def met() -> Generator[Met]:
    with session_pair() as (one, other):
        clock = [0.0]
        yield Met(Announcements(one.zenoh, lambda: clock[0]), other, clock)


def test_the_first_token_stands_until_the_last_end_is_gone(met: Met):
    met.announcements.hold(FIRST, "one")
    met.announcements.hold(OTHER, "other")
    wait_until("it is shown", lambda: met.shown() == {FIRST})
    met.announcements.release(FIRST, "one")
    met.announcements.release(FIRST, "one")
    met.announcements.hold(MARKER, "marker")
    wait_until("what came later is shown", lambda: MARKER in met.shown())
    assert met.shown() == {FIRST, MARKER}
    met.announcements.release(OTHER, "other")
    wait_until("it is gone", lambda: met.shown() == {MARKER})


def test_kinds_of_one_name_are_apart(met: Met):
    met.announcements.hold(FIRST, "one")
    met.announcements.hold(SERVER, "one")
    wait_until("both are shown", lambda: met.shown() == {FIRST, SERVER})
    met.announcements.release(FIRST, "one")
    wait_until("one is left", lambda: met.shown() == {SERVER})


def test_a_token_of_subscriptions_stands_a_second_longer(met: Met):
    met.announcements.hold(SUBSCRIPTION, "one")
    met.announcements.release(SUBSCRIPTION, "one")
    assert met.announcements.sweep()
    met.announcements.hold(SUBSCRIPTION, "next")
    met.clock[0] = 5.0
    assert not met.announcements.sweep()
    wait_until("it is shown", lambda: met.shown() == {SUBSCRIPTION})
    met.announcements.release(SUBSCRIPTION, "next")
    met.clock[0] = 5.9
    assert met.announcements.sweep()
    met.clock[0] = 6.0
    assert not met.announcements.sweep()
    wait_until("it is gone", lambda: met.shown() == set())


def test_where_no_bridge_is_left_no_token_stands_longer(met: Met):
    met.announcements.hold(SUBSCRIPTION, "one")
    met.announcements.release(SUBSCRIPTION, "one")
    assert not met.announcements.sweep(at_once=True)
    wait_until("it is gone", lambda: met.shown() == set())


def test_of_publishers_the_one_that_keeps_most_is_shown(met: Met):
    latched = f"{HEAD}/MP/chatter/std_msgs§msg§String/:1:1:0,1"
    deeper = f"{HEAD}/MP/chatter/std_msgs§msg§String/:1:1:0,5"
    met.announcements.hold(FIRST, "volatile")
    met.announcements.hold(latched, "latched")
    wait_until("the latched one is shown", lambda: met.shown() == {latched})
    met.announcements.hold(deeper, "deeper")
    wait_until("the deeper one is shown", lambda: met.shown() == {deeper})
    met.announcements.hold(OTHER, "other")
    for token, holder in ((deeper, "deeper"), (latched, "latched"), (OTHER, "other")):
        met.announcements.release(token, holder)
    met.announcements.hold(MARKER, "marker")
    wait_until("what came later is shown", lambda: MARKER in met.shown())
    assert met.shown() == {deeper, MARKER}
    met.announcements.release(FIRST, "volatile")
    wait_until("it is gone", lambda: met.shown() == {MARKER})

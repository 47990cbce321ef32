"""One token for all ends of a name, kept until the last of them; of subscriptions a bit longer."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import pytest

from studio.ros.tokens import EndpointKind
from studio.ros.wire.bridges.announcements import Announcements
from studio.ros.wire.zenoh import live_tokens
from tests.support.wire import session_pair, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

pytestmark = pytest.mark.network
HEARD, SENT = EndpointKind.SUBSCRIPTION, EndpointKind.PUBLISHER
FIRST, OTHER = "announced/first", "announced/other"


class Met(NamedTuple):
    announcements: Announcements
    seen: Generator[set[str]]

    def shown(self) -> set[str]:
        """What another session sees now."""
        return next(self.seen)


@pytest.fixture
def met() -> Generator[Met]:
    with session_pair() as (one, other):

        def seen() -> Generator[set[str]]:
            while True:
                yield set(live_tokens(other.zenoh, "announced/**", 5.0))

        announcements = Announcements(one.zenoh)
        yield Met(announcements, seen())
        announcements.close()


def test_the_first_token_stands_until_the_last_end_is_gone(met: Met):
    met.announcements.hold(SENT, "/chatter", "one", FIRST)
    met.announcements.hold(SENT, "/chatter", "other", OTHER)
    wait_until("it is shown", lambda: met.shown() == {FIRST})
    met.announcements.release(SENT, "/chatter", "one")
    met.announcements.release(SENT, "/chatter", "one")
    met.announcements.hold(SENT, "/marker", "marker", "announced/marker")
    wait_until("what came later is shown", lambda: "announced/marker" in met.shown())
    assert FIRST in met.shown()
    met.announcements.release(SENT, "/chatter", "other")
    wait_until("it is gone", lambda: met.shown() == {"announced/marker"})


def test_kinds_of_one_topic_are_apart(met: Met):
    met.announcements.hold(SENT, "/chatter", "one", FIRST)
    met.announcements.hold(HEARD, "/chatter", "one", OTHER)
    wait_until("both are shown", lambda: met.shown() == {FIRST, OTHER})
    met.announcements.release(SENT, "/chatter", "one")
    wait_until("one is left", lambda: met.shown() == {OTHER})


def test_who_announces_nothing_keeps_what_others_announced(met: Met):
    met.announcements.hold(SENT, "/chatter", "counter", None)
    met.announcements.hold(SENT, "/chatter", "one", FIRST)
    wait_until("it is shown", lambda: met.shown() == {FIRST})
    met.announcements.release(SENT, "/chatter", "one")
    met.announcements.hold(SENT, "/marker", "marker", "announced/marker")
    wait_until("what came later is shown", lambda: "announced/marker" in met.shown())
    assert FIRST in met.shown()


def test_a_subscription_that_follows_on_another_finds_its_token(met: Met):
    met.announcements.hold(HEARD, "/chatter", "one", FIRST)
    wait_until("it is shown", lambda: met.shown() == {FIRST})
    met.announcements.release(HEARD, "/chatter", "one")
    met.announcements.hold(HEARD, "/chatter", "other", OTHER)
    assert met.shown() == {FIRST}
    met.announcements.release(HEARD, "/chatter", "other")
    wait_until("it is gone at last", lambda: met.shown() == set())

"""A message takes three forms at most on its way to a browser, and waits in two places."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.live.topics.frames import LARGE_BYTES
from tests.support.sample_forms import follow_sample
from tests.support.wire import running_router

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = pytest.mark.network

THE_QUEUE = "Subscription.waiting"
WHILE_SLOW = "Backlog.all"


@pytest.fixture(scope="module")
def router() -> Iterator[str]:
    with running_router() as endpoint:
        yield endpoint


@pytest.mark.parametrize("size", [10, LARGE_BYTES])
def test_a_sample_has_three_forms_and_one_queue_between_the_ring_of_zenoh_and_the_socket(
    router: str, size: int
):
    followed = follow_sample(router, size=size)

    assert 1 < len(followed.forms) <= 3, followed.forms
    assert followed.buffers == {THE_QUEUE}


def test_for_a_browser_that_is_slow_it_has_no_more_forms_and_waits_in_one_place_more(router: str):
    followed = follow_sample(router, slow=True)

    assert 1 < len(followed.forms) <= 3, followed.forms
    assert followed.buffers == {THE_QUEUE, WHILE_SLOW}

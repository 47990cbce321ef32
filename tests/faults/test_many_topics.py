"""Ten thousand topics at once: all are seen, soon, and all go with their session."""

from __future__ import annotations

import pytest

from studio.ros.graph.graph import Graph
from tests.support.many_topics import announce_topics, topic_named
from tests.support.patience import Stopwatch
from tests.support.wire import open_test_session, running_router

pytestmark = [pytest.mark.network, pytest.mark.sweep]
TOPICS = 10_000


def test_ten_thousand_topics_are_seen_and_go_with_their_session():
    last = topic_named(TOPICS - 1)
    with (
        running_router() as endpoint,
        open_test_session(endpoint) as watching,
        Graph(watching) as graph,
    ):
        with open_test_session(endpoint) as busy:
            kept = announce_topics(busy, TOPICS)
            assert graph.wait_for(lambda: len(graph.publishers(last)) == 1, 60)
            assert graph.settle(60)
            watch = Stopwatch()
            assert len(graph.topics()) == TOPICS
            assert watch.s < 2
            assert len(kept) == TOPICS + 1
        assert graph.wait_for(lambda: not graph.nodes() and not graph.topics(), 60)

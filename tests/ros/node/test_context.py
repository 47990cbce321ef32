from __future__ import annotations

import gc
import weakref

import pytest

from studio.errors import AlreadyJoinedError, DestroyedError, NoRouterError, NotJoinedError
from studio.ros.duration import Duration
from studio.ros.messages import message
from studio.ros.node.clock import Clock
from studio.ros.node.context import Context
from studio.ros.node.executors import SingleThreadedExecutor
from studio.ros.node.node import Node
from studio.ros.wire.settings import WireSettings
from tests.support.node_pair import context_at
from tests.support.wire import free_endpoint, open_test_session, running_router, wait_until

String = message("std_msgs/msg/String")


def test_a_context_is_joined_once():
    with running_router() as endpoint:
        settings, context = WireSettings(connect=(endpoint,)), Context()
        context.init(settings)
        with pytest.raises(AlreadyJoinedError):
            context.init(settings)
        context.shutdown()
        context.shutdown()
        context.init(settings)
        assert context.ok()
        context.shutdown()


def test_nothing_is_made_before_it_is_joined():
    context = Context()
    assert not context.ok()
    with pytest.raises(NotJoinedError):
        _ = context.wire
    with pytest.raises(NotJoinedError):
        _ = context.drain
    with pytest.raises(NotJoinedError):
        Node("early", context=context)


def test_without_a_router_it_says_so_and_is_not_joined():
    context = Context()
    with pytest.raises(NoRouterError):
        context.init(WireSettings(connect=(free_endpoint(),)), router="off")
    assert not context.ok()
    context.shutdown()


def test_a_session_that_is_lent_stays_open():
    with running_router() as endpoint, open_test_session(endpoint) as wire:
        context = Context.over(wire)
        Node("guest", context=context)
        context.shutdown()
        assert not wire.zenoh.is_closed()


def test_a_shutdown_destroys_the_nodes_and_closes_the_session():
    with running_router() as endpoint, context_at(endpoint) as context:
        node = Node("ends", context=context)
        wire = context.wire
        context.shutdown()
        assert wire.zenoh.is_closed()
        with pytest.raises(DestroyedError):
            node.create_publisher(String, "x", 10)


def test_who_is_told_of_the_end_is_told_once_even_when_late():
    with running_router() as endpoint, context_at(endpoint) as context:
        told: list[str] = []
        context.on_end(lambda: told.append("early"))
        context.end()
        context.end()
        context.on_end(lambda: told.append("late"))
        assert told == ["early", "late"]
        assert not context.wire.zenoh.is_closed()


def test_a_context_keeps_nothing_that_slept_or_was_destroyed():
    with running_router() as endpoint, context_at(endpoint) as context:
        node = Node("sleeper", context=context)
        clock, rate = Clock(), node.create_rate(10)
        executor = SingleThreadedExecutor(context=context)
        kept = [weakref.ref(one) for one in (clock, rate, executor)]
        clock.sleep_for(Duration(nanoseconds=1), context)
        node.destroy_rate(rate)
        executor.shutdown()
        del clock, rate, executor
        gc.collect()
        assert [one() for one in kept] == [None, None, None]


def test_a_context_that_is_told_to_end_while_it_joins_is_not_ok():
    with running_router() as endpoint:
        context = Context()
        context.end()
        context.init(WireSettings(connect=(endpoint,)))
        assert not context.ok()
        context.shutdown()


def test_what_takes_in_data_may_ask_who_is_there_until_the_nodes_are_destroyed():
    class Curious:
        def __init__(self, context: Context) -> None:
            self.context, self.answers = context, 0

        def drain(self) -> int:
            self.context.graph.nodes()
            self.answers += 1
            return 0

    with running_router() as endpoint, context_at(endpoint) as context:
        source = Curious(context)

        def until_it_asked_again() -> None:
            before = source.answers
            wait_until("another look", lambda: source.answers > before + 1)

        context.drain.add(source)
        context.on_close(until_it_asked_again)
        context.shutdown()

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from studio.errors import TransitionError
from studio.ros.lifecycle import (
    LifecycleNode,
    LifecycleState,
    ManagedEntity,
    TransitionCallbackReturn,
)
from studio.ros.node.context import Context
from tests.support.wire import open_test_session, running_router

if TYPE_CHECKING:
    from collections.abc import Callable, Generator

pytestmark = pytest.mark.network
SUCCESS, FAILURE, ERROR = TransitionCallbackReturn


class Walker(LifecycleNode):
    """A managed node that keeps what it was called with, and may misbehave."""

    def __init__(self, context: Context) -> None:
        super().__init__("walker", context=context)
        self.called: list[tuple[str, LifecycleState]] = []
        self.acts: Callable[[], Any] = lambda: SUCCESS

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        self.called.append(("on_configure", state))
        return self.acts()

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        self.called.append(("on_error", state))
        return super().on_error(state)


@pytest.fixture(scope="module")
def context() -> Generator[Context]:
    with running_router() as endpoint, open_test_session(endpoint) as wire:
        joined = Context.over(wire)
        yield joined
        joined.shutdown()


@pytest.fixture
def walker(context: Context) -> Generator[Walker]:
    made = Walker(context)
    yield made
    made.destroy_node()


def test_a_node_begins_unconfigured_and_walks_when_it_is_told_to(walker: Walker):
    assert walker.current_state == ("unconfigured", 1)
    assert walker.trigger_configure() is SUCCESS
    assert walker.called == [("on_configure", ("unconfigured", 1))]
    assert walker.trigger_activate() is SUCCESS
    assert walker.current_state.label == "active"
    assert walker.trigger_deactivate() is SUCCESS
    assert walker.trigger_cleanup() is SUCCESS
    assert walker.trigger_shutdown() is SUCCESS
    assert walker.current_state.label == "finalized"
    with pytest.raises(TransitionError, match="it takes none"):
        walker.trigger_configure()


def test_a_callback_that_raises_is_an_error_that_is_cleared_up(
    walker: Walker, capsys: pytest.CaptureFixture[str]
):
    walker.acts = lambda: 1 / 0
    assert walker.trigger_configure() is ERROR
    assert walker.called[-1][0] == "on_error"
    assert walker.current_state.label == "unconfigured"
    assert "Error raised in on_configure" in capsys.readouterr().err


def test_a_callback_that_returns_nothing_is_an_error_and_says_so(
    walker: Walker, capsys: pytest.CaptureFixture[str]
):
    walker.acts = lambda: None
    assert walker.trigger_configure() is ERROR
    assert "on_configure returned no TransitionCallbackReturn" in capsys.readouterr().err


def test_entities_follow_the_node_and_may_hold_it_back(walker: Walker):
    class Stubborn(ManagedEntity):
        def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
            del state
            return FAILURE

    walker.add_managed_entity(Stubborn())
    walker.trigger_configure()
    assert walker.trigger_activate() is FAILURE
    assert walker.current_state.label == "inactive"

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.errors import TransitionError
from studio.ros.lifecycle.machine import (
    LifecycleMachine,
    StateId,
    Transition,
    TransitionCallbackReturn,
)

SUCCESS, FAILURE, ERROR = TransitionCallbackReturn


class Walk:
    """A machine whose callbacks end as they are told to, and what it did."""

    def __init__(self, **results: TransitionCallbackReturn) -> None:
        self.results = results
        self.called: list[tuple[str, StateId]] = []
        self.told: list[Transition] = []
        self.machine = LifecycleMachine(self._run, self.told.append)

    def _run(self, callback: str, before: StateId) -> TransitionCallbackReturn:
        self.called.append((callback, before))
        return self.results.get(callback, SUCCESS)

    def go(self, *transitions: int | str) -> StateId:
        for one in transitions:
            self.machine.trigger(one)
        return self.machine.state


def test_a_node_walks_its_four_states_and_back():
    walk = Walk()
    assert walk.go("configure") is StateId.INACTIVE
    assert walk.go("activate") is StateId.ACTIVE
    assert walk.go("deactivate") is StateId.INACTIVE
    assert walk.go("cleanup") is StateId.UNCONFIGURED
    assert walk.go("shutdown") is StateId.FINALIZED
    assert walk.machine.available() == []


def test_each_step_is_told_with_its_number():
    walk = Walk()
    walk.go(1, 3, 7)
    assert [one.id for one in walk.told] == [1, 10, 3, 30, 7, 50]
    assert walk.called == [
        ("on_configure", StateId.UNCONFIGURED),
        ("on_activate", StateId.INACTIVE),
        ("on_shutdown", StateId.ACTIVE),
    ]


@pytest.mark.parametrize(
    ("way", "failing", "after"),
    [
        (["configure"], "on_configure", StateId.UNCONFIGURED),
        (["configure", "cleanup"], "on_cleanup", StateId.INACTIVE),
        (["configure", "activate"], "on_activate", StateId.INACTIVE),
        (["configure", "activate", "deactivate"], "on_deactivate", StateId.ACTIVE),
        (["shutdown"], "on_shutdown", StateId.FINALIZED),
    ],
)
def test_a_callback_that_fails_leads_back(way: list[str], failing: str, after: StateId):
    walk = Walk(**{failing: FAILURE})
    assert walk.go(*way) is after


@pytest.mark.parametrize(
    ("on_error", "after"),
    [
        (SUCCESS, StateId.UNCONFIGURED),
        (FAILURE, StateId.FINALIZED),
        (ERROR, StateId.FINALIZED),
    ],
)
def test_an_error_is_worked_off_by_its_own_callback(
    on_error: TransitionCallbackReturn, after: StateId
):
    walk = Walk(on_configure=ERROR, on_error=on_error)
    assert walk.machine.trigger("configure") is ERROR
    assert walk.machine.state is after
    assert walk.called[-1][0] == "on_error"


def test_a_transition_that_begins_elsewhere_is_refused_with_those_that_do():
    walk = Walk()
    with pytest.raises(TransitionError, match=r"unconfigured.*it takes configure, shutdown"):
        walk.go("activate")
    with pytest.raises(TransitionError):
        walk.go(6)
    assert (walk.called, walk.told) == ([], [])


@given(st.lists(st.tuples(st.integers(0, 99), st.sampled_from(TransitionCallbackReturn))))
def test_a_node_always_rests_in_a_state_to_stay_in(
    steps: list[tuple[int, TransitionCallbackReturn]],
):
    walk = Walk()
    for number, result in steps:
        names = ("configure", "cleanup", "activate", "deactivate", "shutdown", "error")
        walk.results = {f"on_{name}": result for name in names}
        if number in {one.id for one in walk.machine.available()}:
            walk.go(number)
        else:
            with pytest.raises(TransitionError):
                walk.go(number)
        assert StateId.UNKNOWN < walk.machine.state < StateId.CONFIGURING

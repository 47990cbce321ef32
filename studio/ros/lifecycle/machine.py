"""The state machine of managed nodes, by the numbers and labels of lifecycle_msgs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum, IntEnum

from studio.errors import TransitionError


class StateId(IntEnum):
    """The states: 1 to 4 are those a node stays in, from 10 on it is between two of them."""

    UNKNOWN = 0
    UNCONFIGURED = 1
    INACTIVE = 2
    ACTIVE = 3
    FINALIZED = 4
    CONFIGURING = 10
    CLEANINGUP = 11
    SHUTTINGDOWN = 12
    ACTIVATING = 13
    DEACTIVATING = 14
    ERRORPROCESSING = 15

    @property
    def label(self) -> str:
        """The label in messages."""
        return self.name.lower()


class TransitionCallbackReturn(Enum):
    """Result of the callback of a transition, by rclpy's names."""

    SUCCESS = "transition_success"
    FAILURE = "transition_failure"
    ERROR = "transition_error"


@dataclass(frozen=True, slots=True)
class Transition:
    """From one state to another; transitions without a label that users know follow a callback."""

    id: int
    label: str
    start: StateId
    goal: StateId


_S = StateId
ASKED = (
    Transition(1, "configure", _S.UNCONFIGURED, _S.CONFIGURING),
    Transition(2, "cleanup", _S.INACTIVE, _S.CLEANINGUP),
    Transition(3, "activate", _S.INACTIVE, _S.ACTIVATING),
    Transition(4, "deactivate", _S.ACTIVE, _S.DEACTIVATING),
    Transition(5, "shutdown", _S.UNCONFIGURED, _S.SHUTTINGDOWN),
    Transition(6, "shutdown", _S.INACTIVE, _S.SHUTTINGDOWN),
    Transition(7, "shutdown", _S.ACTIVE, _S.SHUTTINGDOWN),
)
"""Transitions that other nodes may request."""

_ENDS = (
    (_S.CONFIGURING, 10, _S.INACTIVE, _S.UNCONFIGURED, _S.ERRORPROCESSING),
    (_S.CLEANINGUP, 20, _S.UNCONFIGURED, _S.INACTIVE, _S.ERRORPROCESSING),
    (_S.ACTIVATING, 30, _S.ACTIVE, _S.INACTIVE, _S.ERRORPROCESSING),
    (_S.DEACTIVATING, 40, _S.INACTIVE, _S.ACTIVE, _S.ERRORPROCESSING),
    (_S.SHUTTINGDOWN, 50, _S.FINALIZED, _S.FINALIZED, _S.ERRORPROCESSING),
    (_S.ERRORPROCESSING, 60, _S.UNCONFIGURED, _S.FINALIZED, _S.FINALIZED),
)
FOLLOWING = tuple(
    Transition(number + step, result.value, start, goals[step])
    for start, number, *goals in _ENDS
    for step, result in enumerate(TransitionCallbackReturn)
)
"""Transitions that follow from the result of a callback."""
TRANSITIONS = (*ASKED, *FOLLOWING)
CALLBACKS = {
    _S.CONFIGURING: "on_configure",
    _S.CLEANINGUP: "on_cleanup",
    _S.SHUTTINGDOWN: "on_shutdown",
    _S.ACTIVATING: "on_activate",
    _S.DEACTIVATING: "on_deactivate",
    _S.ERRORPROCESSING: "on_error",
}
"""The callback that does the work of a state between two others."""
RunCallback = Callable[[str, StateId], TransitionCallbackReturn]
"""Runs `on_configure` and so on with the state before; what it raises counts as ERROR."""
OnTransition = Callable[[Transition], None]


class LifecycleMachine:
    """State machine of a managed node; one thread changes it at a time."""

    def __init__(self, run: RunCallback, on_transition: OnTransition) -> None:
        self.state = StateId.UNCONFIGURED
        self._run = run
        self._on_transition = on_transition

    def available(self) -> list[Transition]:
        """Return the transitions that can be asked for now."""
        return [one for one in ASKED if one.start is self.state]

    def find(self, wanted: int | str) -> Transition:
        """Find a transition that begins here by its number or label.

        Raises:
            TransitionError: None does; those that do are named.
        """
        for one in self.available():
            if wanted in (one.id, one.label):
                return one
        known = [one.label for one in self.available()]
        raise TransitionError(str(wanted), self.state.label, known)

    def trigger(self, wanted: int | str) -> TransitionCallbackReturn:
        """Take a transition, with its callback and, where that errs, the one for errors.

        Raises:
            TransitionError: It does not begin in this state.
        """
        transition = self.find(wanted)
        before = self.state
        self._go(transition)
        result = self._work(before)
        if result is TransitionCallbackReturn.ERROR:
            self._work(before)
        return result

    def _work(self, before: StateId) -> TransitionCallbackReturn:
        """Run the callback of this state and go where its result leads."""
        result = self._run(CALLBACKS[self.state], before)
        following = next(
            one for one in FOLLOWING if one.start is self.state and one.label == result.value
        )
        self._go(following)
        return result

    def _go(self, transition: Transition) -> None:
        self.state = transition.goal
        self._on_transition(transition)

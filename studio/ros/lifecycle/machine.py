"""LifecycleMachine: the state of a managed node and the way through its transitions."""

from __future__ import annotations

from collections.abc import Callable

from studio.errors import TransitionError
from studio.ros.lifecycle.states import (
    ASKED,
    CALLBACKS,
    FOLLOWING,
    StateId,
    Transition,
    TransitionCallbackReturn,
)

RunCallback = Callable[[str, StateId], TransitionCallbackReturn]
"""Runs `on_configure` and so on with the state before; what it raises counts as ERROR."""
TellTransition = Callable[[Transition], None]


class LifecycleMachine:
    """Where a managed node stands; one thread changes it at a time."""

    def __init__(self, run: RunCallback, tell: TellTransition) -> None:
        self.state = StateId.UNCONFIGURED
        self._run = run
        self._tell = tell

    def available(self) -> list[Transition]:
        """Give the transitions that can be asked for now."""
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
        self._tell(transition)

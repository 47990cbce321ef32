"""Managed entities: parts of a managed node that work only while it is active."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from studio.ros.lifecycle.states import StateId, TransitionCallbackReturn
from studio.ros.node.publisher import Publisher

if TYPE_CHECKING:
    from studio.ros.node.endpoint import Endpoint
    from studio.ros.types.classes import MessageValue


class LifecycleState(NamedTuple):
    """A state as callbacks are given it."""

    label: str
    state_id: int

    @classmethod
    def of(cls, state: StateId) -> LifecycleState:
        """Make one of its number."""
        return cls(state.label, int(state))


class ManagedEntity:
    """Something whose callbacks are called with those of its node; each says how it went."""

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Make ready."""
        del state
        return TransitionCallbackReturn.SUCCESS

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Undo what made ready."""
        del state
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Let go of everything."""
        del state
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Begin to work."""
        del state
        return TransitionCallbackReturn.SUCCESS

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Rest."""
        del state
        return TransitionCallbackReturn.SUCCESS

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Clear up after an error."""
        del state
        return TransitionCallbackReturn.SUCCESS


class LifecyclePublisher(Publisher, ManagedEntity):
    """A publisher that sends only while its node is active; else messages are dropped."""

    def __init__(self, endpoint: Endpoint, msg_type: type[MessageValue]) -> None:
        super().__init__(endpoint, msg_type)
        self._is_activated = False

    @property
    def is_activated(self) -> bool:
        """Whether it sends."""
        return self._is_activated

    def publish(self, msg: MessageValue | bytes | bytearray) -> None:
        """Send a message if the node is active.

        Raises:
            MessageValueError: It is of another type, or a field holds what it does not take.
            DestroyedError: The publisher was destroyed.
        """
        if self._is_activated:
            super().publish(msg)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Send from now on."""
        self._is_activated = True
        return super().on_activate(state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Send no more."""
        self._is_activated = False
        return super().on_deactivate(state)

"""LifecycleServices: the five services of a managed node, and the topic of its transitions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from studio.errors import TransitionError
from studio.ros.lifecycle.states import TRANSITIONS, StateId, Transition, TransitionCallbackReturn

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from studio.ros.lifecycle.machine import LifecycleMachine
    from studio.ros.node.node import Node
    from studio.ros.types.classes import MessageValue

EVENT_DEPTH = 10


class LifecycleServices:
    """Lets other nodes see and change the state of a node."""

    def __init__(
        self,
        node: Node,
        machine: LifecycleMachine,
        trigger: Callable[[int | str], TransitionCallbackReturn],
    ) -> None:
        self._node = node
        self._machine = machine
        self._trigger = trigger
        types = node.wire.types
        self._state_type, self._transition_type, self._description_type, self._event_type = (
            types.message(f"lifecycle_msgs/msg/{name}")
            for name in ("State", "Transition", "TransitionDescription", "TransitionEvent")
        )
        self._events = node.create_publisher(self._event_type, "~/transition_event", EVENT_DEPTH)
        for kind, name, callback in (
            ("ChangeState", "change_state", self._on_change_state),
            ("GetState", "get_state", self._on_get_state),
            ("GetAvailableStates", "get_available_states", self._on_get_states),
            ("GetAvailableTransitions", "get_available_transitions", self._on_get_available),
            ("GetAvailableTransitions", "get_transition_graph", self._on_get_graph),
        ):
            node.create_service(types.service(f"lifecycle_msgs/srv/{kind}"), f"~/{name}", callback)

    def tell(self, transition: Transition) -> None:
        """Publish that a transition was taken."""
        event = self._event_type(
            transition=self._transition(transition),
            start_state=self._state(transition.start),
            goal_state=self._state(transition.goal),
        )
        now = self._node.get_clock().now()
        # Newer distributions carry a Time there, under another name.
        if "timestamp" in dir(event):
            event.timestamp = now.nanoseconds
        else:
            event.stamp = now.to_msg()
        self._events.publish(event)

    def _on_change_state(self, request: MessageValue, response: MessageValue) -> MessageValue:
        wanted = request.transition
        try:
            result = self._trigger(wanted.label or int(wanted.id))
        except TransitionError as error:
            self._node.get_logger().warning(str(error))
            return response
        response.success = result is TransitionCallbackReturn.SUCCESS
        return response

    def _on_get_state(self, request: MessageValue, response: MessageValue) -> MessageValue:
        del request
        response.current_state = self._state(self._machine.state)
        return response

    def _on_get_states(self, request: MessageValue, response: MessageValue) -> MessageValue:
        del request
        response.available_states = [self._state(one) for one in StateId]
        return response

    def _on_get_available(self, request: MessageValue, response: MessageValue) -> MessageValue:
        del request
        response.available_transitions = self._descriptions(self._machine.available())
        return response

    def _on_get_graph(self, request: MessageValue, response: MessageValue) -> MessageValue:
        del request
        response.available_transitions = self._descriptions(TRANSITIONS)
        return response

    def _descriptions(self, transitions: Iterable[Transition]) -> list[Any]:
        return [
            self._description_type(
                transition=self._transition(one),
                start_state=self._state(one.start),
                goal_state=self._state(one.goal),
            )
            for one in transitions
        ]

    def _transition(self, transition: Transition) -> MessageValue:
        return self._transition_type(id=transition.id, label=transition.label)

    def _state(self, state: StateId) -> MessageValue:
        return self._state_type(id=int(state), label=state.label)

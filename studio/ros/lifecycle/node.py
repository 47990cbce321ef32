"""LifecycleNode: a node with managed entities whose transitions others trigger, as in rclpy."""

from __future__ import annotations

import threading
import traceback
from typing import TYPE_CHECKING, Any, NamedTuple, cast

from studio.errors import TransitionError
from studio.ros.lifecycle.machine import (
    TRANSITIONS,
    LifecycleMachine,
    StateId,
    Transition,
    TransitionCallbackReturn,
)
from studio.ros.node.node import Node
from studio.ros.node.publisher import Publisher

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from studio.ros.node.base import Endpoint
    from studio.ros.qos import QoSProfile
    from studio.ros.types.classes import MessageValue

EVENT_DEPTH = 10


class LifecycleState(NamedTuple):
    """A state as callbacks are given it."""

    label: str
    state_id: int

    @classmethod
    def of(cls, state: StateId) -> LifecycleState:
        """Make one of its number."""
        return cls(state.label, int(state))


class ManagedEntity:
    """An object whose callbacks are called with those of its node; each returns its result."""

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Make ready."""
        del state
        return TransitionCallbackReturn.SUCCESS

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Undo `on_configure`."""
        del state
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Release everything."""
        del state
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Start to work."""
        del state
        return TransitionCallbackReturn.SUCCESS

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop to work."""
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
        types = node.context.wire.types
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

    def publish_transition(self, transition: Transition) -> None:
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


class LifecycleNode(Node, ManagedEntity):
    """A managed node: its callbacks do the work of transitions and return the result.

    A callback that is overridden calls that of this class where managed entities, such as
    lifecycle publishers, are to follow. One that raises counts as ERROR.
    """

    def __init__(
        self,
        node_name: str,
        *,
        enable_communication_interface: bool = True,
        **options: Any,  # noqa: ANN401  # those of Node
    ) -> None:
        super().__init__(node_name, **options)
        self._managed_entities: list[ManagedEntity] = []
        self._lifecycle_lock = threading.RLock()
        self._lifecycle_machine = LifecycleMachine(self._run_callback, self._publish_transition)
        self._lifecycle_services = (
            LifecycleServices(self, self._lifecycle_machine, self._trigger)
            if enable_communication_interface
            else None
        )

    @property
    def current_state(self) -> LifecycleState:
        """The current state."""
        return LifecycleState.of(self._lifecycle_machine.state)

    def add_managed_entity(self, entity: ManagedEntity) -> None:
        """Call an entity's callbacks with those of the node."""
        self._managed_entities.append(entity)

    def create_lifecycle_publisher(
        self,
        msg_type: type[MessageValue],
        topic: str,
        qos_profile: QoSProfile | int,
        **options: Any,  # noqa: ANN401  # those of create_publisher
    ) -> LifecyclePublisher:
        """Make a publisher that sends only while the node is active.

        Raises:
            RosNameError: The topic cannot be named so.
            DestroyedError: The node was destroyed.
        """
        made = cast(
            "LifecyclePublisher",
            self.create_publisher(
                msg_type, topic, qos_profile, publisher_class=LifecyclePublisher, **options
            ),
        )
        self.add_managed_entity(made)
        return made

    def destroy_lifecycle_publisher(self, publisher: LifecyclePublisher) -> bool:
        """Take back a lifecycle publisher; whether it was the node's."""
        if publisher in self._managed_entities:
            self._managed_entities.remove(publisher)
        return self.destroy_publisher(publisher)

    def trigger_configure(self) -> TransitionCallbackReturn:
        """Make ready.

        Raises:
            TransitionError: It is not unconfigured.
        """
        return self._trigger("configure")

    def trigger_cleanup(self) -> TransitionCallbackReturn:
        """Undo what made ready.

        Raises:
            TransitionError: It is not inactive.
        """
        return self._trigger("cleanup")

    def trigger_activate(self) -> TransitionCallbackReturn:
        """Begin to work.

        Raises:
            TransitionError: It is not inactive.
        """
        return self._trigger("activate")

    def trigger_deactivate(self) -> TransitionCallbackReturn:
        """Rest.

        Raises:
            TransitionError: It is not active.
        """
        return self._trigger("deactivate")

    def trigger_shutdown(self) -> TransitionCallbackReturn:
        """End for good.

        Raises:
            TransitionError: It has ended.
        """
        return self._trigger("shutdown")

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Make ready: override it."""
        return self._all("on_configure", state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Undo what made ready: override it."""
        return self._all("on_cleanup", state)

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Let go of everything: override it."""
        return self._all("on_shutdown", state)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Begin to work: override it, and call this one for lifecycle publishers to begin."""
        return self._all("on_activate", state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Rest: override it, and call this one for lifecycle publishers to rest."""
        return self._all("on_deactivate", state)

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Clear up after an error: override it."""
        return self._all("on_error", state)

    def _all(self, callback: str, state: LifecycleState) -> TransitionCallbackReturn:
        """Call those of the entities; the first that does not succeed ends it."""
        for entity in tuple(self._managed_entities):
            result = getattr(entity, callback)(state)
            if result is not TransitionCallbackReturn.SUCCESS:
                return result
        return TransitionCallbackReturn.SUCCESS

    def _trigger(self, wanted: int | str) -> TransitionCallbackReturn:
        with self._lifecycle_lock:
            return self._lifecycle_machine.trigger(wanted)

    def _run_callback(self, callback: str, before: StateId) -> TransitionCallbackReturn:
        try:
            result = getattr(self, callback)(LifecycleState.of(before))
        except Exception as error:  # noqa: BLE001  # of a callback of the user's
            text = "".join(traceback.format_exception(error)[-2:]).strip()
            self.get_logger().error(f"Error raised in {callback}: {text}")
            return TransitionCallbackReturn.ERROR
        if isinstance(result, TransitionCallbackReturn):
            return result
        self.get_logger().error(f"{callback} returned no TransitionCallbackReturn, which is ERROR.")
        return TransitionCallbackReturn.ERROR

    def _publish_transition(self, transition: Transition) -> None:
        if self._lifecycle_services is not None:
            self._lifecycle_services.publish_transition(transition)

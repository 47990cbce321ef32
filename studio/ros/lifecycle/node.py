"""LifecycleNode: a node whose work is made ready, begun and ended by others, by rclpy's names."""

from __future__ import annotations

import threading
import traceback
from typing import TYPE_CHECKING, Any, cast

from studio.ros.lifecycle.entities import LifecyclePublisher, LifecycleState, ManagedEntity
from studio.ros.lifecycle.machine import LifecycleMachine
from studio.ros.lifecycle.services import LifecycleServices
from studio.ros.lifecycle.states import StateId, Transition, TransitionCallbackReturn
from studio.ros.node.node import Node

if TYPE_CHECKING:
    from studio.ros.qos import QoSProfile
    from studio.ros.types.classes import MessageValue


class LifecycleNode(Node, ManagedEntity):
    """A managed node: its callbacks do the work of transitions and say how it went.

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
        self._lifecycle_machine = LifecycleMachine(self._run_callback, self._tell_transition)
        self._lifecycle_services = (
            LifecycleServices(self, self._lifecycle_machine, self._trigger)
            if enable_communication_interface
            else None
        )

    @property
    def current_state(self) -> LifecycleState:
        """Where it stands."""
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
            said = "".join(traceback.format_exception(error)[-2:]).strip()
            self.get_logger().error(f"Error raised in {callback}: {said}")
            return TransitionCallbackReturn.ERROR
        if isinstance(result, TransitionCallbackReturn):
            return result
        self.get_logger().error(f"{callback} returned no TransitionCallbackReturn, which is ERROR.")
        return TransitionCallbackReturn.ERROR

    def _tell_transition(self, transition: Transition) -> None:
        if self._lifecycle_services is not None:
            self._lifecycle_services.tell(transition)

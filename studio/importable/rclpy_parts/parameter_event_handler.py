"""ParameterEventHandler: calls back when parameters of nodes change."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from studio.ros.messages import message
from studio.ros.parameters.node_parameters import EVENTS_TOPIC
from studio.ros.qos import QoSProfile, qos_profile_parameter_events

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from studio.ros.node.node import Node
    from studio.ros.node.work import CallbackGroup
    from studio.ros.parameters.parameter import Parameter


@dataclass(eq=False)
class ParameterEventCallbackHandle:
    """A callback on all events."""

    callback: Callable[[Any], object]


@dataclass(eq=False)
class ParameterCallbackHandle:
    """A callback on one parameter of one node."""

    parameter_name: str
    node_name: str
    callback: Callable[[Any], object]


class ParameterEventHandler:
    """Listens to the events of parameters, also of other nodes."""

    def __init__(
        self,
        node: Node,
        qos_profile: QoSProfile = qos_profile_parameter_events,
        callback_group: CallbackGroup | None = None,
        **options: Any,  # noqa: ANN401 - those of the subscription
    ) -> None:
        self._node = node
        self._of_events: list[ParameterEventCallbackHandle] = []
        self._of_parameters: list[ParameterCallbackHandle] = []
        self._subscription = node.create_subscription(
            message("rcl_interfaces/msg/ParameterEvent"),
            EVENTS_TOPIC,
            self._hear,
            qos_profile,
            callback_group=callback_group,
            **options,
        )

    def destroy(self) -> None:
        """Listen no more."""
        self._node.destroy_subscription(self._subscription)

    def add_parameter_callback(
        self,
        parameter_name: str,
        node_name: str,
        callback: Callable[[Parameter], object],
    ) -> ParameterCallbackHandle:
        """Call back with a message of the parameter when it changes."""
        full_name = self._full_name(node_name)
        handle = ParameterCallbackHandle(parameter_name, full_name, callback)
        self._of_parameters.insert(0, handle)
        return handle

    def remove_parameter_callback(self, handle: ParameterCallbackHandle) -> None:
        """Do not call back.

        Raises:
            RuntimeError: It is not known.
        """
        _remove(self._of_parameters, handle)

    def add_parameter_event_callback(
        self, callback: Callable[[Any], object]
    ) -> ParameterEventCallbackHandle:
        """Call back with every event."""
        handle = ParameterEventCallbackHandle(callback)
        self._of_events.insert(0, handle)
        return handle

    def remove_parameter_event_callback(self, handle: ParameterEventCallbackHandle) -> None:
        """Do not call back.

        Raises:
            RuntimeError: It is not known.
        """
        _remove(self._of_events, handle)

    @staticmethod
    def get_parameter_from_event(event: Any, parameter_name: str, node_name: str) -> Any:  # noqa: ANN401
        """Return the message of a parameter of an event; None without."""
        if event.node != node_name:
            return None
        return next((one for one in _changed(event) if one.name == parameter_name), None)

    @staticmethod
    def get_parameters_from_event(event: Any) -> Iterable[Any]:  # noqa: ANN401
        """Return the messages of all parameters that are new or changed."""
        return _changed(event)

    def _full_name(self, node_name: str) -> str:
        return (
            self._node.resolve_service_name(node_name)
            if node_name
            else (self._node.get_fully_qualified_name())
        )

    def _hear(self, event: Any) -> None:  # noqa: ANN401
        for handle in tuple(self._of_parameters):
            found = self.get_parameter_from_event(event, handle.parameter_name, handle.node_name)
            if found is not None:
                handle.callback(found)
        for each in tuple(self._of_events):
            each.callback(event)


def _changed(event: Any) -> list[Any]:  # noqa: ANN401
    return [*event.new_parameters, *event.changed_parameters]


def _remove(handles: list[Any], handle: object) -> None:
    if handle not in handles:
        raise RuntimeError("Callback doesn't exist")
    handles.remove(handle)

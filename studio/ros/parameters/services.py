"""ParameterServices: the six services of a node's parameters, and the topic of their changes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from studio.errors import ParameterError
from studio.ros.parameters.listing import listed, prefixes_of
from studio.ros.parameters.parameter import Parameter
from studio.ros.parameters.values import ParameterType
from studio.ros.qos import qos_profile_parameter_events, qos_profile_parameters

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from studio.ros.hosting import Host
    from studio.ros.parameters.store import ParameterChange, ParameterStore
    from studio.ros.types.classes import MessageValue
    from studio.ros.types.library import ServiceType, TypeLibrary

EVENTS_TOPIC = "/parameter_events"


class ParameterEvents:
    """Tells changes on `/parameter_events`."""

    def __init__(self, host: Host, types: TypeLibrary) -> None:
        self._host = host
        self._kind = types.message("rcl_interfaces/msg/ParameterEvent")
        self._publisher = host.create_publisher(
            self._kind, EVENTS_TOPIC, qos_profile_parameter_events
        )

    def tell(self, store: ParameterStore, change: ParameterChange) -> None:
        """Publish one change."""
        if not (change.new or change.changed or change.deleted):
            return
        self._publisher.publish(
            self._kind(
                stamp=self._host.get_clock().now().to_msg(),
                node=self._host.get_fully_qualified_name(),
                new_parameters=_messages(store, change.new),
                changed_parameters=_messages(store, change.changed),
                deleted_parameters=_messages(store, change.deleted),
            )
        )


class ParameterServices:
    """Serves the parameters of a node to all others.

    What a request asks wrongly is answered in its response, by the reasons that the store gives;
    a callback of the user that raises is a refusal, and its error goes to the log.
    """

    def __init__(self, host: Host, types: TypeLibrary, store: ParameterStore) -> None:
        self._host = host
        self._store = store
        self.services = [
            self._serve(types.service(f"rcl_interfaces/srv/{kind}"), name, callback)
            for kind, name, callback in (
                ("DescribeParameters", "describe_parameters", self._describe),
                ("GetParameterTypes", "get_parameter_types", self._get_types),
                ("GetParameters", "get_parameters", self._get),
                ("ListParameters", "list_parameters", self._list),
                ("SetParameters", "set_parameters", self._set),
                ("SetParametersAtomically", "set_parameters_atomically", self._set_atomically),
            )
        ]

    def _serve(
        self,
        kind: ServiceType,
        name: str,
        callback: Callable[[MessageValue, MessageValue], MessageValue],
    ) -> Any:  # noqa: ANN401
        full_name = f"{self._host.get_fully_qualified_name()}/{name}"
        return self._host.create_service(
            kind, full_name, callback, qos_profile=qos_profile_parameters
        )

    def _describe(self, request: MessageValue, response: MessageValue) -> MessageValue:
        response.descriptors = [self._descriptor(name) for name in request.names]
        return response

    def _get_types(self, request: MessageValue, response: MessageValue) -> MessageValue:
        response.types = [int(self._known(name).type_) for name in request.names]
        return response

    def _get(self, request: MessageValue, response: MessageValue) -> MessageValue:
        messages = self._store.messages
        response.values = [
            self._known(name).to_parameter_msg(messages).value for name in request.names
        ]
        return response

    def _list(self, request: MessageValue, response: MessageValue) -> MessageValue:
        names = listed(self._store.all(), request.prefixes, int(request.depth))
        response.result.names = names
        response.result.prefixes = prefixes_of(names)
        return response

    def _set(self, request: MessageValue, response: MessageValue) -> MessageValue:
        response.results = [self._try([parameter]) for parameter in request.parameters]
        return response

    def _set_atomically(self, request: MessageValue, response: MessageValue) -> MessageValue:
        response.result = self._try(request.parameters)
        return response

    def _try(self, wanted: Iterable[MessageValue]) -> MessageValue:
        try:
            given = [Parameter.from_parameter_msg(one) for one in wanted]
            result, parameters = self._store.settle(given)
        except ParameterError as error:
            return self._refusal(str(error))
        except Exception as error:  # noqa: BLE001  # of a callback of the user's
            said = f"a callback of the node failed: {type(error).__name__}: {error}"
            self._host.get_logger().error(f"A parameter was not set: {said}")
            return self._refusal(said)
        if result.successful:
            self._tell_set(parameters)
        return result

    def _tell_set(self, parameters: list[Parameter]) -> None:
        """Call back after parameters were set: whatever that raises, they are."""
        try:
            self._store.callbacks.after(parameters)
        except Exception as error:  # noqa: BLE001  # of a callback of the user's
            self._host.get_logger().error(
                "A callback of the node failed after parameters were set: "
                f"{type(error).__name__}: {error}"
            )

    def _refusal(self, reason: str) -> MessageValue:
        return self._store.messages.SetParametersResult(successful=False, reason=reason)

    def _descriptor(self, name: str) -> MessageValue:
        try:
            return self._store.describe(name)
        except ParameterError:
            return self._store.messages.ParameterDescriptor(name=name)

    def _known(self, name: str) -> Parameter:
        """Give a parameter; one that is not declared is told as one that is not set."""
        try:
            return self._store.get(name)
        except ParameterError:
            return Parameter(name, ParameterType.NOT_SET)


def _messages(store: ParameterStore, parameters: Iterable[Parameter]) -> list[MessageValue]:
    return [one.to_parameter_msg(store.messages) for one in parameters]

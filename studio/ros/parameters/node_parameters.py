"""NodeParameters: the parameters of a node, for its own code and for other nodes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

from studio.errors import NotCallableError, ParameterError
from studio.ros.parameters.parameter import Parameter, ParameterMessages, ParameterType
from studio.ros.parameters.store import ParameterStore
from studio.ros.qos import qos_profile_parameter_events, qos_profile_parameters

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from studio.ros.parameters.store import (
        OnSetCallback,
        ParameterCallbacks,
        ParameterChange,
        PostSetCallback,
        PreSetCallback,
    )
    from studio.ros.qos import QoSProfile
    from studio.ros.types.classes import MessageValue
    from studio.ros.types.library import ServiceType, TypeLibrary

DEPTH_RECURSIVE = 0
SEPARATOR = "."
EVENTS_TOPIC = "/parameter_events"
USE_SIM_TIME = "use_sim_time"


def list_names(names: Iterable[str], prefixes: Iterable[str] = (), depth: int = 0) -> list[str]:
    """Choose names, in the order of the alphabet; no prefix is all, depth 0 any depth."""
    wanted = list(prefixes)
    return sorted(name for name in names if _is_meant(name, wanted, depth))


def prefixes_of(names: Iterable[str]) -> list[str]:
    """Name the groups that lie directly above names: `a.b` of `a.b.c`."""
    return sorted({name.rpartition(SEPARATOR)[0] for name in names if SEPARATOR in name})


def _is_meant(name: str, prefixes: list[str], depth: int) -> bool:
    if not prefixes:
        return _within(name, depth)
    for prefix in prefixes:
        rest = name.removeprefix(prefix + SEPARATOR)
        if name == prefix or (rest != name and _within(rest, depth)):
            return True
    return False


def _within(name: str, depth: int) -> bool:
    return depth == DEPTH_RECURSIVE or name.count(SEPARATOR) < depth


class ParameterEvents:
    """Publishes changes on `/parameter_events`."""

    def __init__(self, host: ParameterHost, types: TypeLibrary) -> None:
        self._host = host
        self._kind = types.message("rcl_interfaces/msg/ParameterEvent")
        self._publisher = host.create_publisher(
            self._kind, EVENTS_TOPIC, qos_profile_parameter_events
        )

    def publish(self, store: ParameterStore, change: ParameterChange) -> None:
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

    A wrong request is answered in its response, with the reasons of the store;
    a callback of the user that raises is a refusal, and its error goes to the log.
    """

    def __init__(self, host: ParameterHost, types: TypeLibrary, store: ParameterStore) -> None:
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
        names = list_names(self._store.all(), request.prefixes, int(request.depth))
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
            text = f"a callback of the node failed: {type(error).__name__}: {error}"
            self._host.get_logger().error(f"A parameter was not set: {text}")
            return self._refusal(text)
        if result.successful:
            self._publish_set(parameters)
        return result

    def _publish_set(self, parameters: list[Parameter]) -> None:
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
        """Return a parameter; one that is not declared as one that is not set."""
        try:
            return self._store.get(name)
        except ParameterError:
            return Parameter(name, ParameterType.NOT_SET)


def _messages(store: ParameterStore, parameters: Iterable[Parameter]) -> list[MessageValue]:
    return [one.to_parameter_msg(store.messages) for one in parameters]


class NodeParameters:
    """The parameters of a node, which derives from it and calls `open_parameters` first."""

    _parameter_store: ParameterStore

    def open_parameters(
        self,
        host: ParameterHost,
        types: TypeLibrary,
        *,
        overrides: Iterable[Parameter] = (),
        allow_undeclared: bool = False,
        declare_overrides: bool = False,
        serve: bool = True,
    ) -> None:
        """Make the store of a node, its services and its topic of changes.

        Args:
            host: The node, which can publish and serve already.
            types: Those of the node's session.
            overrides: Values given at the start.
            allow_undeclared: Accept parameters that were not declared.
            declare_overrides: Declare the values given at the start.
            serve: Let other nodes get and set them.
        """
        events = ParameterEvents(host, types)
        self._parameter_store = ParameterStore(
            lambda change: events.publish(self._parameter_store, change),
            messages=ParameterMessages.of(types),
            overrides={one.name: one for one in overrides},
            allow_undeclared=allow_undeclared,
        )
        self.declare_parameter(USE_SIM_TIME, value=False)
        if declare_overrides:
            for one in self._parameter_store.overrides.values():
                if not self._parameter_store.has(one.name):
                    self.declare_parameter(one.name, one.value, ignore_override=True)
        if serve:
            ParameterServices(host, types, self._parameter_store)

    def declare_parameter(
        self,
        name: str,
        value: Any = None,  # noqa: ANN401
        descriptor: MessageValue | None = None,
        ignore_override: bool = False,  # noqa: FBT001, FBT002  # as in rclpy
    ) -> Parameter:
        """Declare a parameter by its value, or by its type as `Parameter.Type.STRING`.

        Raises:
            ParameterAlreadyDeclaredError: There is one of that name.
            InvalidParameterTypeError: It is given another type at the start.
            InvalidParameterValueError: Its value is refused.
        """
        return self._parameter_store.declare(
            name, value, descriptor, ignore_override=ignore_override
        )

    def declare_parameters(
        self,
        namespace: str,
        parameters: Iterable[tuple[Any, ...]],
        ignore_override: bool = False,  # noqa: FBT001, FBT002  # as in rclpy
    ) -> list[Parameter]:
        """Declare several as (name, value, descriptor), the last two left out where not needed.

        Raises:
            ParameterError: One is refused; those before it are declared.
        """
        before = f"{namespace}." if namespace else ""
        return [
            self.declare_parameter(f"{before}{name}", *rest, ignore_override=ignore_override)
            for name, *rest in parameters
        ]

    def undeclare_parameter(self, name: str) -> None:
        """Take a parameter away.

        Raises:
            ParameterNotDeclaredError: There is none of that name.
            ParameterImmutableError: It may only be read.
        """
        self._parameter_store.undeclare(name)

    def has_parameter(self, name: str) -> bool:
        """Whether a parameter of that name is declared."""
        return self._parameter_store.has(name)

    def get_parameter(self, name: str) -> Parameter:
        """Return a parameter.

        Raises:
            ParameterNotDeclaredError: There is none of that name.
            ParameterUninitializedError: It has no value yet.
        """
        return self._parameter_store.get(name)

    def get_parameters(self, names: Iterable[str]) -> list[Parameter]:
        """Return several parameters in the order asked."""
        return [self.get_parameter(name) for name in names]

    def get_parameter_or(
        self,
        name: str,
        alternative_value: Any = None,  # noqa: ANN401  # a Parameter or a value
    ) -> Parameter:
        """Return a parameter, or another value where there is none or it is not set."""
        if self._parameter_store.has(name):
            found = self._parameter_store.all()[name]
            if found.type_ is not Parameter.Type.NOT_SET:
                return found
        if isinstance(alternative_value, Parameter):
            return alternative_value
        return Parameter(name, value=alternative_value)

    def get_parameter_type(self, name: str) -> ParameterType:
        """Return the type of a parameter.

        Raises:
            ParameterNotDeclaredError: There is none of that name.
        """
        return self.get_parameter(name).type_

    def get_parameters_by_prefix(self, prefix: str) -> dict[str, Parameter]:
        """Return the parameters of a group, by what follows `prefix.`; of no prefix, all."""
        before = f"{prefix}." if prefix else ""
        found: Mapping[str, Parameter] = self._parameter_store.all()
        return {
            name.removeprefix(before): one for name, one in found.items() if name.startswith(before)
        }

    def set_parameters(self, parameter_list: Iterable[Parameter]) -> list[MessageValue]:
        """Set parameters one after another, and return a SetParametersResult of each.

        Raises:
            ParameterNotDeclaredError: One is not declared; those before it are set.
        """
        return self._parameter_store.set(parameter_list)

    def set_parameters_atomically(self, parameter_list: Iterable[Parameter]) -> MessageValue:
        """Set all or none, and return one SetParametersResult.

        Raises:
            ParameterNotDeclaredError: One is not declared; none is set.
        """
        return self._parameter_store.set_atomically(parameter_list)

    def describe_parameter(self, name: str) -> MessageValue:
        """Return the ParameterDescriptor of a parameter.

        Raises:
            ParameterNotDeclaredError: There is none of that name.
        """
        return self._parameter_store.describe(name)

    def describe_parameters(self, names: Iterable[str]) -> list[MessageValue]:
        """Return several descriptors in the order asked."""
        return [self.describe_parameter(name) for name in names]

    def get_parameter_types(self, names: Iterable[str]) -> list[ParameterType]:
        """Return several types in the order asked."""
        return [self.get_parameter_type(name) for name in names]

    def set_descriptor(
        self,
        name: str,
        descriptor: MessageValue,
        alternative_value: Any = None,  # noqa: ANN401
    ) -> Any:  # noqa: ANN401  # the value that it has now
        """Return a parameter another descriptor, and another value where the old one does not fit.

        Raises:
            ParameterNotDeclaredError: There is none of that name.
            ParameterImmutableError: It may only be read.
            InvalidParameterTypeError: The value is of another type.
            InvalidParameterValueError: The value is outside the new range.
        """
        return self._parameter_store.redescribe(name, descriptor, alternative_value)

    def add_pre_set_parameters_callback(self, callback: PreSetCallback) -> None:
        """Let a callback change what is to be set."""
        self._callbacks.pre_set.insert(0, callback)

    def add_on_set_parameters_callback(self, callback: OnSetCallback) -> None:
        """Ask a callback before parameters are set; it returns a SetParametersResult.

        Raises:
            NotCallableError: It is no function.
        """
        _check_callable(callback)
        self._callbacks.on_set.insert(0, callback)

    def add_post_set_parameters_callback(self, callback: PostSetCallback) -> None:
        """Call a callback after parameters were set.

        Raises:
            NotCallableError: It is no function.
        """
        _check_callable(callback)
        self._callbacks.post_set.insert(0, callback)

    def remove_pre_set_parameters_callback(self, callback: PreSetCallback) -> None:
        """Call a callback no more.

        Raises:
            ValueError: It was not added.
        """
        self._callbacks.pre_set.remove(callback)

    def remove_on_set_parameters_callback(self, callback: OnSetCallback) -> None:
        """Call a callback no more.

        Raises:
            ValueError: It was not added.
        """
        self._callbacks.on_set.remove(callback)

    def remove_post_set_parameters_callback(self, callback: PostSetCallback) -> None:
        """Call a callback no more.

        Raises:
            ValueError: It was not added.
        """
        self._callbacks.post_set.remove(callback)

    @property
    def _callbacks(self) -> ParameterCallbacks:
        return self._parameter_store.callbacks


class ParameterHost(Protocol):
    """The part of a node that its parameters use."""

    def create_service(
        self,
        srv_type: Any,  # noqa: ANN401
        srv_name: str,
        callback: Callable[[Any, Any], Any],
        *,
        qos_profile: QoSProfile = ...,
    ) -> Any:  # noqa: ANN401
        """Serve; the callback fills the response and returns it."""
        ...

    def create_publisher(
        self,
        msg_type: Any,  # noqa: ANN401
        topic: str,
        qos_profile: QoSProfile | int,
    ) -> Any:  # noqa: ANN401
        """Create a publisher."""
        ...

    def get_fully_qualified_name(self) -> str:
        """Return namespace and name."""
        ...

    def get_clock(self) -> Any:  # noqa: ANN401
        """Return its clock."""
        ...

    def get_logger(self) -> Any:  # noqa: ANN401
        """Return its logger."""
        ...


def _check_callable(callback: object) -> None:
    if not callable(callback):
        raise NotCallableError(f"{callback!r:.60}")

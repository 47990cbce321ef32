"""NodeParameters: what a node offers of its parameters, by rclpy's names."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from studio.ros.parameters.messages import ParameterMessages
from studio.ros.parameters.parameter import Parameter
from studio.ros.parameters.services import ParameterEvents, ParameterServices
from studio.ros.parameters.store import ParameterStore

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from studio.ros.hosting import Host
    from studio.ros.parameters.callbacks import (
        OnSetCallback,
        ParameterCallbacks,
        PostSetCallback,
        PreSetCallback,
    )
    from studio.ros.parameters.values import ParameterType
    from studio.ros.types.classes import MessageValue
    from studio.ros.types.library import TypeLibrary

USE_SIM_TIME = "use_sim_time"


class NodeParameters:
    """The parameters of a node, which derives from it and calls `open_parameters` first."""

    _parameter_store: ParameterStore

    def open_parameters(
        self,
        host: Host,
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
            types: Those that the node's session speaks.
            overrides: Values given at the start.
            allow_undeclared: Take parameters that nobody declared.
            declare_overrides: Declare what was given at the start by itself.
            serve: Let other nodes ask and set.
        """
        events = ParameterEvents(host, types)
        self._parameter_store = ParameterStore(
            lambda change: events.tell(self._parameter_store, change),
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
        """Give a parameter.

        Raises:
            ParameterNotDeclaredError: There is none of that name.
            ParameterUninitializedError: It has no value yet.
        """
        return self._parameter_store.get(name)

    def get_parameters(self, names: Iterable[str]) -> list[Parameter]:
        """Give several parameters in the order asked."""
        return [self.get_parameter(name) for name in names]

    def get_parameter_or(
        self,
        name: str,
        alternative_value: Any = None,  # noqa: ANN401  # a Parameter or a value
    ) -> Parameter:
        """Give a parameter, or another value where there is none or it is not set."""
        if self._parameter_store.has(name):
            found = self._parameter_store.all()[name]
            if found.type_ is not Parameter.Type.NOT_SET:
                return found
        if isinstance(alternative_value, Parameter):
            return alternative_value
        return Parameter(name, value=alternative_value)

    def get_parameter_type(self, name: str) -> ParameterType:
        """Give the type of a parameter.

        Raises:
            ParameterNotDeclaredError: There is none of that name.
        """
        return self.get_parameter(name).type_

    def get_parameters_by_prefix(self, prefix: str) -> dict[str, Parameter]:
        """Give the parameters of a group, by what follows `prefix.`; of no prefix, all."""
        before = f"{prefix}." if prefix else ""
        found: Mapping[str, Parameter] = self._parameter_store.all()
        return {
            name.removeprefix(before): one for name, one in found.items() if name.startswith(before)
        }

    def set_parameters(self, parameter_list: Iterable[Parameter]) -> list[MessageValue]:
        """Set parameters one after another, and give a SetParametersResult of each.

        Raises:
            ParameterNotDeclaredError: One is not declared; those before it are set.
        """
        return self._parameter_store.set(parameter_list)

    def set_parameters_atomically(self, parameter_list: Iterable[Parameter]) -> MessageValue:
        """Set all or none, and give one SetParametersResult.

        Raises:
            ParameterNotDeclaredError: One is not declared; none is set.
        """
        return self._parameter_store.set_atomically(parameter_list)

    def describe_parameter(self, name: str) -> MessageValue:
        """Give the ParameterDescriptor of a parameter.

        Raises:
            ParameterNotDeclaredError: There is none of that name.
        """
        return self._parameter_store.describe(name)

    def describe_parameters(self, names: Iterable[str]) -> list[MessageValue]:
        """Give several descriptors in the order asked."""
        return [self.describe_parameter(name) for name in names]

    def get_parameter_types(self, names: Iterable[str]) -> list[ParameterType]:
        """Give several types in the order asked."""
        return [self.get_parameter_type(name) for name in names]

    def set_descriptor(
        self,
        name: str,
        descriptor: MessageValue,
        alternative_value: Any = None,  # noqa: ANN401
    ) -> Any:  # noqa: ANN401  # the value that it has now
        """Give a parameter another descriptor, and another value where the old one does not fit.

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
        """Ask a callback before parameters are set; it gives a SetParametersResult."""
        self._callbacks.on_set.insert(0, callback)

    def add_post_set_parameters_callback(self, callback: PostSetCallback) -> None:
        """Tell a callback after parameters were set."""
        self._callbacks.post_set.insert(0, callback)

    def remove_pre_set_parameters_callback(self, callback: PreSetCallback) -> None:
        """Ask a callback no more.

        Raises:
            ValueError: It was not added.
        """
        self._callbacks.pre_set.remove(callback)

    def remove_on_set_parameters_callback(self, callback: OnSetCallback) -> None:
        """Ask a callback no more.

        Raises:
            ValueError: It was not added.
        """
        self._callbacks.on_set.remove(callback)

    def remove_post_set_parameters_callback(self, callback: PostSetCallback) -> None:
        """Tell a callback no more.

        Raises:
            ValueError: It was not added.
        """
        self._callbacks.post_set.remove(callback)

    @property
    def _callbacks(self) -> ParameterCallbacks:
        return self._parameter_store.callbacks

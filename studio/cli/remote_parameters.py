"""The parameters of another node, asked for through its services."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from studio.cli.asking import ask_node
from studio.ros.parameters.messages import ParameterMessages, value_message, value_of
from studio.ros.parameters.parameter import Parameter

if TYPE_CHECKING:
    from collections.abc import Sequence

    from studio.cli.acting import Actor

_TYPES = "rcl_interfaces/srv"
LIST_TYPE = f"{_TYPES}/ListParameters"


class RemoteParameters:
    """Of one node, by its full name; every question may end in NotServedError or NoAnswerError."""

    def __init__(self, actor: Actor, node: str) -> None:
        self._actor, self.node = actor, node
        self._messages = ParameterMessages.of(actor.types)

    def names(self, prefixes: Sequence[str] = ()) -> list[str]:
        """Name them in order, all or those below prefixes."""
        answer = self._ask("ListParameters", "list_parameters", prefixes=list(prefixes), depth=0)
        return sorted(answer.result.names)

    def get(self, names: Sequence[str]) -> list[Parameter]:
        """Give those of these names; one that is not there has no value.

        Raises:
            InvalidParameterTypeError: The node gave a value of no known type.
        """
        values = self._ask("GetParameters", "get_parameters", names=list(names)).values
        return [_parameter(name, value) for name, value in zip(names, values, strict=False)]

    def set(self, parameter: Parameter) -> tuple[bool, str]:
        """Set one; gives whether the node took it, and its reason."""
        value = value_message(parameter.type_, parameter.value, self._messages)
        message = self._messages.Parameter(name=parameter.name, value=value)
        results = self._ask("SetParameters", "set_parameters", parameters=[message]).results
        if not results:
            return False, "the node did not say why"
        return bool(results[0].successful), results[0].reason

    def describe(self, names: Sequence[str]) -> list[Any]:
        """Give their descriptors."""
        answer = self._ask("DescribeParameters", "describe_parameters", names=list(names))
        return list(answer.descriptors)

    def _ask(self, kind: str, service: str, **fields: Any) -> Any:  # noqa: ANN401
        return ask_node(self._actor, f"{_TYPES}/{kind}", f"{self.node}/{service}", **fields)


def _parameter(name: str, message: Any) -> Parameter:  # noqa: ANN401
    kind, value = value_of(name, message)
    return Parameter(name, kind, value)

"""Functions of rclpy.parameter."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from studio.ros.parameter_client import AsyncParameterClient as Client
from studio.ros.parameters.files import read_all_parameters, read_parameters, text_of
from studio.ros.parameters.parameter import Parameter, read_value, value_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from studio.ros.node.task import Future
    from studio.ros.parameter_client import Done
    from studio.ros.types.classes import MessageValue

PARAMETER_SEPARATOR_STRING: Final = "."


def get_parameter_value(string_value: str) -> MessageValue:
    """Return what a text of YAML means as a `ParameterValue`."""
    return Parameter("value", value=read_value(string_value)).get_parameter_value()


def parameter_value_to_python(parameter_value: MessageValue) -> Any:  # noqa: ANN401
    """Return a `ParameterValue` in plain Python.

    Raises:
        RuntimeError: Its type is none.
    """
    try:
        return value_of("value", parameter_value)[1]
    except ValueError as error:
        raise RuntimeError(str(error)) from None


def parameter_dict_from_yaml_file(
    parameter_file: str,
    use_wildcard: bool = False,  # noqa: FBT001, FBT002 - rclpy's
    target_nodes: Sequence[str] | None = None,
    namespace: str = "",
) -> dict[str, MessageValue]:
    """Return the messages of the parameters of a file, by name.

    Args:
        parameter_file: Its path.
        use_wildcard: Whether names of nodes with `*` count.
        target_nodes: Whose parameters are wanted, by full names; those of all nodes without.
        namespace: What is put before each name.

    Raises:
        ParameterFileError: It cannot be read, or holds no parameters.
        RuntimeError: It has none for these nodes.
    """
    text = text_of(parameter_file)
    if target_nodes:
        read = [
            one
            for node in target_nodes
            for one in read_parameters(text, node, parameter_file, wildcards=use_wildcard)
        ]
    else:
        read = read_all_parameters(text, parameter_file, wildcards=use_wildcard)
    if not read:
        raise RuntimeError(f"{parameter_file} has no parameters for {target_nodes or 'any node'}")
    found: dict[str, MessageValue] = {}
    for one in read:
        message = one.to_parameter_msg()
        message.name = namespace + one.name
        found[message.name] = message
    return found


class AsyncParameterClient(Client):
    """As the studio's own, which loads from a file what is meant for its node alone."""

    def load_parameter_file(
        self,
        parameter_file: str,
        use_wildcard: bool = False,  # noqa: FBT001, FBT002 - rclpy's
        callback: Done | None = None,
    ) -> Future[Any]:
        """Set all that a file has, for whichever node it is meant.

        Raises:
            ParameterFileError: It cannot be read, or holds no parameters.
            RuntimeError: It has none.
        """
        found = parameter_dict_from_yaml_file(parameter_file, use_wildcard)
        return self.set_parameters(
            [Parameter.from_parameter_msg(one) for one in found.values()], callback
        )

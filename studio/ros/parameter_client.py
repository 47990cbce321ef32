"""Parameter clients: read and set the parameters of another node, awaited or as futures."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from studio.errors import NotServedError
from studio.ros.node.spinning import ANSWER_TIMEOUT_S, wait_for_answer
from studio.ros.parameters.files import read_parameters, write_parameters
from studio.ros.parameters.parameter import Parameter, ParameterMessages, ParameterType, value_of
from studio.ros.qos import QoSProfile, qos_profile_services_default

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence
    from typing import Self

    from studio.ros.node.node import Node
    from studio.ros.node.service_client import Client
    from studio.ros.node.task import Future
    from studio.ros.node.work import CallbackGroup
    from studio.ros.types.classes import MessageValue

Done: TypeAlias = "Callable[[Future[Any]], object]"
_SERVICES = {
    "list_parameters": "ListParameters",
    "get_parameters": "GetParameters",
    "get_parameter_types": "GetParameterTypes",
    "describe_parameters": "DescribeParameters",
    "set_parameters": "SetParameters",
    "set_parameters_atomically": "SetParametersAtomically",
}


class AsyncParameterClient:
    """Futures become responses of the services of rcl_interfaces.

    Attributes:
        remote: The full name of the other node.
        clients: Those of its services, by their names.
    """

    def __init__(
        self,
        node: Node,
        remote_node_name: str,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> None:
        self._node = node
        self.remote = node.resolve_service_name(remote_node_name)
        self._messages = ParameterMessages.of(node.context.wire.types)
        self.clients: dict[str, Client] = {
            name: node.create_client(
                node.context.wire.types.service(f"rcl_interfaces/srv/{kind}"),
                f"{self.remote}/{name}",
                qos_profile=qos_profile,
                callback_group=callback_group,
            )
            for name, kind in _SERVICES.items()
        }

    def services_are_ready(self) -> bool:
        """Whether the node serves its parameters."""
        return all(client.service_is_ready() for client in self.clients.values())

    def wait_for_services(self, timeout_sec: float | None = None) -> bool:
        """Wait until the node serves its parameters; False when it does not in time."""
        end_s = None if timeout_sec is None else time.monotonic() + timeout_sec
        for client in self.clients.values():
            left_s = None if end_s is None else max(0.0, end_s - time.monotonic())
            if not client.wait_for_service(timeout_sec=left_s):
                return False
        return True

    def list_parameters(
        self,
        prefixes: Iterable[str] | None = None,
        depth: int | None = None,
        callback: Done | None = None,
    ) -> Future[Any]:
        """Ask for names: of groups alone, and at most so deep below them; 0 is any depth."""
        return self._ask("list_parameters", callback, prefixes=prefixes or (), depth=depth or 0)

    def get_parameters(self, names: Iterable[str], callback: Done | None = None) -> Future[Any]:
        """Ask for values."""
        return self._ask("get_parameters", callback, names=names)

    def get_parameter_types(
        self, names: Iterable[str], callback: Done | None = None
    ) -> Future[Any]:
        """Ask for types."""
        return self._ask("get_parameter_types", callback, names=names)

    def describe_parameters(
        self, names: Iterable[str], callback: Done | None = None
    ) -> Future[Any]:
        """Ask for descriptors."""
        return self._ask("describe_parameters", callback, names=names)

    def set_parameters(
        self, parameters: Iterable[Parameter | MessageValue], callback: Done | None = None
    ) -> Future[Any]:
        """Set parameters one after another."""
        return self._ask("set_parameters", callback, parameters=self._written(parameters))

    def set_parameters_atomically(
        self, parameters: Iterable[Parameter | MessageValue], callback: Done | None = None
    ) -> Future[Any]:
        """Set all parameters or none."""
        return self._ask(
            "set_parameters_atomically", callback, parameters=self._written(parameters)
        )

    def delete_parameters(self, names: Iterable[str], callback: Done | None = None) -> Future[Any]:
        """Take parameters away, where the node lets that be."""
        return self.set_parameters([Parameter(name) for name in names], callback)

    def load_parameter_file(
        self,
        parameter_file: str,
        use_wildcard: bool = True,  # noqa: FBT001, FBT002  # as in rclpy
        callback: Done | None = None,
    ) -> Future[Any]:
        """Set what a parameter file has for the node; without wildcards, only under its full name.

        Raises:
            ParameterFileError: The file is not valid.
            OSError: It cannot be read.
        """
        text = Path(parameter_file).read_text(encoding="utf-8")
        found = read_parameters(text, self.remote, parameter_file, wildcards=use_wildcard)
        return self.set_parameters(found, callback)

    def destroy(self) -> None:
        """Take its clients back."""
        for client in self.clients.values():
            self._node.destroy_client(client)

    def _ask(self, service: str, callback: Done | None, **fields: Any) -> Future[Any]:  # noqa: ANN401
        client = self.clients[service]
        future = client.call_async(client.srv_type.Request(**fields))
        if callback is not None:
            future.add_done_callback(callback)
        return future

    def _written(self, parameters: Iterable[Parameter | MessageValue]) -> list[MessageValue]:
        return [
            one.to_parameter_msg(self._messages) if isinstance(one, Parameter) else one
            for one in parameters
        ]


class ParameterClient:
    """Every question waits at most `timeout_s`; `with` takes the clients back at the end.

    Questions raise NotServedError when the node does not serve its parameters in time, and
    NoAnswerError when it does not answer.
    """

    def __init__(self, node: Node, remote: str, timeout_s: float = ANSWER_TIMEOUT_S) -> None:
        self._node = node
        self._timeout_s = timeout_s
        self._client = AsyncParameterClient(node, remote)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Take the clients back."""
        self._client.destroy()

    @property
    def remote(self) -> str:
        """The full name of the other node."""
        return self._client.remote

    def names(self, prefixes: Iterable[str] = (), depth: int = 0) -> list[str]:
        """Name the parameters, in the order of the alphabet."""
        asked = self._ask("list_parameters", lambda: self._client.list_parameters(prefixes, depth))
        return sorted(asked.result.names)

    def get(self, names: Sequence[str]) -> list[Parameter]:
        """Return parameters in the order asked; one that is not declared is not set.

        Raises:
            InvalidParameterTypeError: The node sent a type that there is not.
        """
        values = self._ask("get_parameters", lambda: self._client.get_parameters(names)).values
        # Some nodes leave out all values when one name is unknown to them.
        given = dict(zip(names, values, strict=False)) if len(values) == len(names) else {}
        return [
            Parameter(name, *value_of(name, given[name])) if name in given else Parameter(name)
            for name in names
        ]

    def types(self, names: Sequence[str]) -> list[ParameterType]:
        """Return the types of parameters in the order asked."""
        asked = self._ask("get_parameter_types", lambda: self._client.get_parameter_types(names))
        types = list(asked.types)
        known = types if len(types) == len(names) else [0] * len(names)
        return [
            ParameterType(kind) if kind in set(ParameterType) else ParameterType.NOT_SET
            for kind in map(int, known)
        ]

    def describe(self, names: Sequence[str]) -> list[MessageValue]:
        """Return the ParameterDescriptors that the node has of these names."""
        asked = self._ask("describe_parameters", lambda: self._client.describe_parameters(names))
        return list(asked.descriptors)

    def set(self, parameters: Sequence[Parameter]) -> list[MessageValue]:
        """Set parameters one after another, and return a SetParametersResult of each."""
        asked = self._ask("set_parameters", lambda: self._client.set_parameters(parameters))
        return list(asked.results)

    def set_atomically(self, parameters: Sequence[Parameter]) -> MessageValue:
        """Set all parameters or none, and return one SetParametersResult."""
        asked = self._ask(
            "set_parameters_atomically",
            lambda: self._client.set_parameters_atomically(parameters),
        )
        return asked.result

    def dump(self) -> str:
        """Write all parameters as `ros2 param dump` does."""
        found = self.get(self.names())
        return write_parameters(self.remote, {one.name: one for one in found})

    def load(
        self, text: str, where: str = "The file of parameters", *, wildcards: bool = True
    ) -> list[tuple[Parameter, MessageValue]]:
        """Set what a parameter file has for the node; return a SetParametersResult of each.

        Raises:
            ParameterFileError: The file is not valid.
        """
        parameters = read_parameters(text, self.remote, where, wildcards=wildcards)
        return list(zip(parameters, self.set(parameters), strict=True)) if parameters else []

    def _ask(self, service: str, ask: Callable[[], Future[Any]]) -> Any:  # noqa: ANN401
        """Wait until the node is there, then call it; return the response."""
        client = self._client.clients[service]
        if not client.wait_for_service(timeout_sec=self._timeout_s):
            raise NotServedError("service", client.srv_name)
        return wait_for_answer(self._node, ask(), client.srv_name, self._timeout_s)

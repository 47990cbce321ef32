"""AsyncParameterClient: asks and sets the parameters of another node, by rclpy's names."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from studio.ros.parameters.files import read_parameters
from studio.ros.parameters.messages import ParameterMessages
from studio.ros.parameters.parameter import Parameter
from studio.ros.qos import QoSProfile, qos_profile_services_default

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from studio.ros.node.future import Future
    from studio.ros.node.node import Node
    from studio.ros.node.service_client import Client
    from studio.ros.node.work import CallbackGroup
    from studio.ros.types.classes import MessageValue

    Done = Callable[[Future[Any]], object]

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
        self._messages = ParameterMessages.of(node.wire.types)
        self.clients: dict[str, Client] = {
            name: node.create_client(
                node.wire.types.service(f"rcl_interfaces/srv/{kind}"),
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
        """Set what a file says of the node; without wildcards only what names it whole counts.

        Raises:
            ParameterFileError: It is no such file.
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

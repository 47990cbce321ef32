"""ParameterClient: the parameters of another node, asked, set, dumped and loaded, each awaited."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from studio.errors import NotServedError
from studio.ros.parameters.files import read_parameters, write_parameters
from studio.ros.parameters.messages import value_of
from studio.ros.parameters.parameter import Parameter
from studio.ros.parameters.values import ParameterType
from studio.ros.remote.async_parameters import AsyncParameterClient
from studio.ros.remote.waiting import TIMEOUT_S, answer

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence
    from typing import Self

    from studio.ros.node.future import Future
    from studio.ros.node.node import Node
    from studio.ros.types.classes import MessageValue


class ParameterClient:
    """Every question waits at most `timeout_s`; `with` takes the clients back at the end.

    Questions raise NotServedError when the node does not serve its parameters in time, and
    NoAnswerError when it gives no answer.
    """

    def __init__(self, node: Node, remote: str, timeout_s: float = TIMEOUT_S) -> None:
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
        """Give parameters in the order asked; one that is not declared is not set.

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
        """Give the types of parameters in the order asked."""
        asked = self._ask("get_parameter_types", lambda: self._client.get_parameter_types(names))
        types = list(asked.types)
        known = types if len(types) == len(names) else [0] * len(names)
        return [
            ParameterType(kind) if kind in set(ParameterType) else ParameterType.NOT_SET
            for kind in map(int, known)
        ]

    def describe(self, names: Sequence[str]) -> list[MessageValue]:
        """Give the ParameterDescriptors that the node has of these names."""
        asked = self._ask("describe_parameters", lambda: self._client.describe_parameters(names))
        return list(asked.descriptors)

    def set(self, parameters: Sequence[Parameter]) -> list[MessageValue]:
        """Set parameters one after another, and give a SetParametersResult of each."""
        asked = self._ask("set_parameters", lambda: self._client.set_parameters(parameters))
        return list(asked.results)

    def set_atomically(self, parameters: Sequence[Parameter]) -> MessageValue:
        """Set all parameters or none, and give one SetParametersResult."""
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
        """Set what a file says of the node, and give a SetParametersResult of each.

        Raises:
            ParameterFileError: It is no such file.
        """
        parameters = read_parameters(text, self.remote, where, wildcards=wildcards)
        return list(zip(parameters, self.set(parameters), strict=True)) if parameters else []

    def _ask(self, service: str, ask: Callable[[], Future[Any]]) -> Any:  # noqa: ANN401
        """Wait until the node is there, then ask; give the response."""
        client = self._client.clients[service]
        if not client.wait_for_service(timeout_sec=self._timeout_s):
            raise NotServedError("service", client.srv_name)
        return answer(self._node, ask(), client.srv_name, self._timeout_s)

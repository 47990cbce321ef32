"""RemoteParameters: gets and sets the parameters of another node, without a thread that waits.

It imports Zenoh (through `ros`), so it is imported when it is first used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, cast

from studio.errors import CommandError, InvalidParameterTypeError, NoAnswerError, NotServedError
from studio.live.panels.requests import SERVER_PATIENCE_S, came_true, known_in_time, wire_name
from studio.protocol.parameters import ParameterRefusal, ParameterView
from studio.ros.parameter_client import AsyncParameterClient
from studio.ros.parameters.files import read_parameters, write_parameters
from studio.ros.parameters.parameter import Parameter, ParameterType, read_value, value_of
from studio.ros.types.convert import plain_json
from studio.ros.types.yaml_texts import read_yaml

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from studio.live.connection.link import WireLink
    from studio.ros.node.task import Future
    from studio.ros.types.classes import MessageValue

_ANSWER_S: Final = 5.0
_LISTED_MAX: Final = 2_000
_BY_LABEL: Final = {kind.label: kind for kind in ParameterType}


class RemoteParameters:
    """The parameters of one node; made and closed in a thread.

    Requests raise NotServedError when the node does not serve its parameters, and NoAnswerError
    when it does not answer.
    """

    def __init__(self, link: WireLink, node: str) -> None:
        self.node = wire_name(node)
        self._client = AsyncParameterClient(link.node, self.node)

    def close(self) -> None:
        """Take its clients back."""
        self._client.destroy()

    async def views(self) -> tuple[ParameterView, ...]:
        """Return all, with their descriptors."""
        names = await self._names()
        values = await self._values(names)
        described = await self._ask(
            "describe_parameters", lambda: self._client.describe_parameters(names)
        )
        descriptors = {str(one.name): one for one in described.descriptors}
        return tuple(_view(one, descriptors.get(one.name)) for one in values)

    async def set(self, name: str, text: str, value_type: str) -> None:
        """Set one.

        Raises:
            CommandError: The node refuses it; the sentence has its reason.
            InvalidParameterTypeError: The text is no value of that type.
        """
        wanted = parameter_of(name, text, value_type)
        refused = await self._set([wanted])
        for one in refused:
            raise CommandError(f"{self.node} did not set {name}: {one.reason}")

    async def dump(self) -> str:
        """Write all as a file of them."""
        found = await self._values(await self._names())
        return write_parameters(self.node, {one.name: one for one in found})

    async def load(self, text: str) -> tuple[int, tuple[ParameterRefusal, ...]]:
        """Set what a parameter file has for the node; return how many were set, and the refusals.

        Raises:
            ParameterFileError: The file is not valid.
            CommandError: It has nothing for this node.
        """
        wanted = read_parameters(text, self.node, "The text")
        if not wanted:
            raise CommandError(
                f"The text says nothing of {self.node}: that name stands in its first line."
            )
        refused = await self._set(wanted)
        return len(wanted) - len(refused), refused

    async def _names(self) -> list[str]:
        asked = await self._ask("list_parameters", self._client.list_parameters)
        return sorted(map(str, asked.result.names))[:_LISTED_MAX]

    async def _values(self, names: Sequence[str]) -> list[Parameter]:
        asked = await self._ask("get_parameters", lambda: self._client.get_parameters(names))
        # Some nodes leave out all values when one name is unknown to them.
        values = list(asked.values) if len(asked.values) == len(names) else []
        return [_known(name, value) for name, value in zip(names, values, strict=False)]

    async def _set(self, wanted: Sequence[Parameter]) -> tuple[ParameterRefusal, ...]:
        asked = await self._ask("set_parameters", lambda: self._client.set_parameters(wanted))
        results: Iterable[Any] = asked.results
        return tuple(
            ParameterRefusal(name=one.name, reason=str(result.reason) or "it gives no reason")
            for one, result in zip(wanted, results, strict=False)
            if not result.successful
        )

    async def _ask(self, service: str, ask: Callable[[], Future[Any]]) -> Any:  # noqa: ANN401
        client = self._client.clients[service]
        if not await came_true(client.service_is_ready, SERVER_PATIENCE_S):
            raise NotServedError("service", client.srv_name)
        try:
            return await known_in_time(ask(), _ANSWER_S)
        except TimeoutError:
            raise NoAnswerError("service", client.srv_name, _ANSWER_S) from None


def parameter_of(name: str, text: str, value_type: str) -> Parameter:
    """Make a parameter of a text; if its type is known, a number or bare text becomes that.

    Raises:
        InvalidParameterTypeError: It is no value of that type.
    """
    kind = _BY_LABEL.get(value_type, ParameterType.NOT_SET)
    match kind:
        case ParameterType.NOT_SET:
            return Parameter(name, value=read_value(text.strip()))
        case ParameterType.STRING:
            return Parameter(name, kind, text)
        case ParameterType.DOUBLE | ParameterType.DOUBLE_ARRAY:
            return Parameter(name, kind, _as_doubles(_read(name, text)))
        case ParameterType.BYTE_ARRAY:
            return Parameter(name, kind, _as_bytes(_read(name, text)))
        case _:
            return Parameter(name, kind, _read(name, text))


def changed_view(message: MessageValue) -> ParameterView:
    """Return the view of a `rcl_interfaces/msg/Parameter`."""
    return _view(_known(str(message.name), message.value), None)


def _known(name: str, value: MessageValue) -> Parameter:
    try:
        return Parameter(name, *value_of(name, value))
    except InvalidParameterTypeError:
        return Parameter(name)


def _view(parameter: Parameter, descriptor: Any | None) -> ParameterView:  # noqa: ANN401 - a descriptor
    value = parameter.value
    if parameter.type_ is ParameterType.BYTE_ARRAY:
        value = [one[0] for one in value]
    if descriptor is None:
        return ParameterView(
            name=parameter.name, value_type=parameter.type_.label, value=plain_json(value)
        )
    span = next(iter((*descriptor.floating_point_range, *descriptor.integer_range)), None)
    return ParameterView(
        name=parameter.name,
        value_type=parameter.type_.label,
        value=plain_json(value),
        description=descriptor.description,
        read_only=descriptor.read_only,
        constraints=descriptor.additional_constraints,
        low=None if span is None else float(span.from_value),
        high=None if span is None else float(span.to_value),
        step=0.0 if span is None else float(span.step),
    )


def _read(name: str, text: str) -> object:
    try:
        return read_yaml(text)
    except ValueError as error:
        raise InvalidParameterTypeError(name, str(error)) from None


def _as_doubles(value: object) -> object:
    if isinstance(value, list):
        return [_as_doubles(one) for one in cast("list[object]", value)]
    if isinstance(value, str):
        return _float_of(value)
    return float(value) if isinstance(value, int) and not isinstance(value, bool) else value


def _float_of(text: str) -> object:
    """Read `1e-3` and `inf`, which YAML takes for texts."""
    try:
        return float(text)
    except ValueError:
        return text


def _as_bytes(value: object) -> object:
    if not isinstance(value, list):
        return value
    return [_as_byte(one) for one in cast("list[object]", value)]


def _as_byte(value: object) -> object:
    return bytes([value]) if isinstance(value, int) and 0 <= value <= 255 else value

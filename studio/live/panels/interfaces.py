"""Message, service and action types: looked up, listed, added, and learned from other nodes."""

from __future__ import annotations

import asyncio
import time
from itertools import islice
from typing import TYPE_CHECKING, Final, Literal, cast

from studio.errors import UnknownTypeError
from studio.protocol.commands import Commands, Scope
from studio.protocol.interfaces import (
    AddedInterface,
    AddInterfaces,
    ConstantView,
    FieldView,
    GetInterface,
    InterfaceAnswer,
    InterfaceFaultView,
    InterfacesAdded,
    InterfacesAnswer,
    ListInterfaces,
    MessageView,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.errors import InterfaceTextError
    from studio.live.connection.link import WireLink
    from studio.live.connection.ros_connection import RosConnection
    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.types.definitions import Constant, Field, Message
    from studio.ros.types.library import TypeLibrary


_NODES_MAX: Final = 8
"""So many nodes are asked for one type: each may make one wait."""
_REASONS_SHOWN: Final = 2
_PAUSE_S: Final = 5.0
"""Before a node is asked again for a type that it did not describe."""
_UNDESCRIBED_MAX: Final = 500
_NOBODY: Final = "no known package defines it, and no running node describes it"
_ADVICE: Final = "drop its .{kind} file, or its package's folder, on the page"


class TypeLearner:
    """Learns types from other nodes, one at a time, once for all pages; used on the event loop."""

    def __init__(self, wire: RosConnection) -> None:
        self._wire = wire
        self._turn = asyncio.Lock()
        self._undescribed: dict[str, tuple[float, str]] = {}
        """Names of types that no node described: when, and why."""

    async def learn(self, name: str) -> None:
        """Learn a type from other nodes, unless it is known by now.

        Raises:
            UnknownTypeError: No node describes it; the sentence says why and what to do.
        """
        async with self._turn:
            asked_s, why = self._undescribed.get(name, (float("-inf"), ""))
            if time.monotonic() - asked_s >= _PAUSE_S:
                why = await asyncio.to_thread(_ask, self._wire.current, name)
                self._keep(name, why)
        if why:
            raise UnknownTypeError(name, f"{why}; {_ADVICE.format(kind=_kind_of(name))}")

    async def texts(self, name: str) -> dict[str, str]:
        """Return the definitions of a known type and of those it uses; empty: no node has them."""
        async with self._turn:
            asked_s, _ = self._undescribed.get(name, (float("-inf"), ""))
            if time.monotonic() - asked_s < _PAUSE_S:
                return {}
            texts = await asyncio.to_thread(_texts, self._wire.current, name)
            self._keep(name, "" if texts else "no node has its definition")
            return texts

    def _keep(self, name: str, why: str) -> None:
        self._undescribed.pop(name, None)
        if why:
            self._undescribed[name] = (time.monotonic(), why)
        if len(self._undescribed) > _UNDESCRIBED_MAX:
            self._undescribed.pop(next(iter(self._undescribed)))


def _ask(link: WireLink | None, name: str) -> str:
    """Ask the nodes that use it; why it is not known then, empty: it is. In a thread."""
    if link is None:
        return _NOBODY
    from studio.ros.type_lookup import learn_from_any  # noqa: PLC0415

    failures: list[str] = []
    learn_from_any(link.node, _others(link, name), failures.append)
    try:
        link.types.hash_of(name)
    except UnknownTypeError as error:
        reasons = [one.rstrip(".") for one in failures[:_REASONS_SHOWN]]
        return "; ".join(reasons) or error.reason or _NOBODY
    return ""


def _texts(link: WireLink | None, name: str) -> dict[str, str]:
    if link is None:
        return {}
    from studio.ros.type_lookup import texts_of_any  # noqa: PLC0415

    return texts_of_any(link.node, _others(link, name))


def _others(link: WireLink, name: str) -> list[GraphEndpoint]:
    """Return one endpoint of each of a few nodes that use a type; not the studio's own."""
    from studio.ros.type_lookup import users_of  # noqa: PLC0415

    others = {one.node: one for one in users_of(link.graph, name) if one.node.zid != link.zid}
    return list(others.values())[:_NODES_MAX]


def _kind_of(name: str) -> str:
    """Return the extension of the file that defines it."""
    return next((kind for kind in ("srv", "action") if f"/{kind}/" in name), "msg")


_FAULTS_MAX: Final = 200


class InterfaceTypes:
    """The types that the connection knows; without one, those of the process."""

    def __init__(self, wire: RosConnection) -> None:
        self._wire = wire
        self._learner = TypeLearner(wire)
        self.recorded_for: Callable[[str], TypeLibrary | None] = lambda _: None
        """Gives the types of the recording that a document shows; None: it shows none."""
        self._texts: dict[str, str] = {}
        """Definitions, with comments, from nodes: of types that only a distribution has."""

    async def interface(self, command: GetInterface) -> InterfaceAnswer:
        """Return the definition of a type; one not known here is learned from nodes that use it.

        Raises:
            RosNameError: It is not a valid name of a type.
            UnknownTypeError: It, or a type it uses, is neither known nor described by a node.
        """
        if (recorded := self.recorded_for(command.document)) is not None:
            return await asyncio.to_thread(self._answer, command, recorded)
        try:
            answer = await asyncio.to_thread(self._answer, command)
        except UnknownTypeError:
            await self._learner.learn(command.name)
        else:
            if answer.text or not command.with_text:
                return answer
            self._texts |= await self._learner.texts(command.name)
        return await asyncio.to_thread(self._answer, command)

    async def names(self, command: ListInterfaces) -> InterfacesAnswer:
        """Return the known types."""
        return await asyncio.to_thread(self._names, command.request)

    async def add(self, command: AddInterfaces) -> InterfacesAdded:
        """Add definitions, for this studio and as long as it runs; files stay where they are.

        Of several, the valid ones are added, and the answer reports the faults of the others.

        Raises:
            InterfaceTextError: A single definition breaks a rule, or makes a type too large or
                a part of itself.
            RosNameError: Its name is not valid.
        """
        return await asyncio.to_thread(self._add, command)

    def library(self) -> TypeLibrary:
        """Return the known types; the first time in a thread, for it takes its time."""
        from studio.ros.messages import shared_types  # noqa: PLC0415 - takes its time

        link = self._wire.current
        return shared_types() if link is None else link.types

    def _names(self, request: int) -> InterfacesAnswer:
        library = self.library()
        return InterfacesAnswer(
            request=request,
            distro=library.distro,
            names=tuple(library.names()),
            own=tuple(library.own_names()),
            faults=tuple(map(_fault_view, islice(library.faults().values(), _FAULTS_MAX))),
        )

    def _add(self, command: AddInterfaces) -> InterfacesAdded:
        from studio.ros.types.files import InterfaceTexts  # noqa: PLC0415

        library = self.library()
        faults: dict[str, InterfaceTextError] = {}
        # Only what is new: a class kept elsewhere goes stale when its type is added again.
        if len(command.texts) > 1:
            faults = library.add_sound_texts(InterfaceTexts(dict(command.texts)))
        elif any(library.text_of(name) != text for name, text in command.texts.items()):
            library.add_texts(command.texts)
        return InterfacesAdded(
            request=command.request,
            types=tuple(_added(library, name) for name in command.texts if name not in faults),
            faults=tuple(map(_fault_view, islice(faults.values(), _FAULTS_MAX))),
        )

    def _answer(
        self, command: GetInterface, recorded: TypeLibrary | None = None
    ) -> InterfaceAnswer:
        from studio.ros.names import split_type_name  # noqa: PLC0415
        from studio.ros.types.definitions import messages_of  # noqa: PLC0415

        library = self.library() if recorded is None else recorded
        kind = split_type_name(command.name)[1]
        parts = messages_of(library.interface(command.name))
        return InterfaceAnswer(
            request=command.request,
            name=command.name,
            kind=cast("Literal['msg', 'srv', 'action']", kind),
            parts=tuple(one.name for one in parts),
            messages=tuple(
                _message_view(self._commented(one, library)) for one in _all_of(parts, library)
            ),
            hash=library.hash_of(command.name),
            text=library.text_of(command.name) or self._texts.get(command.name, ""),
        )

    def _commented(self, message: Message, library: TypeLibrary) -> Message:
        """Return the same message with the comments of a node's definition."""
        from studio.ros.types.definitions import messages_of  # noqa: PLC0415
        from studio.ros.types.interface_text import parse_interface  # noqa: PLC0415
        from studio.ros.types.type_descriptions import owner_of  # noqa: PLC0415

        owner = owner_of(message.name)
        text = self._texts.get(owner)
        if text is None or library.text_of(owner) is not None:
            return message
        parts = messages_of(parse_interface(owner, text))
        return next((one for one in parts if one.name == message.name), message)


def _added(library: TypeLibrary, name: str) -> AddedInterface:
    try:
        return AddedInterface(name=name, hash=library.hash_of(name), trouble="")
    except UnknownTypeError as error:
        return AddedInterface(name=name, hash="", trouble=str(error))


def _fault_view(fault: InterfaceTextError) -> InterfaceFaultView:
    return InterfaceFaultView(place=fault.name, line=fault.line or 0, reason=fault.reason)


def _all_of(parts: tuple[Message, ...], library: TypeLibrary) -> list[Message]:
    """Return the parts and what they are made of, each once, whatever needs others before these."""
    found: dict[str, Message] = {}
    waiting = list(parts)
    while waiting:
        message = waiting.pop(0)
        if message.name not in found:
            found[message.name] = message
            waiting.extend(library.find(name) for name in sorted(message.needs()))
    return list(found.values())


def _message_view(message: Message) -> MessageView:
    return MessageView(
        name=message.name,
        fields=tuple(_field_view(one) for one in message.fields),
        constants=tuple(_constant_view(one) for one in message.constants),
        comment=message.comment,
    )


def _field_view(field: Field) -> FieldView:
    kind = field.type
    return FieldView(
        name=field.name,
        base=kind.base,
        shape=kind.shape.value,
        count=kind.count,
        string_bound=kind.string_bound,
        default=field.default,
        comment=field.comment,
    )


def _constant_view(constant: Constant) -> ConstantView:
    return ConstantView(
        name=constant.name, base=constant.base, value=constant.value, comment=constant.comment
    )


COMMANDS: Final = Commands[InterfaceTypes](Scope.ROS)
COMMANDS.viewer(GetInterface, lambda one, c, _: one.interface(c), same_for_all=True)
COMMANDS.viewer(ListInterfaces, lambda one, c, _: one.names(c), same_for_all=True)
COMMANDS.presenter(AddInterfaces, lambda one, c, _: one.add(c))

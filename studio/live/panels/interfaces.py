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
    from studio.errors import InterfaceTextError
    from studio.live.connection.link import WireLink
    from studio.live.connection.ros_connection import RosConnection
    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.types.definitions import Constant, Field, Message
    from studio.ros.types.library import TypeLibrary


_NODES_MAX: Final = 8
"""So many nodes are asked for one type: each may be silent for as long as one waits."""
_REASONS_SHOWN: Final = 2
_PAUSE_S: Final = 5.0
"""Whoever did not tell a type is not asked for it again at once, however often pages ask."""
_UNTOLD_MAX: Final = 500
_NOBODY: Final = "no known package defines it, and no node that is there tells it"
_ADVICE: Final = "drop its .{kind} file, or its package's folder, on the page"


class TypeLearner:
    """Learns types from other nodes, one at a time, once for all pages; used on the event loop."""

    def __init__(self, wire: RosConnection) -> None:
        self._wire = wire
        self._turn = asyncio.Lock()
        self._untold: dict[str, tuple[float, str]] = {}
        """Names that nobody told: when, and why."""

    async def learn(self, name: str) -> None:
        """Have a type be known; it may be known already when its turn comes.

        Raises:
            UnknownTypeError: Nobody tells it; why, and what to do, is said.
        """
        async with self._turn:
            asked_s, why = self._untold.get(name, (float("-inf"), ""))
            if time.monotonic() - asked_s >= _PAUSE_S:
                why = await asyncio.to_thread(_ask, self._wire.current, name)
                self._keep(name, why)
        if why:
            raise UnknownTypeError(name, f"{why}; {_ADVICE.format(kind=_kind_of(name))}")

    async def texts(self, name: str) -> dict[str, str]:
        """Have how a known type, and what it is made of, are written; empty: nobody tells it."""
        async with self._turn:
            asked_s, _ = self._untold.get(name, (float("-inf"), ""))
            if time.monotonic() - asked_s < _PAUSE_S:
                return {}
            told = await asyncio.to_thread(_texts, self._wire.current, name)
            self._keep(name, "" if told else "nobody tells its text")
            return told

    def _keep(self, name: str, why: str) -> None:
        self._untold.pop(name, None)
        if why:
            self._untold[name] = (time.monotonic(), why)
        if len(self._untold) > _UNTOLD_MAX:
            self._untold.pop(next(iter(self._untold)))


def _ask(link: WireLink | None, name: str) -> str:
    """Ask the nodes that use it; why it is not known then, empty: it is. In a thread."""
    if link is None:
        return _NOBODY
    from studio.ros.type_lookup import learn_from_any  # noqa: PLC0415

    said: list[str] = []
    learn_from_any(link.node, _others(link, name), said.append)
    try:
        link.types.hash_of(name)
    except UnknownTypeError as error:
        reasons = [one.rstrip(".") for one in said[:_REASONS_SHOWN]]
        return "; ".join(reasons) or error.reason or _NOBODY
    return ""


def _texts(link: WireLink | None, name: str) -> dict[str, str]:
    if link is None:
        return {}
    from studio.ros.type_lookup import texts_of_any  # noqa: PLC0415

    return texts_of_any(link.node, _others(link, name))


def _others(link: WireLink, name: str) -> list[GraphEndpoint]:
    """One endpoint of each node that uses a type, of a few nodes; not the studio's own."""
    from studio.ros.type_lookup import users_of  # noqa: PLC0415

    others = {one.node: one for one in users_of(link.graph, name) if one.node.zid != link.zid}
    return list(others.values())[:_NODES_MAX]


def _kind_of(name: str) -> str:
    """Which file defines it."""
    return next((kind for kind in ("srv", "action") if f"/{kind}/" in name), "msg")


_FAULTS_MAX: Final = 200


class InterfaceTypes:
    """The types that the connection knows; without one, those of the process."""

    def __init__(self, wire: RosConnection) -> None:
        self._wire = wire
        self._learner = TypeLearner(wire)
        self._texts: dict[str, str] = {}
        """Of types that only a distribution has, as nodes told them: with comments."""

    async def interface(self, command: GetInterface) -> InterfaceAnswer:
        """Tell what a type is made of; what is not known here, nodes that use it are asked for.

        Raises:
            RosNameError: No type is named so.
            UnknownTypeError: It, or what it is made of, is not known, nor told by a node.
        """
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
        """Tell which types are known."""
        return await asyncio.to_thread(self._names, command.request)

    async def add(self, command: AddInterfaces) -> InterfacesAdded:
        """Take up texts, for this studio and as long as it runs; files stay where they are.

        Of several texts the sound ones are taken, and the answer says what is wrong with others.

        Raises:
            InterfaceTextError: A text that came alone breaks a rule, or makes a type too large or
                part of itself.
            RosNameError: Its name does.
        """
        return await asyncio.to_thread(self._add, command)

    def library(self) -> TypeLibrary:
        """Give the types that are known; the first time in a thread, for it takes its time."""
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
        # Only what is new: whoever holds a class of a type that is taken again loses it.
        if len(command.texts) > 1:
            faults = library.add_sound_texts(InterfaceTexts(dict(command.texts)))
        elif any(library.text_of(name) != text for name, text in command.texts.items()):
            library.add_texts(command.texts)
        return InterfacesAdded(
            request=command.request,
            types=tuple(_added(library, name) for name in command.texts if name not in faults),
            faults=tuple(map(_fault_view, islice(faults.values(), _FAULTS_MAX))),
        )

    def _answer(self, command: GetInterface) -> InterfaceAnswer:
        from studio.ros.names import split_type_name  # noqa: PLC0415
        from studio.ros.types.definitions import messages_of  # noqa: PLC0415

        library = self.library()
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
        """Give the same message with the comments that a node told."""
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
    """The parts and what they are made of, each once, whatever needs others before these."""
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
COMMANDS.viewer(GetInterface, lambda one, c, _: one.interface(c))
COMMANDS.viewer(ListInterfaces, lambda one, c, _: one.names(c))
COMMANDS.presenter(AddInterfaces, lambda one, c, _: one.add(c))

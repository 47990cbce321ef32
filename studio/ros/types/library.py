"""The type library: all known types of a distribution, of the studio and of the user."""

from __future__ import annotations

import re
import threading
from dataclasses import dataclass, field
from functools import cache
from typing import TYPE_CHECKING, Protocol

from studio.errors import (
    InterfaceClassError,
    InterfaceTextError,
    OtherTypeError,
    RosNameError,
    UnknownTypeError,
)
from studio.interfaces import carried_texts
from studio.ros import strictness
from studio.ros.names import split_type_name
from studio.ros.types.classes import MessageValue, definition_of, make_class, parts_of, shown
from studio.ros.types.definitions import (
    Action,
    Interface,
    Message,
    Service,
    action_as_message,
    check_sizes,
    feedback_message,
    get_result_service,
    messages_of,
    send_goal_service,
    service_as_message,
    service_event,
)
from studio.ros.types.interface_text import parse_interface
from studio.ros.types.rosbags import MessageStore
from studio.ros.types.rosidl_classes import make_rosidl_class
from studio.ros.types.type_hash import type_hash

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from studio.ros.types.files import InterfaceTexts

# What nodes themselves use: another definition would cut them off from all others.
_SETTLED = {
    "action_msgs",
    "builtin_interfaces",
    "lifecycle_msgs",
    "rcl_interfaces",
    "rosgraph_msgs",
    "service_msgs",
    "type_description_interfaces",
    "unique_identifier_msgs",
}
TEXTS_MAX = 20_000


class ServiceKind(Protocol):
    """What nodes take as the type of a service: a `ServiceType`, or a class like it."""

    @property
    def name(self) -> str:
        """The full name, `std_srvs/srv/Trigger`."""
        ...

    @property
    def Request(self) -> type[MessageValue]:  # noqa: N802  # rclpy's name
        """The class of requests."""
        ...

    @property
    def Response(self) -> type[MessageValue]:  # noqa: N802  # rclpy's name
        """The class of responses."""
        ...


@dataclass(frozen=True, slots=True)
class ServiceType:
    """A service as nodes use it; the names are rclpy's."""

    name: str
    type_hash: str
    Request: type[MessageValue]
    Response: type[MessageValue]
    Event: type[MessageValue]


@dataclass(frozen=True, slots=True)
class ActionType:
    """An action as nodes use it; the names are rclpy's."""

    name: str
    type_hash: str
    Goal: type[MessageValue]
    Result: type[MessageValue]
    Feedback: type[MessageValue]
    SendGoal: ServiceType
    GetResult: ServiceType
    FeedbackMessage: type[MessageValue]


@dataclass
class _Known:
    """The texts of a source, read: what each defines, and the messages therein by name."""

    interfaces: dict[str, Interface] = field(default_factory=dict[str, Interface])
    messages: dict[str, Message] = field(default_factory=dict[str, Message])
    texts: dict[str, str] = field(default_factory=dict[str, str])

    def take(self, interface: Interface, text: str) -> None:
        self.interfaces[interface.name] = interface
        self.texts[interface.name] = text
        self.messages |= {message.name: message for message in _all_messages(interface)}

    def with_more(self, read: Iterable[tuple[Interface, str]]) -> _Known:
        """Return a copy with more texts."""
        made = _Known({**self.interfaces}, {**self.messages}, {**self.texts})
        for interface, text in read:
            made.take(interface, text)
        return made


class TypeLibrary:
    """The types of one distribution; a user's own come before those it has, as in an overlay.

    Thread-safe; classes are made once, until `add_texts` changes what they are made of.
    """

    def __init__(self, distro: str) -> None:
        self.distro = distro
        self.generation = 0
        self._store = MessageStore(distro)
        self._carried = _carried()
        self._own = _Known()
        self._faults: dict[str, InterfaceTextError] = {}
        """By the name that the type of each text would have."""
        self._lock = threading.RLock()
        self._classes: dict[str, type[MessageValue]] = {}
        self._hashes: dict[str, str] = {}

    def add_texts(self, texts: Mapping[str, str]) -> list[str]:
        """Add texts by the full names of their types, all or none; return the names.

        What a type is made of may come later: until then it is unknown, with the reason.

        Raises:
            InterfaceTextError: A text breaks a rule, or makes a type too large or part of itself.
            RosNameError: A name does.
        """
        read = [(parse_interface(name, text), text) for name, text in texts.items()]
        with self._lock:
            self._check_count(texts)
            for interface, _ in read:
                self._refuse_settled(interface)
            before = self._own
            unsound = self._take(read)
            if unsound:
                self._own = before
                raise next(iter(unsound.values()))
            self._changed()
            self._faults = {one: it for one, it in self._faults.items() if one not in texts}
        return list(texts)

    def add_sound_texts(self, found: InterfaceTexts) -> dict[str, InterfaceTextError]:
        """Add the texts that are valid, and remember why the others are not.

        What is known already stays as it is.

        Returns:
            What is wrong with the others, by the name of the type; each error names the file.

        Raises:
            InterfaceTextError: There are too many.
        """
        new = {one: text for one, text in found.texts.items() if self.text_of(one) != text}
        with self._lock:
            self._check_count(new)
            read, faults = self._parsed(new)
            before = self._own
            unsound = self._take(read)
            if unsound:
                self._own = before.with_more(one for one in read if one[0].name not in unsound)
            faults |= unsound
            if len(faults) < len(new):
                self._changed()
            found_faults = {**found.placed(faults), **found.faults}
            kept = {name: one for name, one in self._faults.items() if name not in found.texts}
            self._faults = {**kept, **found_faults}
        return found_faults

    def faults(self) -> dict[str, InterfaceTextError]:
        """Return what is wrong with texts that were not added, by the name of each type."""
        with self._lock:
            return dict(sorted(self._faults.items()))

    def _check_count(self, texts: Mapping[str, str]) -> None:
        if len(self._own.texts.keys() | texts.keys()) > TEXTS_MAX:
            raise InterfaceTextError("types", None, f"more than {TEXTS_MAX} were given")

    def _parsed(
        self, texts: Mapping[str, str]
    ) -> tuple[list[tuple[Interface, str]], dict[str, InterfaceTextError]]:
        """Read each text by itself; return those that can be read, and why the others cannot."""
        read: list[tuple[Interface, str]] = []
        faults: dict[str, InterfaceTextError] = {}
        for name, text in texts.items():
            try:
                interface = parse_interface(name, text)
                self._refuse_settled(interface)
            except InterfaceTextError as error:
                faults[name] = error
            except RosNameError as error:
                faults[name] = InterfaceTextError(name, None, error.reason)
            else:
                read.append((interface, text))
        return read, faults

    def _take(self, read: list[tuple[Interface, str]]) -> dict[str, InterfaceTextError]:
        """Add all, then return those that are not valid together; the lock is held."""
        self._own = self._own.with_more(read)
        unsound: dict[str, InterfaceTextError] = {}
        for interface, _ in read:
            try:
                self._check(interface)
            except InterfaceTextError as error:
                unsound[interface.name] = error
        return unsound

    def _changed(self) -> None:
        """Forget what was made of other texts; the lock is held."""
        self.generation += 1
        self._classes.clear()
        self._hashes.clear()

    def copy(self) -> TypeLibrary:
        """Return a library of the same types, in which texts can be tried."""
        made = TypeLibrary(self.distro)
        with self._lock:
            own = self._own
        made._own = _Known({**own.interfaces}, {**own.messages}, {**own.texts})
        return made

    def names(self) -> list[str]:
        """Name every type, those of calls whole, in the order of the alphabet."""
        names = {*self._carried.interfaces, *self._own.interfaces, *self._store.names()}
        return sorted(names)

    def own_names(self) -> list[str]:
        """Name the types that a user gave, in the order of the alphabet."""
        return sorted(self._own.interfaces)

    def text_of(self, name: str) -> str | None:
        """Return the text of a type as it was written; None for those of the distribution."""
        return self._own.texts.get(name) or self._carried.texts.get(name)

    def interface(self, name: str) -> Interface:
        """Return what a text defines: a message, service or action.

        Raises:
            UnknownTypeError: No such type is known.
        """
        known = self._own.interfaces.get(name)
        if known is None and split_type_name(name)[1] != "msg":
            known = self._carried.interfaces.get(name)
        return known or self.find(name)

    def find(self, name: str) -> Message:
        """Return a message by its full name, parts of calls such as `T_Request` too.

        Raises:
            UnknownTypeError: No such message is known.
        """
        own = self._own.messages.get(name)
        found = own or _richer(self._store.find(name), self._carried.messages.get(name))
        if found is None:
            raise self._unknown(name)
        return found

    def _unknown(self, name: str) -> UnknownTypeError:
        """Return why a type is not known: its text breaks a rule, or there is none."""
        folder, _, base = name.rpartition("/")
        owner = f"{folder}/{base.partition('_')[0]}"
        alike = (fault for one, fault in self._faults.items() if _plain(one) == _plain(owner))
        fault = self._faults.get(owner) or next(alike, None)
        return UnknownTypeError(name, None if fault is None else str(fault).rstrip("."))

    def message(self, name: str) -> type[MessageValue]:
        """Return the class of a message's values; the same class each time.

        Raises:
            UnknownTypeError: It, or what it is made of, is not known.
        """
        with self._lock:
            made = self._classes.get(name)
            if made is None:
                definition = self.find(name)
                check_sizes(definition, self.find)
                make = make_rosidl_class if strictness.is_begun() else make_class
                made = self._classes[name] = make(definition, self.message)
            return made

    def service(self, name: str) -> ServiceType:
        """Return the classes and the hash of a service; parts of actions are services too.

        Raises:
            UnknownTypeError: It, or what it is made of, is not known.
        """
        self.find(name)
        request, response, event = (
            self.message(f"{name}_{part}") for part in ("Request", "Response", "Event")
        )
        return ServiceType(name, self.hash_of(name), request, response, event)

    def action(self, name: str) -> ActionType:
        """Return the classes and the hash of an action.

        Raises:
            UnknownTypeError: It, or what it is made of, is not known.
        """
        self.find(name)
        parts = ("Goal", "Result", "Feedback", "FeedbackMessage")
        goal, result, feedback, message = (self.message(f"{name}_{part}") for part in parts)
        return ActionType(
            name,
            self.hash_of(name),
            goal,
            result,
            feedback,
            self.service(f"{name}_SendGoal"),
            self.service(f"{name}_GetResult"),
            message,
        )

    def hash_of(self, name: str) -> str:
        """Return the RIHS01 hash of a message, service or action, also where keys carry none.

        Raises:
            UnknownTypeError: It, or what it is made of, is not known.
        """
        with self._lock:
            found = self._hashes.get(name)
            if found is None:
                found = self._hashes[name] = type_hash(self.find(name), self.find)
            return found

    def _refuse_settled(self, interface: Interface) -> None:
        if interface.name.partition("/")[0] not in _SETTLED:
            return
        for message in messages_of(interface):
            try:
                known = self.find(message.name)
            except UnknownTypeError:
                continue
            if not _alike(known, message):
                raise InterfaceTextError(
                    interface.name,
                    None,
                    f"nodes of {self.distro} speak another form of it: leave it out",
                )

    def _check(self, interface: Interface) -> None:
        for message in messages_of(interface):
            try:
                check_sizes(message, self.find)
            except UnknownTypeError:
                continue


def check_is_type(kind: object, wanted: type, word: str) -> None:
    """Refuse what is no type of ROS: a module, a value, a class of something else.

    Raises:
        InterfaceClassError: It is none.
    """
    if isinstance(kind, wanted) or (isinstance(kind, type) and issubclass(kind, wanted)):
        return
    raise InterfaceClassError(shown(kind), word)


def check_same_type(types: TypeLibrary, kind: type[MessageValue]) -> str:
    """Return the full name of a class's type.

    Raises:
        OtherTypeError: The library means something else by the name: the class is another
            distribution's, or was made before its text changed.
        UnknownTypeError: The library knows no such type.
    """
    name = definition_of(kind).name
    if types.hash_of(name) != _hash_of_class(kind):
        raise OtherTypeError(name, types.distro)
    return name


@cache
def _hash_of_class(kind: type[MessageValue]) -> str:
    parts = parts_of(kind)
    return type_hash(definition_of(kind), lambda name: definition_of(parts[name]))


def _all_messages(interface: Interface) -> list[Message]:
    match interface:
        case Message():
            return [interface]
        case Service():
            return [
                *messages_of(interface),
                service_event(interface),
                service_as_message(interface),
            ]
        case Action():
            calls = (send_goal_service(interface), get_result_service(interface))
            return [
                *messages_of(interface),
                *(message for call in calls for message in _all_messages(call)),
                feedback_message(interface),
                action_as_message(interface),
            ]


@cache
def _carried() -> _Known:
    known = _Known()
    for name, text in carried_texts().items():
        known.take(parse_interface(name, text), text)
    return known


def _richer(stored: Message | None, carried: Message | None) -> Message | None:
    """Choose the carried one, with its defaults and comments, where both have the same fields."""
    if stored is None or carried is None:
        return stored or carried
    return carried if _alike(stored, carried) else stored


def _alike(one: Message, other: Message) -> bool:
    return [(field.name, field.type) for field in one.fields] == [
        (field.name, field.type) for field in other.fields
    ]


def _plain(name: str) -> str:
    """Return a name as it is compared with those that break the rules of names."""
    return re.sub(r"[^a-z0-9/]", "", name.lower())

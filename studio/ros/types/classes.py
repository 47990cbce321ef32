"""Classes of message values: one per type, with defaults, constants and keyword constructors."""

from __future__ import annotations

import keyword
from operator import attrgetter
from typing import TYPE_CHECKING, Any, ClassVar, cast

import numpy as np

from studio.ros.types.arrays import dtype_of, keeper
from studio.ros.types.definitions import DUMMY_FIELD, Field, Message, Shape

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.types.arrays import Keep

_SCALARS: dict[str, object] = {"bool": False, "string": "", "wstring": ""}


class MessageKind(type):
    """The class of the classes of messages: constants are made at run time, as fields are."""

    if TYPE_CHECKING:

        def __getattr__(cls, name: str) -> Any: ...  # noqa: ANN401


class MessageValue(metaclass=MessageKind):
    """A value of a message type; the class of each type derives from this one.

    Fields are attributes, constants are those of the class. Arrays of numbers are numpy arrays
    (those that were decoded are read-only views of the bytes), other arrays are lists.
    """

    __slots__ = ()
    __hash__ = None  # pyright: ignore[reportAssignmentType]  # values change
    _definition: ClassVar[Message]
    _attributes: ClassVar[tuple[str, ...]]
    _parts: ClassVar[dict[str, type[MessageValue]]]

    def __init__(self, *args: Any, **fields: Any) -> None:  # noqa: ANN401
        raise TypeError("a message is made by the class of its type")

    if TYPE_CHECKING:
        # Fields are made at run time: without these, checkers of types know no attribute. A real
        # `__getattr__` would make every field that is read take three times as long.
        def __setattr__(self, name: str, value: Any) -> None: ...  # noqa: ANN401
        def __getattr__(self, name: str) -> Any: ...  # noqa: ANN401

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, MessageValue) or other._definition != self._definition:
            return NotImplemented
        return all(_same(getattr(self, name), getattr(other, name)) for name in self._attributes)

    def __repr__(self) -> str:
        fields = ", ".join(f"{name}={_said(getattr(self, name))}" for name in self._attributes)
        return f"{self._definition.name.replace('/', '.')}({fields})"


def definition_of(value: MessageValue | type[MessageValue]) -> Message:
    """Give what the type of a value is made of."""
    return value._definition  # pyright: ignore[reportPrivateUsage]


def attributes_of(value: MessageValue | type[MessageValue]) -> tuple[str, ...]:
    """Name the attributes of a value in the order of its fields; keywords end in `_`."""
    return value._attributes  # pyright: ignore[reportPrivateUsage]


def class_of_field(value: MessageValue | type[MessageValue], field: Field) -> type[MessageValue]:
    """Give the class of the messages that a field holds."""
    return value._parts[field.type.base]  # pyright: ignore[reportPrivateUsage]


def attribute_name(field: str) -> str:
    """Name the attribute of a field: Python's own words end in an underscore."""
    return f"{field}_" if keyword.iskeyword(field) else field


def slot_name(attribute: str) -> str:
    """Name where the value of an array field lies, behind its attribute; no field is so named."""
    return f"_{attribute}_"


def maker_of(kind: type[MessageValue]) -> Callable[..., MessageValue]:
    """Write what makes a value of what was decoded, whose fields are of their types already.

    Only how many there are in a bounded sequence is looked at again.
    """
    message = definition_of(kind)
    known: dict[str, object] = {"_kind": kind, "_new": object.__new__}
    lines = [" _self = _new(_kind)"]
    names = attributes_of(kind)
    for number, (name, field) in enumerate(zip(names, message.fields, strict=True)):
        slot = name if field.type.shape is Shape.SINGLE else slot_name(name)
        if field.type.shape is Shape.BOUNDED:
            known[f"_keep_{number}"] = keeper(f"{message.name} {field.name}", field.type)
            lines.append(f" _self.{slot} = _keep_{number}({name})")
        else:
            lines.append(f" _self.{slot} = {name}")
    # A message without fields carries one byte.
    arguments = ", ".join(names) or DUMMY_FIELD
    code = "\n".join([f"def make({arguments}):", *lines, " return _self"])
    return _defined(code, known)["make"]


def make_class(
    message: Message, find_class: Callable[[str], type[MessageValue]]
) -> type[MessageValue]:
    """Make the class of a message; `find_class` gives those of the messages it is made of."""
    parts = {name: find_class(name) for name in message.needs()}
    attributes = tuple(attribute_name(field.name) for field in message.fields)
    namespace: dict[str, object] = {constant.name: constant.value for constant in message.constants}
    namespace |= {
        "__doc__": message.comment or f"A value of {message.name}.",
        "__module__": message.name.rpartition("/")[0].replace("/", "."),
        "_definition": message,
        "_attributes": attributes,
        "_parts": parts,
    }
    slots: list[str] = []
    keeps: dict[str, Keep] = {}
    for attribute, field in zip(attributes, message.fields, strict=True):
        if field.type.shape is Shape.SINGLE:
            slots.append(attribute)
            continue
        slots.append(slot_name(attribute))
        keeps[attribute] = keeper(f"{message.name} {field.name}", field.type)
        namespace[attribute] = _kept(slot_name(attribute), keeps[attribute])
    namespace["__slots__"] = tuple(slots)
    if not attributes:
        namespace[DUMMY_FIELD] = 0
    namespace["__init__"] = _make_init(message, keeps, parts)
    base_name = message.name.rpartition("/")[2]
    return cast("type[MessageValue]", MessageKind(base_name, (MessageValue,), namespace))


def _kept(slot: str, keep: Keep) -> property:
    def set_kept(value: object, given: object) -> None:
        setattr(value, slot, keep(given))

    return property(attrgetter(slot), set_kept)


def _make_init(
    message: Message, keeps: dict[str, Keep], parts: dict[str, type[MessageValue]]
) -> Callable[..., None]:
    """Write a constructor as dataclasses do: decoding calls it for every message there is.

    Only names that the parser let through stand in the code, and none of them begins with an
    underscore; values are handed in.
    """
    known: dict[str, object] = {}
    arguments: list[str] = []
    lines: list[str] = []
    for number, field in enumerate(message.fields):
        name = attribute_name(field.name)
        known[f"_make_{number}"] = _default_maker(field, parts)
        if field.type.shape is not Shape.SINGLE:
            known[f"_keep_{number}"] = keeps[name]
            arguments.append(f"{name}=None")
            given = f"_make_{number}() if {name} is None else _keep_{number}({name})"
            lines.append(f" _self.{slot_name(name)} = {given}")
        elif field.type.nested:
            arguments.append(f"{name}=None")
            lines.append(f" _self.{name} = _make_{number}() if {name} is None else {name}")
        else:
            known[f"_make_{number}"] = _scalar_default(field)
            arguments.append(f"{name}=_make_{number}")
            lines.append(f" _self.{name} = {name}")
    # A message without fields carries one byte, which decoding hands over.
    arguments = arguments or [f"{DUMMY_FIELD}=0"]
    code = f"def __init__(_self, {', '.join(arguments)}):\n" + ("\n".join(lines) or " pass")
    return _defined(code, known)["__init__"]


def _defined(code: str, known: dict[str, object]) -> dict[str, Any]:
    """Run generated code, and give what it defines.

    It is compiled before: an interrupt that leaves an `exec` of text ends the process at its exit,
    even where it was caught.
    """
    made: dict[str, Any] = {}
    exec(compile(code, "<generated>", "exec"), known, made)
    return made


def _scalar_default(field: Field) -> object:
    if field.default is not None:
        return field.default
    return _SCALARS.get(field.type.base, 0.0 if field.type.base.startswith("float") else 0)


def _default_maker(field: Field, parts: dict[str, type[MessageValue]]) -> Callable[[], object]:
    kind = field.type
    places = kind.count if kind.shape is Shape.ARRAY else 0
    if kind.nested:
        part = parts[kind.base]
        return part if kind.shape is Shape.SINGLE else lambda: [part() for _ in range(places)]
    values = field.default if isinstance(field.default, tuple) else None
    if kind.numeric:
        dtype = dtype_of(kind.base)
        if values is not None:
            return lambda: np.array(values, dtype=dtype)
        return lambda: np.zeros(places, dtype=dtype)
    return lambda: list(values if values is not None else [""] * places)


def _same(one: object, other: object) -> bool:
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return np.array_equal(cast("Any", one), cast("Any", other))
    return one == other


def _said(value: object) -> str:
    if isinstance(value, np.ndarray):
        return repr(value.tolist())
    return repr(cast("Any", value).item() if isinstance(value, np.generic) else value)

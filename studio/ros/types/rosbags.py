"""The door to rosbags: the message definitions of each distribution, and generated CDR code."""

from __future__ import annotations

import builtins
import importlib
import importlib.util
from contextlib import contextmanager
from functools import cached_property
from importlib.machinery import SourceFileLoader
from types import ModuleType, SimpleNamespace
from typing import TYPE_CHECKING, Any, cast

from rosbags.interfaces import Nodetype
from rosbags.serde import SerdeError
from rosbags.serde.cdr import (
    generate_deserialize_cdr,
    generate_getsize_cdr,
    generate_serialize_cdr,
)

from studio.errors import UnknownTypeError
from studio.ros.types.classes import definition_of, maker_of, parts_of, stores_of
from studio.ros.types.definitions import (
    DUMMY_FIELD,
    PRIMITIVES,
    Constant,
    Field,
    FieldType,
    Message,
    Scalar,
    Shape,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Mapping

    from studio.ros.types.classes import MessageValue

__all__ = ["CdrCode", "MessageStore", "SerdeError", "cdr_code"]

SEQUENCE_PLACES_MAX = 2**32 - 1
# Constants and fields as rosbags writes them: plain tuples, made to be read by its own code.
_Described = tuple[list[tuple[str, str, Scalar]], list[tuple[str, Any]]]
# On the wire both are an unsigned byte; rosbags would take the first for a signed one.
_AS_BYTES = {"byte": "uint8", "char": "uint8"}
_STORES = "rosbags.typesys.stores"
_DUMMY = (DUMMY_FIELD, (Nodetype.BASE, ("uint8", 0)))


class _Stores:
    """Loads stores for the sake of their tables alone.

    Each has a dataclass beside each row, which nobody here uses, and whose making takes four
    fifths of the time of an import: a fifth of what a node takes to start.
    """

    def __init__(self) -> None:
        self._loaded: dict[str, ModuleType] = {}
        self._builtins = {**vars(builtins), "__import__": self._import}

    def load(self, name: str) -> ModuleType:
        """Execute the code of a store, which Python keeps compiled, in a module of its own."""
        if name not in self._loaded:
            spec = importlib.util.find_spec(name)
            if spec is None or not isinstance(spec.loader, SourceFileLoader):
                return importlib.import_module(name)
            module = self._loaded[name] = ModuleType(name)
            module.__package__ = _STORES
            vars(module)["__builtins__"] = self._builtins
            code = spec.loader.get_code(name)
            assert code is not None
            exec(code, vars(module))
        return self._loaded[name]

    def _import(self, name: str, *where: Any, **named: Any) -> Any:  # noqa: ANN401
        """Import for a store: other stores in the same way, and a dataclass that is none."""
        if name == "dataclasses":
            return SimpleNamespace(dataclass=_as_it_is, field=_as_it_is)
        _, _, names, level = (*where, None, None, (), 0)[:4]
        if level == 1 and not name:
            return SimpleNamespace(**{one: self.load(f"{_STORES}.{one}") for one in names or ()})
        return __import__(name, *where, **named)


def _as_it_is(kind: object = None, **_: object) -> object:
    return kind


class MessageStore:
    """The messages of one distribution, each made when it is first asked for."""

    def __init__(self, distro: str) -> None:
        module = _Stores().load(f"{_STORES}.ros2_{distro}")
        self._described = cast("Mapping[str, _Described]", module.FIELDDEFS)

    def names(self) -> list[str]:
        """Name every message of the store."""
        return list(self._described)

    def find(self, name: str) -> Message | None:
        """Return a message by its full name, None if the store has none."""
        described = self._described.get(name)
        if described is None:
            return None
        constants, fields = described
        return Message(
            name,
            tuple(_field(*field) for field in fields if field[0] != DUMMY_FIELD),
            tuple(_constant(*constant) for constant in constants),
        )


class CdrCode:
    """The generated code of one type, under the names that rosbags' generated code uses.

    The functions write and read bodies without the header of four bytes. Each is generated when it
    is first used.
    """

    def __init__(self, kind: type[MessageValue], parts: _Parts) -> None:
        self.cls = maker_of(kind)
        self.fields = _described_fields(definition_of(kind), stores_of(kind))
        self.parts = cast("Any", parts)
        with _interruptible():
            self.getsize_cdr, self.size_cdr = generate_getsize_cdr(self.fields, self.parts)

    @cached_property
    def serialize_cdr_le(self) -> Callable[..., int]:
        """Write a message, little endian."""
        with _interruptible():
            return generate_serialize_cdr(self.fields, self.parts, "le")

    @cached_property
    def serialize_cdr_be(self) -> Callable[..., int]:
        """Write a message, big endian."""
        with _interruptible():
            return generate_serialize_cdr(self.fields, self.parts, "be")

    @cached_property
    def deserialize_cdr_le(self) -> Callable[..., Any]:
        """Read a message, little endian."""
        with _interruptible():
            return generate_deserialize_cdr(self.fields, self.parts, "le")

    @cached_property
    def deserialize_cdr_be(self) -> Callable[..., Any]:
        """Read a message, big endian."""
        with _interruptible():
            return generate_deserialize_cdr(self.fields, self.parts, "be")


class _Parts:
    """The types that one is made of, by name, for generated code."""

    max_sequence_length = SEQUENCE_PLACES_MAX

    def __init__(self, kind: type[MessageValue]) -> None:
        self._kinds = parts_of(kind)
        self._made: dict[str, CdrCode] = {}

    def get_msgdef(self, typename: str) -> CdrCode:
        """Return the code of a type."""
        made = self._made.get(typename)
        if made is None:
            made = self._made[typename] = CdrCode(self._kinds[typename], self)
        return made


def cdr_code(kind: type[MessageValue]) -> CdrCode:
    """Generate the code of a message class and of the classes that it is made of.

    Raises:
        UnknownTypeError: A field is a wstring.
    """
    return _Parts(kind).get_msgdef(definition_of(kind).name)


@contextmanager
def _interruptible() -> Generator[None]:
    """Let Ctrl-C be caught where code is generated.

    CPython notes an interrupt that leaves an `exec` of text as unhandled, and ends the process by
    the signal even where it was caught; executing a text again takes the note back.
    """
    try:
        yield
    except KeyboardInterrupt:
        exec("")
        raise


def _constant(name: str, base: str, value: Scalar) -> Constant:
    return Constant(name, base, bool(value) if base == "bool" else value)


def _field(name: str, described: tuple[Nodetype, Any]) -> Field:
    node, inner = described
    if node is Nodetype.ARRAY:
        base, bound = _base(inner[0])
        return Field(name, FieldType(base, Shape.ARRAY, inner[1], bound))
    if node is Nodetype.SEQUENCE:
        base, bound = _base(inner[0])
        shape = Shape.BOUNDED if inner[1] else Shape.SEQUENCE
        return Field(name, FieldType(base, shape, inner[1], bound))
    base, bound = _base(described)
    return Field(name, FieldType(base, string_bound=bound))


def _base(described: tuple[Nodetype, Any]) -> tuple[str, int]:
    """Return the name and the bound of a string, 0 without."""
    node, inner = described
    if node is Nodetype.NAME:
        return inner, 0
    base, bound = inner
    if base not in PRIMITIVES:
        raise NotImplementedError(base)
    return base, bound


def _described_fields(message: Message, stores: tuple[str, ...]) -> Any:  # noqa: ANN401
    pairs = zip(stores, message.fields, strict=True)
    return [(name, _described(message, field)) for name, field in pairs] or [_DUMMY]


def _described(message: Message, field: Field) -> tuple[Nodetype, object]:
    """Describe a field as rosbags' generators read it.

    Raises:
        UnknownTypeError: It is a text of wide letters.
    """
    kind = field.type
    if kind.base == "wstring":
        raise UnknownTypeError(
            message.name,
            f"its field {field.name} is a wstring, which implementations of ROS 2 write "
            "differently: use string",
        )
    if kind.nested:
        base = (Nodetype.NAME, kind.base)
    else:
        base = (Nodetype.BASE, (_AS_BYTES.get(kind.base, kind.base), 0))
    if kind.shape is Shape.SINGLE:
        return base
    if kind.shape is Shape.ARRAY:
        return (Nodetype.ARRAY, (base, kind.count))
    return (Nodetype.SEQUENCE, (base, 0))

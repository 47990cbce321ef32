"""Message classes as rosidl makes them for Python, for a process that runs a user's program.

Fields are checked when they are set. Sequences of numbers are `array.array`, fixed arrays of
numbers are numpy arrays, truth values are lists, and a byte is `bytes` of length 1.
"""

from __future__ import annotations

import array
from collections.abc import Callable, Iterable
from operator import attrgetter
from typing import TYPE_CHECKING, Any, Final, cast

import numpy as np

from studio.errors import MessageValueError
from studio.ros.types.classes import (
    MessageKind,
    MessageValue,
    attribute_name,
    check_scalar,
    defined,
    dtype_of,
    keeper,
    slot_name,
)
from studio.ros.types.definitions import (
    DUMMY_FIELD,
    FLOATS,
    INTEGERS,
    STRINGS,
    Field,
    FieldType,
    Shape,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.ros.types.definitions import Message

_TYPECODES: Final = {
    "float32": "f", "float64": "d", "int8": "b", "uint8": "B", "char": "B", "int16": "h",
    "uint16": "H", "int32": "i", "uint32": "I", "int64": "q", "uint64": "Q",
}  # fmt: skip
_IDL_NAMES: Final = {"bool": "boolean", "float32": "float", "float64": "double", "byte": "octet",
                     "char": "uint8"}  # fmt: skip
_PYTHON_TYPES: Final[dict[str, type]] = {
    "bool": bool,
    "byte": bytes,
    **dict.fromkeys(STRINGS, str),
    **dict.fromkeys(FLOATS, float),
}
"""All others are whole numbers."""


def make_rosidl_class(
    message: Message, find_class: Callable[[str], type[MessageValue]]
) -> type[MessageValue]:
    """Make the class of a message; `find_class` returns those of its parts."""
    parts = {name: find_class(name) for name in message.needs()}
    attributes = tuple(attribute_name(field.name) for field in message.fields)
    fields = {
        attribute: _Field(message.name, attribute, field, parts.get(field.type.base))
        for attribute, field in zip(attributes, message.fields, strict=True)
    }
    constants: dict[str, object] = {
        one.name: bytes([int(one.value)]) if one.base == "byte" else one.value
        for one in message.constants
    }
    namespace: dict[str, object] = {
        **constants,
        "__doc__": message.comment or f"A value of {message.name}.",
        "__module__": message.name.rpartition("/")[0].replace("/", "."),
        "__slots__": tuple(f"_{name}" for name in attributes),
        "_definition": message,
        "_attributes": attributes,
        "_stores": tuple(one.store for one in fields.values()),
        "_parts": parts,
        "get_fields_and_field_types": classmethod(_idl_types(message)),
    }
    for name, one in fields.items():
        namespace[name] = property(attrgetter(f"_{name}"), one.set)
        if one.store == slot_name(name):
            namespace[one.store] = property(one.get_stored, one.set_stored)
    if not attributes:
        namespace[DUMMY_FIELD] = 0
    namespace["__init__"] = _make_init(fields)
    return cast(
        "type[MessageValue]",
        MessageKind(message.name.rpartition("/")[2], (MessageValue,), namespace),
    )


class _Field:
    """How one field is checked when it is set, and kept for those who read and write messages."""

    def __init__(
        self, owner: str, name: str, field: Field, part: type[MessageValue] | None
    ) -> None:
        self._where, self._name, self._slot = f"{owner} {field.name}", name, f"_{name}"
        self._type, self._default, self._part = field.type, field.default, part
        self._is_single = field.type.shape is Shape.SINGLE
        self._code = _TYPECODES.get(field.type.base, "")
        self._keep = None if self._is_single else keeper(self._where, field.type)
        is_plain = self._is_single and field.type.base != "byte"
        is_listed = not self._is_single and not field.type.numeric
        is_fixed = field.type.shape is Shape.ARRAY and bool(self._code)
        self.store = self._slot if is_plain or is_listed or is_fixed else slot_name(name)
        """The attribute that encoders read, and decoders write."""

    def default(self) -> Any:  # noqa: ANN401
        """Make the value of a new message."""
        kind = self._type
        if kind.nested:
            assert self._part is not None
            part = self._part
            places = kind.count if kind.shape is Shape.ARRAY else 0
            return part() if self._is_single else [part() for _ in range(places)]
        if self._is_single:
            return self._kept(self._default) if self._default is not None else _zero(kind.base)
        if isinstance(self._default, tuple):
            return self._kept(self._default)
        zeros = [_zero(kind.base)] * (kind.count if kind.shape is Shape.ARRAY else 0)
        return self._kept(zeros)

    def set(self, message: MessageValue, value: Any) -> None:  # noqa: ANN401
        """Check a value as rosidl's setters do, and keep it.

        Raises:
            AssertionError: The field does not take it.
        """
        object.__setattr__(message, self._slot, self._kept(value))

    def get_stored(self, message: MessageValue) -> Any:  # noqa: ANN401
        """Return the value as encoders take it: numbers as a numpy array, a byte as a number."""
        value = getattr(message, self._slot)
        if self._is_single:
            return value[0]
        if self._code:
            return np.asarray(value).view(dtype_of(self._type.base))
        if self._type.base == "byte":
            return np.frombuffer(b"".join(value), dtype=np.uint8)
        return np.array(value, dtype=np.bool_)

    def set_stored(self, message: MessageValue, value: Any) -> None:  # noqa: ANN401
        """Keep what a decoder read."""
        object.__setattr__(message, self._slot, self._of_numbers(value))

    def _of_numbers(self, value: Any) -> object:  # noqa: ANN401
        if self._is_single:
            return bytes([value])
        numbers = cast("NDArray[Any]", value)
        if self._code and self._type.shape is Shape.ARRAY:
            return numbers
        if self._code:
            made: Any = cast("Any", array.array)(self._code)
            made.frombytes(numbers.tobytes())
            return made
        if self._type.base == "byte":
            return [bytes([int(one)]) for one in numbers]
        return numbers.tolist()

    def _is_kept_array(self, value: object) -> bool:
        return type(value) is array.array and value.typecode == self._code

    def _kept(self, value: Any) -> Any:  # noqa: ANN401
        if self._is_single:
            return self._single(value)
        if self._is_kept_array(value):
            if self._type.shape is Shape.SEQUENCE:
                return value
            value = np.asarray(value)
        if self._type.base == "byte" and isinstance(value, list | tuple):
            value = b"".join(_one_byte(self._name, one) for one in cast("list[Any]", value))
        assert self._keep is not None
        kept = self._keep(_listed(self._name, self._type, value))
        if self._type.numeric:
            return self._of_numbers(np.array(kept) if self.store == self._slot else kept)
        for number, one in enumerate(kept):
            self._check_item(one, number)
        return kept

    def _single(self, value: Any) -> Any:  # noqa: ANN401
        base = self._type.base
        if self._part is not None:
            self._check_part(value)
        elif base == "byte":
            return _one_byte(self._name, value)
        else:
            wanted = _PYTHON_TYPES.get(base, int)
            # Not kinder than rosidl: no whole number where a float is declared, none of numpy's.
            if not isinstance(value, wanted):
                raise AssertionError(
                    f"The '{self._name}' field must be of type '{wanted.__name__}'"
                )
            self._check_range(value)
        return value

    def _check_range(self, value: Any) -> None:  # noqa: ANN401
        try:
            check_scalar(self._type, value, self._where)
        except MessageValueError as error:
            if self._type.base in INTEGERS:
                low, high = INTEGERS[self._type.base]
                raise AssertionError(
                    f"The '{self._name}' field must be an integer in [{low}, {high}]"
                ) from None
            raise AssertionError(str(error)) from None

    def _check_item(self, value: Any, number: int) -> None:  # noqa: ANN401
        if self._part is not None:
            if not isinstance(value, self._part):
                raise AssertionError(
                    f"The '{self._name}' field must be a set or sequence and each value of type "
                    f"'{self._part.__name__}': [{number}] is {value!r:.60}"
                )
            return
        check_scalar(self._type, value, f"{self._where}[{number}]")

    def _check_part(self, value: object) -> None:
        assert self._part is not None
        if not isinstance(value, self._part):
            raise AssertionError(  # noqa: TRY004 - what rosidl raises
                f"The '{self._name}' field must be a sub message of type '{self._part.__name__}'"
            )


def _listed(name: str, kind: FieldType, value: object) -> object:
    """Refuse what is no list, a text among them."""
    if isinstance(value, str | dict) or not isinstance(value, Iterable):
        base = kind.base.rpartition("/")[2]
        raise AssertionError(  # noqa: TRY004 - what rosidl raises
            f"The '{name}' field must be a set or sequence and each value of type "
            f"'{base if kind.nested else _PYTHON_TYPES.get(base, int).__name__}'"
        )
    return cast("object", value)


def _one_byte(name: str, value: object) -> bytes:
    if isinstance(value, bytes | bytearray) and len(value) == 1:
        return bytes(value)
    if isinstance(value, int) and 0 <= value <= 255:  # of definitions, and of the studio's own code
        return bytes([value])
    raise AssertionError(f"The '{name}' field must be of type 'bytes' or 'ByteString'")


def _zero(base: str) -> object:
    if base in STRINGS:
        return ""
    if base == "byte":
        return b"\x00"
    if base == "bool":
        return False
    return 0.0 if base in FLOATS else 0


def _make_init(fields: dict[str, _Field]) -> Callable[..., None]:
    """Write a constructor that takes names alone; an unknown one is refused as rosidl does."""
    known: dict[str, object] = {"_none": object()}
    names: list[str] = []
    lines = [
        " if _more:",
        "  _more.pop('check_fields', None)",  # Jazzy's: they are always checked here
        " if _more:",
        "  raise AssertionError('Invalid arguments passed to constructor: '"
        " + ', '.join(sorted(_more)))",
    ]
    for number, (name, one) in enumerate(fields.items()):
        known[f"_make_{number}"] = one.default
        names.append(f"{name}=_none, ")
        lines.append(f" if {name} is _none: _self._{name} = _make_{number}()")
        lines.append(f" else: _self.{name} = {name}")
    star = "*, " if names else ""
    code = f"def __init__(_self, {star}{''.join(names)}**_more):\n" + "\n".join(lines)
    return defined(code, known)["__init__"]


def _idl_types(message: Message) -> Callable[[object], dict[str, str]]:
    names = {field.name: _idl_name(field.type) for field in message.fields}

    def get_fields_and_field_types(_cls: object) -> dict[str, str]:
        return dict(names)

    return get_fields_and_field_types


def _idl_name(kind: FieldType) -> str:
    base = _IDL_NAMES.get(kind.base, kind.base.replace("/msg/", "/"))
    if kind.string_bound:
        base = f"{base}<{kind.string_bound}>"
    match kind.shape:
        case Shape.SINGLE:
            return base
        case Shape.ARRAY:
            return f"{base}[{kind.count}]"
        case Shape.BOUNDED:
            return f"sequence<{base}, {kind.count}>"
        case Shape.SEQUENCE:
            return f"sequence<{base}>"

"""Message classes, one for each type: fields, constants, defaults, and checks of what fields hold.

Fields of numbers hold numpy arrays, other array fields hold lists.
"""

from __future__ import annotations

import array
import keyword
import math
from collections.abc import Callable, Iterable
from numbers import Real
from operator import attrgetter, index
from typing import TYPE_CHECKING, Any, ClassVar, cast

import numpy as np

from studio.errors import MessageValueError
from studio.ros.types.definitions import (
    DUMMY_FIELD,
    FLOATS,
    INTEGERS,
    STRINGS,
    Field,
    FieldType,
    Message,
    Shape,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

Keep = Callable[[Any], Any]
_DTYPES = {"bool": np.bool_, "byte": np.uint8, "char": np.uint8}
_KINDS_TAKEN = {"b": "b", "i": "iu", "u": "iu", "f": "fiu"}
_SCALARS: dict[str, object] = {"bool": False, "string": "", "wstring": ""}
_FLOAT32_MAX = 3.4028235677973366e38


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
    _stores: ClassVar[tuple[str, ...]]
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
        fields = ", ".join(f"{name}={_shown(getattr(self, name))}" for name in self._attributes)
        return f"{self._definition.name.replace('/', '.')}({fields})"


def definition_of(value: MessageValue | type[MessageValue]) -> Message:
    """Return what the type of a value is made of."""
    return value._definition  # pyright: ignore[reportPrivateUsage]


def attributes_of(value: MessageValue | type[MessageValue]) -> tuple[str, ...]:
    """Name the attributes of a value in the order of its fields; keywords end in `_`."""
    return value._attributes  # pyright: ignore[reportPrivateUsage]


def stores_of(value: MessageValue | type[MessageValue]) -> tuple[str, ...]:
    """Name where the values of fields lie as codecs take them, in the order of the fields."""
    return value._stores  # pyright: ignore[reportPrivateUsage]


def class_of_field(value: MessageValue | type[MessageValue], field: Field) -> type[MessageValue]:
    """Return the class of the messages that a field holds."""
    return value._parts[field.type.base]  # pyright: ignore[reportPrivateUsage]


def parts_of(kind: type[MessageValue]) -> dict[str, type[MessageValue]]:
    """Collect the classes that one is made of, itself included, by the names of their types."""
    found = {definition_of(kind).name: kind}
    waiting = [kind]
    while waiting:
        one = waiting.pop()
        for field in definition_of(one).fields:
            if field.type.nested and field.type.base not in found:
                part = found[field.type.base] = class_of_field(one, field)
                waiting.append(part)
    return found


def attribute_name(field: str) -> str:
    """Return the attribute of a field: Python's keywords end in an underscore."""
    return f"{field}_" if keyword.iskeyword(field) else field


def slot_name(attribute: str) -> str:
    """Name where the value of an array field lies, behind its attribute; no field is so named."""
    return f"_{attribute}_"


def maker_of(kind: type[MessageValue]) -> Callable[..., MessageValue]:
    """Write a function that makes a value from decoded fields, which have the right types.

    Only the lengths of bounded sequences are checked.
    """
    message = definition_of(kind)
    known: dict[str, object] = {"_kind": kind, "_new": object.__new__}
    lines = [" _self = _new(_kind)"]
    names = attributes_of(kind)
    rows = zip(names, stores_of(kind), message.fields, strict=True)
    for number, (name, slot, field) in enumerate(rows):
        if field.type.shape is Shape.BOUNDED:
            known[f"_keep_{number}"] = keeper(f"{message.name} {field.name}", field.type)
            lines.append(f" _self.{slot} = _keep_{number}({name})")
        else:
            lines.append(f" _self.{slot} = {name}")
    # A message without fields carries one byte.
    arguments = ", ".join(names) or DUMMY_FIELD
    code = "\n".join([f"def make({arguments}):", *lines, " return _self"])
    return defined(code, known)["make"]


def make_class(
    message: Message, find_class: Callable[[str], type[MessageValue]]
) -> type[MessageValue]:
    """Make the class of a message; `find_class` returns those of its parts."""
    parts = {name: find_class(name) for name in message.needs()}
    attributes = tuple(attribute_name(field.name) for field in message.fields)
    namespace: dict[str, object] = {constant.name: constant.value for constant in message.constants}
    namespace |= {
        "__doc__": message.comment or f"A value of {message.name}.",
        "__module__": message.name.rpartition("/")[0].replace("/", "."),
        "_definition": message,
        "_attributes": attributes,
        "_stores": tuple(
            name if field.type.shape is Shape.SINGLE else slot_name(name)
            for name, field in zip(attributes, message.fields, strict=True)
        ),
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
    return defined(code, known)["__init__"]


def defined(code: str, known: dict[str, object]) -> dict[str, Any]:
    """Run generated code, and return what it defines.

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


def _shown(value: object) -> str:
    if isinstance(value, np.ndarray | array.array):
        return repr(cast("Any", value).tolist())
    return repr(cast("Any", value).item() if isinstance(value, np.generic) else value)


def check_message(message: MessageValue, where: str = "") -> None:
    """Walk through a message, however deep.

    Raises:
        MessageValueError: A field holds what its type does not take; its path is named.
    """
    definition = definition_of(message)
    for field, store in zip(definition.fields, stores_of(message), strict=True):
        path = f"{where}.{field.name}" if where else f"{definition.name} {field.name}"
        value = getattr(message, store)
        if field.type.shape is Shape.SINGLE:
            _check_value(message, field, value, path)
            continue
        check_count(path, field.type, len(value))
        if not field.type.numeric:
            for number, item in enumerate(value):
                _check_value(message, field, item, f"{path}[{number}]")


def check_scalar(kind: FieldType, value: object, where: str) -> None:
    """Check one number, truth value or text.

    Raises:
        MessageValueError: The type does not take it.
    """
    if kind.base in STRINGS:
        _check_string(kind, value, where)
    elif kind.base in FLOATS:
        _check_float(kind, value, where)
    elif kind.base in INTEGERS:
        _check_integer(kind, value, where)
    elif not isinstance(value, bool) and type(value).__name__ not in {"bool", "bool_"}:
        raise MessageValueError(where, f"{shown(value)} is neither true nor false")


def _check_value(message: MessageValue, field: Field, value: object, where: str) -> None:
    if not field.type.nested:
        check_scalar(field.type, value, where)
        return
    wanted = class_of_field(message, field)
    if not isinstance(value, MessageValue) or definition_of(value) != definition_of(wanted):
        raise MessageValueError(where, f"{shown(value)} is no {field.type.base}")
    check_message(value, where)


def _check_string(kind: FieldType, value: object, where: str) -> None:
    if not isinstance(value, str):
        raise MessageValueError(where, f"{shown(value)} is no text")
    if kind.string_bound and len(value) > kind.string_bound:
        raise MessageValueError(where, f"the text is longer than {kind.string_bound} characters")
    try:
        value.encode()
    except UnicodeEncodeError:
        raise MessageValueError(where, "the text holds half a letter, no UTF-8") from None


def _check_float(kind: FieldType, value: object, where: str) -> None:
    if not isinstance(value, Real):
        raise MessageValueError(where, f"{shown(value)} is no number")
    try:
        number = float(value)
    except OverflowError:
        raise MessageValueError(where, f"{shown(value)} is too large for {kind.base}") from None
    if kind.base == "float32" and math.isfinite(number) and abs(number) > _FLOAT32_MAX:
        raise MessageValueError(where, f"{shown(value)} is too large for float32")


def _check_integer(kind: FieldType, value: object, where: str) -> None:
    try:
        number = index(value)  # pyright: ignore[reportArgumentType]
    except TypeError:
        raise MessageValueError(where, f"{shown(value)} is no whole number") from None
    low, high = INTEGERS[kind.base]
    if not low <= number <= high:
        raise MessageValueError(
            where, f"{shown(value)} does not fit {kind.base}, which goes from {low} to {high}"
        )


def dtype_of(base: str) -> np.dtype[Any]:
    """Return the numpy type of a numeric base type."""
    return np.dtype(_DTYPES.get(base, base))


def keeper(where: str, kind: FieldType) -> Keep:
    """Make what turns a given value into the one that an array field keeps.

    It raises MessageValueError, which names `where`, for what does not fit.
    """
    return _number_keeper(where, kind) if kind.numeric else _list_keeper(where, kind)


def check_count(where: str, kind: FieldType, count: int) -> None:
    """Refuse a wrong number of values.

    Raises:
        MessageValueError: An array has another length, or a bounded sequence too many.
    """
    if kind.shape is Shape.ARRAY and count != kind.count:
        raise MessageValueError(where, f"{kind.count} values are needed, {count} were given")
    if kind.shape is Shape.BOUNDED and count > kind.count:
        raise MessageValueError(where, f"at most {kind.count} values fit, {count} were given")


def _number_keeper(where: str, kind: FieldType) -> Keep:
    dtype = dtype_of(kind.base)
    counted = kind.shape is not Shape.SEQUENCE
    array_type = np.ndarray

    def keep(value: Any) -> NDArray[Any]:  # noqa: ANN401
        if not (
            type(value) is array_type
            and value.dtype == dtype
            and value.ndim == 1
            and value.flags.c_contiguous
        ):
            value = _as_array(where, kind, value, dtype)
        if counted:
            check_count(where, kind, len(value))
        return value

    return keep


def _as_array(where: str, kind: FieldType, value: object, dtype: np.dtype[Any]) -> NDArray[Any]:
    if isinstance(value, (bytes, bytearray, memoryview)) and dtype.itemsize == 1:
        return np.frombuffer(cast("bytes", value), dtype=dtype)
    if isinstance(value, (str, dict, bytes)) or not isinstance(value, Iterable):
        raise MessageValueError(where, f"{shown(value)} is no list of {kind.base}")
    found = _given_array(where, kind, cast("Iterable[object]", value))
    if found.size and (found.ndim != 1 or found.dtype.kind not in _KINDS_TAKEN[dtype.kind]):
        raise MessageValueError(where, f"{shown(value)} is no list of {kind.base}")
    if found.ndim != 1:
        found = found.reshape(-1)
    _check_range(where, kind, found, dtype)
    with np.errstate(over="ignore"):
        return np.ascontiguousarray(found.astype(dtype))


def _given_array(where: str, kind: FieldType, value: Iterable[object]) -> NDArray[Any]:
    try:
        return np.asarray(cast("Any", value) if isinstance(value, np.ndarray) else list(value))
    except (ValueError, TypeError, OverflowError):
        raise MessageValueError(where, f"{shown(value)} is no list of {kind.base}") from None


def _check_range(where: str, kind: FieldType, found: NDArray[Any], dtype: np.dtype[Any]) -> None:
    if not found.size or dtype.kind not in "iu":
        return
    limits = np.iinfo(dtype)
    if int(found.min()) < limits.min or int(found.max()) > limits.max:
        raise MessageValueError(
            where, f"{kind.base} goes from {limits.min} to {limits.max}, a value does not fit"
        )


def _list_keeper(where: str, kind: FieldType) -> Keep:
    counted = kind.shape is not Shape.SEQUENCE

    def keep(value: Any) -> list[object]:  # noqa: ANN401
        if type(value) is not list:
            if isinstance(value, (str, bytes, dict)) or not isinstance(value, Iterable):
                raise MessageValueError(where, f"{shown(value)} is no list of {kind.base}")
            value = list(cast("Iterable[object]", value))
        kept = cast("list[object]", value)
        if counted:
            check_count(where, kind, len(kept))
        return kept

    return keep


def shown(value: Any) -> str:  # noqa: ANN401  # of any type, known in part or not
    """Show a value within a sentence, cut where it is long."""
    try:
        shown = repr(value)
    except ValueError:
        # Python writes no number of more than 4300 digits.
        return "a number too long to show"
    return shown if len(shown) <= 60 else f"{shown[:57]}..."

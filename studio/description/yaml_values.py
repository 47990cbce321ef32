# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false
"""Values of YAML files inside expressions: dotted access as xacro has it, and every read noted."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Any, Final, SupportsIndex, cast

import yaml

from studio.description.faults import Fault, Refusal
from studio.description.guarded_operations import METHODS
from studio.description.run_record import KeyPath, YamlReads, YamlScalar
from studio.problems import Place

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from studio.description.run_record import Input

EXPANDED_LIMIT: Final = 100_000
"""Values of a document with every alias counted where it stands."""
DEPTH_LIMIT: Final = 64
"""Values inside values; the deepest file of the corpus has 9."""
_SEPARATORS_LIMIT: Final = 250_000
_BRACKETS: Final = re.compile(rb"[\[\]{}]")
_COMPACT: Final = re.compile(rb"(?:[-?:][ \t]+){65}")
_DIGITS_LIMIT: Final = 24
"""Of a whole number, its sign and separators too; more than 64 bits have."""
UNITS: Final = {
    "!radians": 1.0,
    "!degrees": math.pi / 180.0,
    "!meters": 1.0,
    "!millimeters": 0.001,
    "!foot": 0.3048,
    "!inches": 0.0254,
}
"""xacro's tags and what one of each is in rad or m."""


class Reader:
    """Notes what is read of one document in one run; `note` gets every value read."""

    __slots__ = ("_note", "reads")

    def __init__(self, reads: YamlReads, note: Callable[[Input], None]) -> None:
        self.reads, self._note = reads, note

    def touch(self, path: KeyPath) -> None:
        """The value at a path was read."""
        value = self.reads.values.get(path)
        if value is None:
            value = self.reads.values[path] = YamlScalar(self.reads.path, path)
        self._note(value)

    def touch_all(self, path: KeyPath) -> None:
        """Everything below a path was read at once."""
        self.reads.whole.add(path)


class YamlMapping(dict[Any, Any]):
    """A mapping of a YAML file: `m.key` and `m['key']` give a copy of what is below.

    A plain one, and all below it, has no dots: what xacro's wrappers hand out by dict's own ways.
    """

    __slots__ = ("_is_plain", "path", "reader")

    def __init__(
        self, items: dict[Any, Any], reader: Reader | None, path: KeyPath, *, plain: bool = False
    ) -> None:
        super().__init__(items)
        self.reader, self.path, self._is_plain = reader, path, plain

    def __getattr__(self, key: Any) -> Any:  # noqa: ANN401
        if self._is_plain:
            sentence = (
                f"has no \".{key}\" behind items(), values(), get() or pop(): write ['{key}']"
            )
            raise AttributeError(f"a YAML mapping {sentence}")
        try:
            return self[key]
        except KeyError:
            raise AttributeError(f'the YAML mapping has no key "{key}"') from None

    def __getitem__(self, key: Any) -> Any:  # noqa: ANN401
        if self._is_plain:
            return self._wrapped(key, super().__getitem__(key))
        try:
            value = super().__getitem__(key)
        except KeyError:
            raise AttributeError(f'the YAML mapping has no key "{key}"') from None
        return self._wrapped(key, value)

    def _wrapped(self, key: Any, value: Any, *, plain: bool = False) -> Any:  # noqa: ANN401
        path = (*self.path, key)
        if self.reader is not None:
            self.reader.touch(path)
        return wrap(value, self.reader, path, plain=plain or self._is_plain)

    def _plain(self) -> dict[Any, Any]:
        """As an ordinary dict, every value read."""
        return {key: self._wrapped(key, value, plain=True) for key, value in super().items()}

    def get(self, key: Any, default: Any = None) -> Any:  # noqa: ANN401
        """The value of a key, or a default."""
        return self._wrapped(key, super().__getitem__(key), plain=True) if key in self else default

    def __iter__(self) -> Iterator[Any]:  # so that `dict(m)` asks for each item
        return super().__iter__()

    def items(self) -> Any:  # noqa: ANN401
        """All (key, value) pairs."""
        return self._plain().items()

    def values(self) -> Any:  # noqa: ANN401
        """All values."""
        return self._plain().values()

    def copy(self) -> Any:  # noqa: ANN401
        """An ordinary dict of it."""
        return self._plain()

    def pop(self, key: Any, *default: Any) -> Any:  # noqa: ANN401
        """Take a key out of this copy."""
        if key not in self and default:
            return default[0]
        return self._wrapped(key, super().pop(key), plain=True)

    def __repr__(self) -> str:
        self._read_whole()
        return dict.__repr__(self)

    def __eq__(self, other: object) -> bool:
        self._read_whole()
        return dict.__eq__(self, other)

    def __ne__(self, other: object) -> bool:
        return not self == other

    __hash__ = None  # pyright: ignore[reportAssignmentType] - as that of a dict

    def __or__(self, other: dict[Any, Any]) -> Any:  # noqa: ANN401
        return self._plain() | other

    def __ror__(self, other: dict[Any, Any]) -> Any:  # noqa: ANN401
        return other | self._plain()

    def _read_whole(self) -> None:
        """Note that everything below is read at once."""
        if self.reader is not None:
            self.reader.touch_all(self.path)


class YamlSequence(list[Any]):
    """A list of a YAML file; items are copies of what is below, plain ones as in a mapping."""

    __slots__ = ("_is_plain", "path", "reader")

    def __init__(
        self, items: Iterable[Any], reader: Reader | None, path: KeyPath, *, plain: bool = False
    ) -> None:
        super().__init__(items)
        self.reader, self.path, self._is_plain = reader, path, plain

    def __getitem__(self, index: Any) -> Any:  # noqa: ANN401
        value = super().__getitem__(index)
        if isinstance(index, int):
            return self._wrapped(index % len(self), value)
        self._read_whole()
        return wrap(value, None, (), plain=self._is_plain)

    def __iter__(self) -> Iterator[Any]:
        for index, value in enumerate(super().__iter__()):
            yield self._wrapped(index, value)

    def _wrapped(self, index: int, value: Any, *, plain: bool = False) -> Any:  # noqa: ANN401
        path = (*self.path, index)
        if self.reader is not None:
            self.reader.touch(path)
        return wrap(value, self.reader, path, plain=plain or self._is_plain)

    def _plain(self) -> list[Any]:
        """As an ordinary list, every item read."""
        items = enumerate(super().__iter__())
        return [self._wrapped(index, value, plain=True) for index, value in items]

    def __add__(self, other: list[Any]) -> list[Any]:
        return [*self._plain(), *other]

    def __mul__(self, times: SupportsIndex) -> list[Any]:
        return self._plain() * times

    __rmul__ = __mul__

    def copy(self) -> Any:  # noqa: ANN401
        """An ordinary list of it."""
        return self._plain()

    def pop(self, index: Any = -1) -> Any:  # noqa: ANN401
        """Take an item out of this copy; paths of later reads are no longer known."""
        value = super().pop(index)
        self._read_whole()
        self.reader = None
        return wrap(value, None, (), plain=True)

    def __repr__(self) -> str:
        self._read_whole()
        return list.__repr__(self)

    def __radd__(self, other: list[Any]) -> list[Any]:
        return other + self._plain()

    def __contains__(self, item: object) -> bool:
        self._read_whole()
        return list.__contains__(self, item)

    def __eq__(self, other: object) -> bool:
        self._read_whole()
        return list.__eq__(self, other)

    def __ne__(self, other: object) -> bool:
        return not self == other

    __hash__ = None  # pyright: ignore[reportAssignmentType] - as that of a list

    def __lt__(self, other: list[Any]) -> bool:
        return self._plain() < other

    def __le__(self, other: list[Any]) -> bool:
        return self._plain() <= other

    def __gt__(self, other: list[Any]) -> bool:
        return self._plain() > other

    def __ge__(self, other: list[Any]) -> bool:
        return self._plain() >= other

    def __reversed__(self) -> Iterator[Any]:
        return reversed(self._plain())

    def index(self, *wanted: Any) -> int:  # noqa: ANN401
        """Where an item stands."""
        return self._plain().index(*wanted)

    def count(self, item: Any) -> int:  # noqa: ANN401
        """How often an item occurs."""
        return self._plain().count(item)

    def _read_whole(self) -> None:
        """Note that everything below is read at once."""
        if self.reader is not None:
            self.reader.touch_all(self.path)


METHODS[YamlMapping] = METHODS[dict]
METHODS[YamlSequence] = METHODS[list]


def wrap(value: Any, reader: Reader | None, path: KeyPath, *, plain: bool = False) -> Any:  # noqa: ANN401
    """Have reads of mappings and lists noted, their dotted access unless `plain`."""
    if isinstance(value, dict):
        return YamlMapping(cast("dict[Any, Any]", value), reader, path, plain=plain)
    if isinstance(value, list):
        items = list.__iter__(cast("list[Any]", value))
        return YamlSequence(items, reader, path, plain=plain)
    return value


def rewrite(wrapped: Any, reads: YamlReads, path: KeyPath, value: Any) -> None:  # noqa: ANN401
    """Have a value that a run read hold another scalar of its file, wherever it holds that one."""
    if isinstance(wrapped, YamlMapping | YamlSequence):
        reader = wrapped.reader
        if reader is not None and reader.reads is reads and wrapped.path == path[:-1]:
            replace_item(wrapped, path[-1], value)
    elif isinstance(wrapped, dict):
        for one in cast("dict[Any, Any]", wrapped).values():
            rewrite(one, reads, path, value)
    elif isinstance(wrapped, list | tuple):
        for one in cast("list[Any]", wrapped):
            rewrite(one, reads, path, value)


def replace_item(container: Any, key: str | int, value: Any) -> None:  # noqa: ANN401
    """Put a value into a mapping or list, unnoticed."""
    kind = dict if isinstance(container, dict) else list
    cast("Any", kind).__setitem__(container, key, value)


def scalar_of(text: str, tag: str, evaluate: Callable[[str], Any]) -> Any:  # noqa: ANN401
    """The value of one plain scalar, a word without blanks, as in a file.

    Raises:
        Fault: Its tag asks for a number, and it is none.
        LookupError: The tag is none of xacro's.
    """
    if tag:
        return float(evaluate(text)) * UNITS[tag]
    return yaml.load(text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))


def origin_of(value: object) -> tuple[str, KeyPath] | None:
    """The file and key path that a container was read from; None for any other value."""
    if not isinstance(value, YamlMapping | YamlSequence) or value.reader is None:
        return None
    return value.reader.reads.path, value.path


def read_yaml(path: str, data: bytes, evaluate: Callable[[str], Any]) -> Any:  # noqa: ANN401
    """The values of a YAML file as plain Python.

    Args:
        path: Named in errors.
        data: The file.
        evaluate: For the text behind `!degrees` and its like.

    Raises:
        Fault: It is no YAML, with its place.
        Refusal: Its aliases would expand without bound.
    """
    _refuse_bulk(data)
    try:
        return _construct(data.decode("utf-8"), evaluate)
    except yaml.YAMLError as error:
        raise _located(path, error) from None
    except UnicodeDecodeError:
        raise Fault("yaml-malformed", f"{path} is not UTF-8: save it as UTF-8.") from None
    except (RecursionError, ValueError) as error:
        raise Fault("yaml-malformed", f"{path} is no YAML that can be read: {error}.") from None


def check_aliases(data: bytes) -> None:
    """See that the aliases of a YAML text do not expand without bound; errors are left alone.

    Raises:
        Refusal: They do.
    """
    _refuse_bulk(data)
    base = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    try:
        node = yaml.compose(data, Loader=base)
    except (yaml.YAMLError, RecursionError, ValueError):
        return
    _count(node, {}, set())


def _refuse_bulk(data: bytes) -> None:
    """Refuse what would take long to parse, before it is."""
    if sum(map(data.count, (b",", b":", b"\n"))) > _SEPARATORS_LIMIT:
        raise Refusal("yaml-too-large", "A YAML file holds more values than any robot needs.")
    depth = 0
    for bracket in _BRACKETS.finditer(data):
        depth += 1 if bracket[0] in b"[{" else -1
        if depth > 4 * DEPTH_LIMIT:
            raise _too_deep()
    if _COMPACT.search(data):
        raise _too_deep()


def _too_deep() -> Refusal:
    return Refusal("yaml-too-deep", f"A YAML file nests values deeper than {DEPTH_LIMIT}.")


def _construct(text: str, evaluate: Callable[[str], Any]) -> Any:  # noqa: ANN401
    base = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    loader = type("_UnitLoader", (base,), {})(text)
    for tag, size in UNITS.items():
        loader.add_constructor(tag, _unit_constructor(size, evaluate))
    try:
        node = loader.get_single_node()
        if node is None:
            return None
        _count(node, {}, set())
        return loader.construct_document(node)
    finally:
        loader.dispose()


def _unit_constructor(size: float, evaluate: Callable[[str], Any]) -> Callable[[Any, Any], float]:
    def construct(loader: Any, node: Any) -> float:  # noqa: ANN401
        return float(evaluate(loader.construct_scalar(node))) * size

    return construct


def _count(node: Any, counted: dict[int, int], inside: set[int]) -> int:  # noqa: ANN401
    """Values below a node, aliases counted each time.

    Raises:
        Refusal: More than EXPANDED_LIMIT, deeper than DEPTH_LIMIT, or a node that contains itself.
    """
    key = id(node)
    if key in counted:
        return counted[key]
    if key in inside:
        raise Refusal("yaml-bomb", "A YAML file has an anchor that contains itself.")
    if len(inside) > DEPTH_LIMIT:
        raise _too_deep()
    if isinstance(node, yaml.ScalarNode):
        _check_number(node.tag, node.value)
    inside.add(key)
    total = 1 + sum(_count(child, counted, inside) for child in _children(node))
    inside.discard(key)
    if total > EXPANDED_LIMIT:
        raise Refusal("yaml-bomb", "The aliases of a YAML file expand to too many values.")
    counted[key] = total
    return total


def _check_number(tag: str, text: str) -> None:
    """Refuse whole numbers that take long to read, or that all have the same hash."""
    is_long = len(text) > _DIGITS_LIMIT and not text.lstrip("+-").startswith("0b")
    if tag == "tag:yaml.org,2002:int" and (is_long or len(text) > 4 * _DIGITS_LIMIT):
        raise Refusal("value-too-large", "A YAML file holds a whole number that is too large.")


def _children(node: Any) -> Iterator[Any]:  # noqa: ANN401
    if isinstance(node, yaml.MappingNode):
        return (one for pair in cast("list[tuple[Any, Any]]", node.value) for one in pair)
    if isinstance(node, yaml.SequenceNode):
        return iter(cast("list[Any]", node.value))
    return iter(())


def _located(path: str, error: yaml.YAMLError) -> Fault:
    mark = getattr(error, "problem_mark", None)
    reason = getattr(error, "problem", None) or str(error)
    fault = Fault("yaml-malformed", f"The YAML is not valid here: {reason}.")
    fault.place = Place(path, mark.line + 1, mark.column + 1) if mark else Place(path)
    return fault

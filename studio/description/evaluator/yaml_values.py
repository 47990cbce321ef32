# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false
"""Values of YAML files inside expressions: dotted access as xacro has it, and every read noted."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, SupportsIndex, cast

from studio.description.evaluator.graph import YamlReads, YamlValue
from studio.description.expressions.guards import METHODS

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from studio.description.evaluator.graph import Input
    from studio.description.syntax.yaml_spans import KeyPath


class Reader:
    """Notes what is read of one document in one run; `note` gets every value read."""

    __slots__ = ("_note", "reads")

    def __init__(self, reads: YamlReads, note: Callable[[Input], None]) -> None:
        self.reads, self._note = reads, note

    def touch(self, path: KeyPath) -> None:
        """The value at a path was read."""
        value = self.reads.values.get(path)
        if value is None:
            value = self.reads.values[path] = YamlValue(self.reads.path, path)
        self._note(value)

    def touch_all(self, path: KeyPath) -> None:
        """Everything below a path was read at once."""
        self.reads.whole.add(path)


class YamlMapping(dict[Any, Any]):
    """A mapping of a YAML file: `m.key` and `m['key']` return a copy of what is below.

    A plain one, and all below it, has no dots: what xacro's wrappers return through dict's methods.
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
        """Return it as an ordinary dict, every value read."""
        return {key: self._wrapped(key, value, plain=True) for key, value in super().items()}

    def get(self, key: Any, default: Any = None) -> Any:  # noqa: ANN401
        """Return the value of a key, or a default."""
        return self._wrapped(key, super().__getitem__(key), plain=True) if key in self else default

    def __iter__(self) -> Iterator[Any]:  # so that `dict(m)` asks for each item
        return super().__iter__()

    def items(self) -> Any:  # noqa: ANN401
        """Return all (key, value) pairs."""
        return self._plain().items()

    def values(self) -> Any:  # noqa: ANN401
        """Return all values."""
        return self._plain().values()

    def copy(self) -> Any:  # noqa: ANN401
        """Return an ordinary dict of it."""
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
        """Return it as an ordinary list, every item read."""
        items = enumerate(super().__iter__())
        return [self._wrapped(index, value, plain=True) for index, value in items]

    def __add__(self, other: list[Any]) -> list[Any]:
        return [*self._plain(), *other]

    def __mul__(self, times: SupportsIndex) -> list[Any]:
        return self._plain() * times

    __rmul__ = __mul__

    def copy(self) -> Any:  # noqa: ANN401
        """Return an ordinary list of it."""
        return self._plain()

    def pop(self, index: Any = -1) -> Any:  # noqa: ANN401
        """Take an item out of this copy; paths recentlyr reads are no longer known."""
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
        """Return the index of an item."""
        return self._plain().index(*wanted)

    def count(self, item: Any) -> int:  # noqa: ANN401
        """Return how often an item occurs."""
        return self._plain().count(item)

    def _read_whole(self) -> None:
        """Note that everything below is read at once."""
        if self.reader is not None:
            self.reader.touch_all(self.path)


METHODS[YamlMapping] = METHODS[dict]
METHODS[YamlSequence] = METHODS[list]


def wrap(value: Any, reader: Reader | None, path: KeyPath, *, plain: bool = False) -> Any:  # noqa: ANN401
    """Note the reads of mappings and lists, and dotted access unless `plain`."""
    if isinstance(value, dict):
        return YamlMapping(cast("dict[Any, Any]", value), reader, path, plain=plain)
    if isinstance(value, list):
        items = list.__iter__(cast("list[Any]", value))
        return YamlSequence(items, reader, path, plain=plain)
    return value


def rewrite(wrapped: Any, reads: YamlReads, path: KeyPath, value: Any) -> None:  # noqa: ANN401
    """Replace a scalar in a value that a run read, wherever it occurs."""
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


def origin_of(value: object) -> tuple[str, KeyPath] | None:
    """Return the file and key path that a container was read from; None for any other value."""
    if not isinstance(value, YamlMapping | YamlSequence) or value.reader is None:
        return None
    return value.reader.reads.path, value.path

"""Limits on the size of a value of an expression, and on the cost of one run.

Python counts a list that holds a list twice as two items; printing, comparing or hashing it goes
through all of them, deep in C, where the clock is not checked. So nothing that large may exist:
whatever an expression makes passes through `made`.
"""

from __future__ import annotations

from collections.abc import ItemsView, KeysView, ValuesView
from dataclasses import dataclass
from time import perf_counter, thread_time
from typing import TYPE_CHECKING, Any, Final, cast

from studio.description.faults import Refusal

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator

SIZE_LIMIT: Final = 1_000_000
"""Characters of a text."""
BITS_LIMIT: Final = 2_048
"""Of a whole number; 617 digits, twice what fits into a float."""
ITEMS_LIMIT: Final = 10_000
"""Of a list and all that is in it; a text counts as one more for each 64 characters. As many
numbers of one hash make a set in a second."""
DEPTH_LIMIT: Final = 64
"""Lists inside lists."""
_SAME_HASH_LIMIT: Final = 100
"""Keys of one set or mapping that share a hash with another: each is compared with all of them."""
_CONTAINERS: Final = (list, tuple, dict, set, frozenset, KeysView, ItemsView, ValuesView)
_EMPTY: Final[dict[str, str]] = {}
_KINDS: Final[frozenset[type[object]]] = frozenset(
    (
        list,
        tuple,
        dict,
        set,
        frozenset,
        *map(type, (_EMPTY.keys(), _EMPTY.values(), _EMPTY.items())),
    )
)
"""Those of Python; the content of a YAML file is bounded when it is read."""
_HASHED: Final[frozenset[type[object]]] = frozenset((dict, set, frozenset))
_USUAL_BYTES: Final = 1 << 20
"""Of all files of a robot together; they have the usual time."""
_BYTES_A_SECOND: Final = 150_000
_MOST_READING_S: Final = 30.0
_CLOCK_EVERY: Final = 16
"""Steps between two checks of the clock."""
_CHECK_AFTER_S: Final = 0.05
"""Or so long after the last check: a step may be the search of a long text."""


def too_large() -> Refusal:
    """Return the exception of every size guard."""
    return Refusal("value-too-large", "An expression makes a value that is too large.")


def made(value: Any) -> Any:  # noqa: ANN401 - any value of a description
    """Return the value itself.

    Raises:
        Refusal: It is too large.
    """
    kind = cast("type[object]", type(value))
    if kind is float or kind is bool:
        return value
    if kind is str:
        if len(value) > SIZE_LIMIT:
            raise too_large()
    elif kind is int:
        if value.bit_length() > BITS_LIMIT:
            raise too_large()
    elif kind in _KINDS:
        weight(value)
        if kind in _HASHED:
            _check_hashes(cast("Collection[Any]", value))
    return value


def _check_hashes(keys: Collection[Any]) -> None:
    """Check that keys differ by their hashes: else to compare two sets takes a second.

    Raises:
        Refusal: They do not.
    """
    count = len(keys)
    if count > _SAME_HASH_LIMIT and count - len(set(map(hash, keys))) > _SAME_HASH_LIMIT:
        raise too_large()


def is_lasting(value: Any) -> bool:  # noqa: ANN401
    """Whether each reader finds the same: no iterator, which the first uses up, is or is in it."""
    kind = cast("type[object]", type(value))
    return all(map(is_lasting, _items(value))) if kind in _KINDS else not hasattr(kind, "__next__")


def weight(value: Any, left: int = ITEMS_LIMIT) -> int:  # noqa: ANN401
    """Return how many items a value has, itself included.

    Raises:
        Refusal: More than `left`, or they are nested deeper than DEPTH_LIMIT.
    """
    return left - _without(value, left, DEPTH_LIMIT)


def _without(value: Any, left: int, depth: int) -> int:  # noqa: ANN401
    """Return what is left of `left` items after a value and all in it."""
    if isinstance(value, str):
        left -= len(value) >> 6
    elif isinstance(value, _CONTAINERS):
        if not depth:
            raise too_large()
        for item in _items(value):
            left = _without(item, left, depth - 1)
    if left <= 0:
        raise too_large()
    return left - 1


def _items(value: Any) -> Iterable[Any]:  # noqa: ANN401
    """Return raw items: reading a YAML value here must not count as a read."""
    if isinstance(value, dict):
        items = cast("dict[Any, Any]", value)
        return (one for pair in cast("Any", dict).items(items) for one in pair)
    if isinstance(value, list):
        return cast("Any", list).__iter__(value)
    return iter(cast("Iterable[Any]", value))


@dataclass(frozen=True, slots=True)
class Limits:
    """Bounds of one run; of the corpus none needs more than 6 % of any but the depths (10 %)."""

    macro_depth: int = 350
    """Stock xacro ends at Python's 1000 frames, of which a call takes three or more."""
    element_depth: int = 450
    """Nested elements: writing or reading them goes as deep, within those frames."""
    elements: int = 50_000
    evaluations: int = 500_000
    text: int = 20_000_000
    """Characters of all long texts that expressions make."""
    seconds: float = 2.0
    bytes_an_element: int = 16
    """Fewer than the shortest element of a robot has: of what is written all may come out."""


def reading_time_s(size_bytes: int) -> float:
    """Return the extra time of a run for so much source text, which makes it no bomb."""
    return min(max(0, size_bytes - _USUAL_BYTES) / _BYTES_A_SECOND, _MOST_READING_S)


class Budget:
    """Counts one run. Every step is an evaluated text, an element, a call or one turn of a loop."""

    __slots__ = (
        "_began",
        "_characters",
        "_checked_s",
        "_elements",
        "_evaluations",
        "_sources",
        "limits",
    )

    def __init__(self, limits: Limits) -> None:
        self.limits = limits
        self._sources: dict[str, int] = {}
        self.restart()

    def restart(self) -> None:
        """Count again, for an edit of what came out."""
        self._elements = self._evaluations = self._characters = 0
        self._checked_s = perf_counter()
        self._began = self._checked_s, thread_time()

    def source(self, path: str, size_bytes: int) -> None:
        """A file is read: once, however often it is included."""
        self._sources[path] = size_bytes

    @property
    def elements(self) -> int:
        """The number of elements that may come out of what has been read so far."""
        return self.limits.elements + sum(self._sources.values()) // self.limits.bytes_an_element

    @property
    def seconds(self) -> float:
        """The time that a run of what has been read so far may take."""
        return self.limits.seconds + reading_time_s(sum(self._sources.values()))

    def element(self) -> None:
        """Count an element that came out.

        Raises:
            Refusal: There are too many, or the time is over.
        """
        self._elements += 1
        if self._elements > self.limits.elements and self._elements > self.elements:
            raise Refusal("too-many-elements", f"It makes more than {self.elements:,} elements.")
        if not self._elements % _CLOCK_EVERY:
            self._check_clock()

    def evaluation(self) -> None:
        """Count the evaluation of a text; raises as `element`."""
        self._evaluations += 1
        is_due = not self._evaluations % _CLOCK_EVERY
        if is_due or perf_counter() - self._checked_s > _CHECK_AFTER_S:
            self._check_clock()
            if self._evaluations > self.limits.evaluations:
                raise Refusal(
                    "too-many-evaluations",
                    f"It evaluates more than {self.limits.evaluations:,} expressions.",
                )

    def text(self, characters: int) -> None:
        """A long text was made.

        Raises:
            Refusal: All of them together are too long.
        """
        self._characters += characters
        if self._characters > self.limits.text:
            raise Refusal(
                "too-much-text", f"It makes more than {self.limits.text:,} characters of text."
            )

    def steps(self, items: Iterable[Any]) -> Iterator[Any]:
        """Yield the items of a loop inside an expression, each counted."""
        for item in items:
            self.evaluation()
            yield item

    def nesting(self, path: str) -> None:
        """An element comes out inside those that `path` names, with `/` between them.

        Raises:
            Refusal: That is too deep.
        """
        most = self.limits.element_depth
        if len(path) >= 2 * most - 1 and path.count("/") + 1 >= most:
            raise Refusal("xml-too-deep", f"It nests elements deeper than {most}.")

    def depth(self, depth: int, macro: str) -> None:
        """A macro is called inside `depth - 1` others.

        Raises:
            Refusal: That is too deep; it most likely calls itself without end.
        """
        if depth > self.limits.macro_depth:
            raise Refusal(
                "macro-recursion",
                f'The macro "{macro}" is called inside more than {self.limits.macro_depth} others: '
                "it calls itself without end.",
            )

    def _check_clock(self) -> None:
        """Check that the time is not over, of which a loaded machine gives a run little.

        Raises:
            Refusal: It is, and the run had no small part of the processor meanwhile.
        """
        began, began_working = self._began
        self._checked_s, seconds = perf_counter(), self.seconds
        if self._checked_s - began <= seconds:
            return  # the processor's clock is a slow one, and cannot be ahead
        if thread_time() - began_working > seconds / 2:
            raise Refusal(
                "expansion-too-slow",
                f"The expansion takes longer than {seconds:.2g} s and was ended.",
            )

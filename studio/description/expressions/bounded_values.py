"""How large a value of an expression may be, each item counted wherever it is met.

Python counts a list that holds a list twice as two items; printing, comparing or hashing it goes
through all of them, deep in C, where no clock is looked at. So nothing that large may come to be:
whatever an expression makes passes through `made`.
"""

from __future__ import annotations

from collections.abc import ItemsView, KeysView, ValuesView
from typing import TYPE_CHECKING, Any, Final, cast

from studio.description.faults import Refusal

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable

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
"""Those of Python; what a YAML file holds is bounded when it is read."""

_HASHED: Final[frozenset[type[object]]] = frozenset((dict, set, frozenset))


def too_large() -> Refusal:
    """What every size guard raises."""
    return Refusal("value-too-large", "An expression makes a value that is too large.")


def made(value: Any) -> Any:  # noqa: ANN401 - any value of a description
    """The value itself.

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
    """See that keys differ by their hashes: else to compare two sets takes a second.

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
    """How many items a value has, itself included.

    Raises:
        Refusal: More than `left`, or they are nested deeper than DEPTH_LIMIT.
    """
    return left - _without(value, left, DEPTH_LIMIT)


def _without(value: Any, left: int, depth: int) -> int:  # noqa: ANN401
    """What is left of `left` items after a value and all in it."""
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
    """Raw items: looking at a YAML value must not count as reading it."""
    if isinstance(value, dict):
        items = cast("dict[Any, Any]", value)
        return (one for pair in cast("Any", dict).items(items) for one in pair)
    if isinstance(value, list):
        return cast("Any", list).__iter__(value)
    return iter(cast("Iterable[Any]", value))

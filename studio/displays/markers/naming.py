"""Naming: the frames and namespaces of the markers of one message, told apart by numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from studio.displays.markers.kinds import Flags, Whole
    from studio.ros.columns.markers import MarkerColumns, MarkerTexts

_KEPT: Final = 4
_BYTES_KEPT_MAX: Final = 1 << 20
STAMPS_MAX: Final = 256
"""Of one message: of more, those that are close to each other are taken for one."""
_CLOSE_NS: Final = 10_000_000


class BatchKey(NamedTuple):
    """What markers have in common that are drawn together."""

    frame: str
    """Without a leading slash, as RViz looks it up."""
    stamp_ns: int
    """0 for those that follow their frame: it is the newest transform that counts."""
    follows: bool
    namespace: str | None
    """None: any of those that are not drawn apart."""


class Named(NamedTuple):
    """What the texts of M markers say, made once for texts that come again."""

    texts: tuple[MarkerTexts, ...]
    namespaces: list[str]
    """Of each."""
    pairs: NDArray[np.int64]
    """Shape (M,): the same number where frame and namespace are the same."""
    nameless: Flags
    """Shape (M,): which name no frame."""


class Naming:
    """Remembers the last messages: a publisher sends the same names over and over."""

    def __init__(self) -> None:
        self._known: list[Named] = []

    def named(self, texts: tuple[MarkerTexts, ...]) -> Named:
        """Number the frames and namespaces of a message."""
        for known in self._known:
            if known.texts is texts:
                return known
        made = _named(texts)
        if sum(len(one.mesh_file_data) for one in texts) < _BYTES_KEPT_MAX:
            self._known = [made, *self._known[: _KEPT - 1]]
        return made


def _named(texts: tuple[MarkerTexts, ...]) -> Named:
    numbers: dict[tuple[str, str], int] = {}
    pairs = [numbers.setdefault((one.frame, one.namespace), len(numbers)) for one in texts]
    return Named(
        texts,
        [one.namespace for one in texts],
        np.array(pairs, dtype=np.int64),
        np.array([one.frame in ("", "/") for one in texts], dtype=np.bool_),
    )


def batch_keys(
    columns: MarkerColumns, named: Named, chosen: Whole, is_apart: Callable[[str], bool]
) -> tuple[list[BatchKey], Whole]:
    """Sort markers into batches.

    Args:
        columns: Of a message.
        named: Of the same message.
        chosen: Shape (M,): which of its markers, at least one.
        is_apart: Whether a namespace is drawn apart from others.

    Returns:
        Keys, some of them perhaps the same, and which of them each marker (M,) has.
    """
    locked = columns.frame_locked[chosen]
    stamps_ns = few_stamps(np.where(locked, 0, columns.stamps_ns[chosen]))
    codes = 2 * named.pairs[chosen] + locked
    if stamps_ns.min() != stamps_ns.max():
        distinct, moments = np.unique(stamps_ns, return_inverse=True)
        codes = codes * len(distinct) + moments
    _, first, inverse = np.unique(codes, return_index=True, return_inverse=True)
    keys: list[BatchKey] = []
    for at in first.tolist():
        text = columns.texts[int(chosen[at])]
        frame = text.frame.removeprefix("/")
        namespace = text.namespace if is_apart(text.namespace) else None
        keys.append(BatchKey(frame, int(stamps_ns[at]), bool(locked[at]), namespace))
    return keys, inverse


def few_stamps(stamps_ns: NDArray[np.int64]) -> NDArray[np.int64]:
    """Stamps (N,) of one message; if there are too many, groups of them have that of the first.

    Who stamps each marker as it makes it needs no transform for each: what lies 10 ms apart is
    taken for one, or more if they reach over a longer time.
    """
    distinct = np.unique(stamps_ns)
    if len(distinct) <= STAMPS_MAX:
        return stamps_ns
    least, span_ns = int(distinct[0]), int(distinct[-1]) - int(distinct[0])
    width_ns = max(_CLOSE_NS, span_ns // STAMPS_MAX + 1)
    groups = (distinct - least) // width_ns
    _, first, inverse = np.unique(groups, return_index=True, return_inverse=True)
    return distinct[first][inverse][np.searchsorted(distinct, stamps_ns)]

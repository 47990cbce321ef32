"""Naming: the frames and namespaces of the markers of one message, told apart by numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.displays.markers.kinds import Flags, Whole
    from studio.ros.fast.marker_columns import MarkerColumns, MarkerTexts

_KEPT: Final = 4
_BYTES_KEPT_MAX: Final = 1 << 20


class BatchKey(NamedTuple):
    """What markers have in common that are drawn together."""

    frame: str
    """Without a leading slash, as RViz looks it up."""
    stamp_ns: int
    """0 for those that follow their frame: it is the newest transform that counts."""
    follows: bool
    namespace: str


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
    columns: MarkerColumns, named: Named, chosen: Whole
) -> tuple[list[BatchKey], Whole, Whole]:
    """Sort markers into batches.

    Args:
        columns: Of a message.
        named: Of the same message.
        chosen: Shape (M,): which of its markers.

    Returns:
        The keys, the number of markers of each, and of each marker (M,) which key it has.
    """
    locked = columns.frame_locked[chosen]
    stamps_ns = np.where(locked, 0, columns.stamps_ns[chosen])
    codes = 2 * named.pairs[chosen] + locked
    if len(stamps_ns) and stamps_ns.min() != stamps_ns.max():
        distinct, moments = np.unique(stamps_ns, return_inverse=True)
        codes = codes * len(distinct) + moments
    _, first, inverse, counts = np.unique(
        codes, return_index=True, return_inverse=True, return_counts=True
    )
    keys: list[BatchKey] = []
    for at in first.tolist():
        text = columns.texts[int(chosen[at])]
        frame = text.frame.removeprefix("/")
        keys.append(BatchKey(frame, int(stamps_ns[at]), bool(locked[at]), text.namespace))
    return keys, counts, inverse

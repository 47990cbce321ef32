"""Newcomers: of the rows of a message, those that tell of frames that nothing is known of yet."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from studio.tf.admission import fault_of_names, plain

if TYPE_CHECKING:
    from studio.tf.columns import Flags, Numbers, TransformColumns
    from studio.tf.forest import Forest

MANY: Final = 32
"""Fewer are taken up one by one; of a large robot all come at once."""


class Newcomers(NamedTuple):
    """Rows whose children are new and named once, and their plain names, parent first."""

    rows: Numbers
    edges: list[tuple[str, str]]


def newcomers_among(columns: TransformColumns, asked: Flags, forest: Forest) -> Newcomers | None:
    """Those among the rows that are asked for, shape (N,); None when they are few."""
    if np.count_nonzero(asked) < MANY:
        return None
    rows: list[int] = np.flatnonzero(asked).tolist()
    edges = [(plain(columns.parents[at]), plain(columns.children[at])) for at in rows]
    told = Counter(child for _, child in edges)
    new = [
        (at, edge)
        for at, edge in zip(rows, edges, strict=True)
        if told[edge[1]] == 1 and forest.number(edge[1]) is None and not fault_of_names(*edge)
    ]
    if len(new) < MANY:
        return None
    return Newcomers(np.array([at for at, _ in new], np.int64), [edge for _, edge in new])

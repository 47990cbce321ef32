"""ForestShape: all frames of a forest row by row, made once while no edge comes or goes."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from studio.tf.forest import NONE
from studio.tf.structure import Structure

if TYPE_CHECKING:
    from studio.tf.columns import Numbers
    from studio.tf.forest import Forest


class ForestShape:
    """A forest as it stood, whatever becomes of it.

    Attributes:
        names: Of the frames, in the order of their numbers.
        rows: Where each name is in `names`.
        numbers: Of the forest, row by row.
        structure: Parents and roots by row.
        hung: Rows that hang on one.
    """

    def __init__(self, forest: Forest) -> None:
        numbers = forest.numbers()
        self.numbers: Numbers = np.array(numbers, np.int64)
        self.names = tuple(forest.names[number] for number in numbers)
        self.rows = {name: row for row, name in enumerate(self.names)}
        parents = np.array(forest.parents, np.int64)[self.numbers]
        rows = np.searchsorted(self.numbers, parents)
        self.structure = Structure(np.where(parents == NONE, NONE, rows))
        self.hung: Numbers = np.flatnonzero(parents != NONE)

    @cached_property
    def alphabetical(self) -> Numbers:
        """The rows in the order of their names."""
        return np.array(sorted(range(len(self.names)), key=self.names.__getitem__), np.int64)

    @cached_property
    def tree_sizes(self) -> dict[str, int]:
        """How many frames each tree has, by its root, from the most."""
        counts = np.bincount(self.structure.roots).tolist()
        sizes = {self.names[row]: int(count) for row, count in enumerate(counts) if count}
        return dict(sorted(sizes.items(), key=lambda one: (-one[1], one[0])))

"""Structure: the shape of a forest as rounds of doubling, for all its frames at once."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from studio.tf.forest import NONE

if TYPE_CHECKING:
    from studio.tf.columns import Flags, Floats, Numbers


class Round(NamedTuple):
    """One doubling: each row is taken over by the row that it has reached."""

    rows: Numbers
    reached: Numbers


class Structure:
    """Parents of F rows, made ready: as many rounds as the depth has binary digits.

    Attributes:
        parents: Shape (F,), row of each row's parent, NONE for a root.
        roots: Shape (F,), row of each row's root.
    """

    def __init__(self, parents: Numbers) -> None:
        self.parents = parents
        self._rounds: list[Round] = []
        reached = np.where(parents == NONE, np.arange(len(parents)), parents)
        while True:
            is_root = reached[reached] == reached
            rows = np.flatnonzero(~is_root)
            # What is left out has reached its root, where nothing is to be added any more.
            if not rows.size:
                break
            self._rounds.append(Round(rows, reached[rows]))
            reached = reached[reached]
        self.roots = reached

    def root_from_rows(self, parent_from_rows: Floats) -> Floats:
        """Multiply matrices (F, 4, 4) down from the roots, whose own are the identity."""
        products = parent_from_rows
        for rows, reached in self._rounds:
            products[rows] = products[reached] @ products[rows]
        return products

    def greatest_above(self, values: Floats) -> Floats:
        """Of each row the greatest of its own value (F,) and those above it, roots left out."""
        greatest = values.copy()
        for rows, reached in self._rounds:
            greatest[rows] = np.maximum(greatest[rows], greatest[reached])
        return greatest

    def first_above(self, flags: Flags) -> Numbers:
        """Of each row the nearest with a flag (F,), itself or one above it; NONE if there is none.

        A root's own flag does not count.
        """
        first = np.where(flags & (self.parents != NONE), np.arange(len(flags)), NONE)
        for rows, reached in self._rounds:
            first[rows] = np.where(first[rows] == NONE, first[reached], first[rows])
        return first

    def without(self, cut: Flags) -> Structure:
        """The structure in which some rows hang on nothing."""
        return Structure(np.where(cut, NONE, self.parents))

    def seen_from(self, row: int) -> tuple[Structure, Numbers]:
        """The tree turned so that it hangs on this row.

        Returns:
            That structure, and shape (F,): the row whose edge leads from each to its new parent.
        """
        parents, edges = self.parents.copy(), np.arange(len(self.parents))
        below, above = row, int(self.parents[row])
        parents[row] = NONE
        while above != NONE:
            parents[above], edges[above] = below, below
            below, above = above, int(self.parents[above])
        return Structure(parents), edges

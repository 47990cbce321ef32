"""The forest of frames: each has at most one parent; and its shape as arrays, for all at once."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from studio.tf.transforms import Flags, Floats, Numbers

NONE: Final = -1
FRAMES_MAX: Final = 20_000
DEPTH_MAX: Final = 1000
"""Of frames above a new one: adding to a longer chain would take too long."""


class Forest:
    """The parent of each frame; `version` changes with every edge that comes or goes.

    A frame keeps its number as long as an edge begins or ends there, then the number is free.
    """

    def __init__(self) -> None:
        self.names: list[str] = []
        """By number; empty where no frame has it."""
        self.parents: list[int] = []
        """By number; NONE for a root."""
        self.version = 0
        self._children: list[int] = []
        self._numbers: dict[str, int] = {}
        self._free: list[int] = []

    def __len__(self) -> int:
        return len(self._numbers)

    def number(self, name: str) -> int | None:
        """Return the number of a frame, if any edge names it."""
        return self._numbers.get(name)

    def numbers(self) -> list[int]:
        """Return all numbers in use, sorted."""
        return sorted(self._numbers.values())

    def room_for(self, *names: str) -> bool:
        """Whether there may be as many more frames as these bring."""
        return len(self) + sum(name not in self._numbers for name in names) <= FRAMES_MAX

    def is_above(self, frame: str, parent: str) -> bool | None:
        """Whether a parent is this frame or below it; None when the chain is too long."""
        number, looked_for = self._numbers.get(parent, NONE), self._numbers.get(frame)
        for _ in range(DEPTH_MAX):
            if number == NONE:
                return False
            if number == looked_for:
                return True
            number = self.parents[number]
        return None

    def hang(self, parent: str, child: str) -> int:
        """Give a frame a parent, instead of the one it had; return the child's number."""
        upper, lower = self._made(parent), self._made(child)
        former = self.parents[lower]
        if former != upper:
            self.parents[lower] = upper
            self._children[upper] += 1
            self._leave(former)
            self.version += 1
        return lower

    def hang_new(self, edges: Sequence[tuple[str, str]]) -> list[int] | None:
        """Give many new frames, each named once as a child, their parents at once.

        Returns:
            The children's numbers; None when one of them closes a circle or is too deep, or when
            there is no room for all: then nothing was changed.
        """
        new = {name: None for edge in edges for name in edge if name not in self._numbers}
        if len(self) + len(new) > FRAMES_MAX or not self._can_hang(edges, new):
            return None
        return [self.hang(parent, child) for parent, child in edges]

    def cut(self, child: int) -> None:
        """Take a frame away from its parent; frames without any edge are forgotten."""
        former, self.parents[child] = self.parents[child], NONE
        self._leave(former)
        self._forget_if_alone(child)
        self.version += 1

    def chain(self, number: int) -> list[int]:
        """Return a frame and everything above it, up to the root."""
        chain = [number]
        while (number := self.parents[number]) != NONE:
            chain.append(number)
        return chain

    def root(self, number: int) -> int:
        """Return the root above a frame."""
        while (parent := self.parents[number]) != NONE:
            number = parent
        return number

    def _can_hang(self, edges: Sequence[tuple[str, str]], new: Collection[str]) -> bool:
        """Whether with these edges every frame would find its root, and soon enough."""
        places = {name: at for at, name in enumerate(new, len(self.names))}
        places |= {
            name: self._numbers[name] for edge in edges for name in edge if name not in places
        }
        reached = np.array([*self.parents, *[NONE] * len(new)], np.int64)
        reached[[places[child] for _, child in edges]] = [places[parent] for parent, _ in edges]
        depths = (reached != NONE).astype(np.int64)
        reached = np.where(reached == NONE, np.arange(len(reached)), reached)
        for _ in range(DEPTH_MAX.bit_length()):
            depths += depths[reached]
            reached = reached[reached]
        return bool((depths[reached] == 0).all() and depths.max() <= DEPTH_MAX)

    def _made(self, name: str) -> int:
        number = self._numbers.get(name)
        if number is None:
            number = self._free.pop() if self._free else self._longer()
            self._numbers[name], self.names[number] = number, name
        return number

    def _longer(self) -> int:
        self.names.append("")
        self.parents.append(NONE)
        self._children.append(0)
        return len(self.names) - 1

    def _leave(self, parent: int) -> None:
        if parent != NONE:
            self._children[parent] -= 1
            self._forget_if_alone(parent)

    def _forget_if_alone(self, number: int) -> None:
        if not self._children[number] and self.parents[number] == NONE:
            del self._numbers[self.names[number]]
            self.names[number] = ""
            self._free.append(number)


class Round(NamedTuple):
    """One doubling: each row takes over the row that it has reached."""

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
        """For each row, the greatest of its own value (F,) and those above it, without roots."""
        greatest = values.copy()
        for rows, reached in self._rounds:
            greatest[rows] = np.maximum(greatest[rows], greatest[reached])
        return greatest

    def first_above(self, flags: Flags) -> Numbers:
        """For each row, the nearest with a flag (F,), itself or one above it; NONE without any.

        A root's own flag does not count.
        """
        first = np.where(flags & (self.parents != NONE), np.arange(len(flags)), NONE)
        for rows, reached in self._rounds:
            first[rows] = np.where(first[rows] == NONE, first[reached], first[rows])
        return first

    def without(self, cut: Flags) -> Structure:
        """Return the structure in which some rows have no parent."""
        return Structure(np.where(cut, NONE, self.parents))

    def seen_from(self, row: int) -> tuple[Structure, Numbers]:
        """Return the tree with this row as its root.

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


class ForestShape:
    """A forest at one moment, as arrays.

    Attributes:
        names: Of the frames, in the order of their numbers.
        rows: Where each name is in `names`.
        numbers: Of the forest, row by row.
        structure: Parents and roots by row.
        hung: Rows that have a parent.
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
        """Return the number of frames of each tree by its root, the largest tree first."""
        counts = np.bincount(self.structure.roots).tolist()
        sizes = {self.names[row]: int(count) for row, count in enumerate(counts) if count}
        return dict(sorted(sizes.items(), key=lambda one: (-one[1], one[0])))

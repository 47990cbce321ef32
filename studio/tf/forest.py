"""Forest: frames by number, each with at most one parent, never in a circle."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

NONE: Final = -1
FRAMES_MAX: Final = 20_000
DEPTH_MAX: Final = 1000
"""Of frames above one to which another is tied: else a long chain would take ages to tie."""


class Forest:
    """Which frame hangs on which; `version` changes with every edge that comes or goes.

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
        """The number of a frame, if any edge names it."""
        return self._numbers.get(name)

    def numbers(self) -> list[int]:
        """All numbers in use, from the least."""
        return sorted(self._numbers.values())

    def room_for(self, *names: str) -> bool:
        """Whether there may be as many more frames as these bring."""
        return len(self) + sum(name not in self._numbers for name in names) <= FRAMES_MAX

    def is_above(self, frame: str, parent: str) -> bool | None:
        """Whether a parent is this frame, or hangs on it; None when it hangs too deep to tell."""
        number, looked_for = self._numbers.get(parent, NONE), self._numbers.get(frame)
        for _ in range(DEPTH_MAX):
            if number == NONE:
                return False
            if number == looked_for:
                return True
            number = self.parents[number]
        return None

    def hang(self, parent: str, child: str) -> int:
        """Tie a frame to a parent, away from the one it had; answers the child's number."""
        upper, lower = self._made(parent), self._made(child)
        former = self.parents[lower]
        if former != upper:
            self.parents[lower] = upper
            self._children[upper] += 1
            self._leave(former)
            self.version += 1
        return lower

    def hang_new(self, edges: Sequence[tuple[str, str]]) -> list[int] | None:
        """Tie many new frames, each named once as a child, to their parents at once.

        Returns:
            The children's numbers; None when one of them closes a circle or hangs too deep, or when
            there is no room for all: then nothing was tied.
        """
        new = {name: None for edge in edges for name in edge if name not in self._numbers}
        if len(self) + len(new) > FRAMES_MAX or not self._can_hang(edges, new):
            return None
        return [self.hang(parent, child) for parent, child in edges]

    def cut(self, child: int) -> None:
        """Untie a frame from its parent; who has no edge any more is forgotten."""
        former, self.parents[child] = self.parents[child], NONE
        self._leave(former)
        self._forget_if_alone(child)
        self.version += 1

    def chain(self, number: int) -> list[int]:
        """A frame and everything that it hangs on, up to the root."""
        chain = [number]
        while (number := self.parents[number]) != NONE:
            chain.append(number)
        return chain

    def root(self, number: int) -> int:
        """What a frame hangs on in the end."""
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

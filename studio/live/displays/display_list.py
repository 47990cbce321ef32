"""DisplayList: which displays a document has, in their order, and how each is set."""

from __future__ import annotations

from collections.abc import Mapping  # noqa: TC003 - msgspec reads it
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Final

from studio.displays.properties import Value
from studio.errors import CommandError

if TYPE_CHECKING:
    from collections.abc import Iterator

DISPLAYS_MAX: Final = 200


@dataclass(frozen=True, slots=True)
class Listening:
    """QoS of a subscription; None: chosen to fit the publishers."""

    reliable: bool | None = None
    latched: bool | None = None
    depth: int | None = None


@dataclass(frozen=True, slots=True)
class DisplaySpec:
    """Settings of one display.

    `values` holds the properties that differ from their defaults.
    """

    id: str
    kind: str
    name: str
    topic: str = ""
    enabled: bool = True
    group: str = ""
    listening: Listening = Listening()
    values: Mapping[str, Value] = field(default_factory=dict[str, Value])


class DisplayList:
    """Displays in the order in which they are listed; ids are never given twice."""

    def __init__(self) -> None:
        self._specs: dict[str, DisplaySpec] = {}
        self._groups_off: set[str] = set()
        self._given = 0

    def __iter__(self) -> Iterator[DisplaySpec]:
        return iter(self._specs.values())

    def __len__(self) -> int:
        return len(self._specs)

    @property
    def groups_off(self) -> tuple[str, ...]:
        """Groups that are hidden as a whole."""
        groups = {one.group for one in self}
        return tuple(sorted(self._groups_off & groups))

    def get(self, display: str) -> DisplaySpec:
        """Return the one of an id.

        Raises:
            CommandError: There is none any more; so for all that follow.
        """
        if found := self._specs.get(display):
            return found
        raise CommandError("This display is not there any more: choose another.")

    def is_shown(self, spec: DisplaySpec) -> bool:
        """Whether it is switched on, and its group with it."""
        return spec.enabled and spec.group not in self._groups_off

    def add(self, kind: str, topic: str = "") -> DisplaySpec:
        """Add one at the end, named after its kind."""
        name = self._free_name(kind.rpartition("/")[2])
        return self.put(DisplaySpec("", kind, name, topic))

    def put(self, spec: DisplaySpec, after: str = "") -> DisplaySpec:
        """Add one with these settings and an id of its own, behind another or at the end.

        Raises:
            CommandError: There are too many.
        """
        if len(self._specs) >= DISPLAYS_MAX:
            raise CommandError(f"There are {DISPLAYS_MAX} displays: remove one first.")
        self._given += 1
        added = replace(spec, id=f"d{self._given}")
        specs = list(self)
        ids = [one.id for one in specs]
        at = ids.index(after) + 1 if after in ids else len(specs)
        self._arrange([*specs[:at], added, *specs[at:]])
        return added

    def remove(self, display: str) -> None:
        """Take one away."""
        del self._specs[self.get(display).id]

    def duplicate(self, display: str) -> DisplaySpec:
        """Add one with the same settings behind it."""
        like = self.get(display)
        return self.put(replace(like, name=self._free_name(like.name)), after=display)

    def change(self, spec: DisplaySpec) -> None:
        """Replace the display with the id of `spec`."""
        self._specs[self.get(spec.id).id] = spec

    def move(self, display: str, before: str) -> None:
        """Put one before another; with an empty id at the end."""
        moved = self.get(display)
        if before == display:
            return
        others = [one for one in self if one is not moved]
        at = others.index(self.get(before)) if before else len(others)
        self._arrange([*others[:at], moved, *others[at:]])

    def switch_group(self, group: str, *, shown: bool) -> None:
        """Show or hide a group as a whole.

        Raises:
            CommandError: No display is in it.
        """
        if group not in {one.group for one in self} or not group:
            raise CommandError(f'There is no group "{group}" any more.')
        if shown:
            self._groups_off.discard(group)
        else:
            self._groups_off.add(group)

    def _arrange(self, specs: list[DisplaySpec]) -> None:
        self._specs = {one.id: one for one in specs}

    def _free_name(self, wanted: str) -> str:
        taken = {one.name for one in self}
        stem = wanted.rstrip("0123456789 ") or wanted
        names = (wanted, *(f"{stem} {number}" for number in range(2, DISPLAYS_MAX + 3)))
        return next(name for name in names if name not in taken)

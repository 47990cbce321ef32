"""DisplayList: which displays a document has, in their order, and how each is set."""

from __future__ import annotations

from collections.abc import Mapping  # noqa: TC003 - msgspec reads it
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Final

from studio.displays.properties import Value
from studio.errors import CommandError
from studio.live.displays.groups import all_groups, group_path, groups_to, is_within, regrouped

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

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

    `group` is a path, as `Navigation/Local`; `values` holds the properties that differ from their
    defaults, `entry` what an `.rviz` file says of the display.
    """

    id: str
    kind: str
    name: str
    topic: str = ""
    enabled: bool = True
    group: str = ""
    listening: Listening = Listening()
    values: Mapping[str, Value] = field(default_factory=dict[str, Value])
    entry: dict[str, Any] = field(default_factory=dict[str, Any])


@dataclass(frozen=True, slots=True)
class _Removed:
    """A display that was taken away, and the ids of those that followed it."""

    spec: DisplaySpec
    behind: tuple[str, ...]


class DisplayList:
    """Displays in the order in which they are listed; ids are never given twice.

    A group is there as long as a display is in it, or in a group that stands in it.
    """

    def __init__(self) -> None:
        self._specs: dict[str, DisplaySpec] = {}
        self._groups_off: set[str] = set()
        self._removed: dict[str, _Removed] = {}
        self._given = 0

    def __iter__(self) -> Iterator[DisplaySpec]:
        return iter(self._specs.values())

    def __len__(self) -> int:
        return len(self._specs)

    @property
    def groups_off(self) -> tuple[str, ...]:
        """Groups that are hidden as a whole."""
        return tuple(sorted(self._groups_off & self._groups))

    @property
    def _groups(self) -> frozenset[str]:
        return all_groups(one.group for one in self)

    def get(self, display: str) -> DisplaySpec:
        """Return the one of an id.

        Raises:
            CommandError: There is none any more; so for all that follow.
        """
        if found := self._specs.get(display):
            return found
        raise CommandError("This display is not there any more: choose another.")

    def is_shown(self, spec: DisplaySpec) -> bool:
        """Whether it is switched on, and all groups around it with it."""
        return spec.enabled and self._groups_off.isdisjoint(groups_to(spec.group))

    def hidden_by(self, spec: DisplaySpec) -> str:
        """Return the outermost group around it that is hidden; empty: none is."""
        return next((one for one in groups_to(spec.group) if one in self._groups_off), "")

    def members(self, group: str) -> tuple[DisplaySpec, ...]:
        """Return the displays in a group and in those that stand in it, in order.

        Raises:
            CommandError: There are none.
        """
        found = tuple(one for one in self if is_within(one.group, group))
        if not found or not group:
            raise CommandError(f'There is no group "{group}" any more.')
        return found

    def add(self, kind: str, topic: str = "") -> DisplaySpec:
        """Add one at the end, named after its kind."""
        name = self._free_name(kind.rpartition("/")[2])
        return self.put(DisplaySpec("", kind, name, topic))

    def put(self, spec: DisplaySpec, after: str = "") -> DisplaySpec:
        """Add one with these settings and an id of its own, behind another or at the end.

        Raises:
            CommandError: There are too many.
        """
        self._check_room()
        self._given += 1
        added = replace(spec, id=f"d{self._given}")
        specs = list(self)
        ids = [one.id for one in specs]
        at = ids.index(after) + 1 if after in ids else len(specs)
        self._arrange([*specs[:at], added, *specs[at:]])
        return added

    def remove(self, display: str) -> None:
        """Take one away; `put_back` knows the last ones."""
        spec = self.get(display)
        ids = list(self._specs)
        del self._specs[display]
        self._removed[display] = _Removed(spec, tuple(ids[ids.index(display) + 1 :]))
        while len(self._removed) > DISPLAYS_MAX:
            del self._removed[next(iter(self._removed))]

    def put_back(self, display: str) -> DisplaySpec:
        """Put one back that was taken away, with its id, before those that followed it.

        Raises:
            CommandError: It was taken away too long ago, or there are too many.
        """
        self._check_room()
        removed = self._removed.pop(display, None)
        if removed is None:
            raise CommandError("This display was removed too long ago: add it again.")
        self._specs[display] = removed.spec
        behind = next((one for one in removed.behind if one in self._specs), "")
        self.move(display, behind)
        return removed.spec

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
        self.members(group)
        if shown:
            self._groups_off.discard(group)
        else:
            self._groups_off.add(group)

    def switch_all(self, *, shown: bool) -> None:
        """Show or hide each display; to be shown, no group is hidden any more."""
        for one in self:
            self._specs[one.id] = replace(one, enabled=shown)
        if shown:
            self._groups_off.clear()

    def set_entries(self, entries: Sequence[dict[str, Any]]) -> None:
        """Note what a config file says of each from now on."""
        specs = zip(self, entries, strict=True)
        self._specs = {one.id: replace(one, entry=entry) for one, entry in specs}

    def regroup(self, group: str, to: str) -> None:
        """Give a group another path; what is hidden with it or in it stays hidden.

        With an empty path, what is in it goes where the group stands now. A group that has the
        path already takes it in.

        Raises:
            CommandError: There is no such group, or it would stand in itself or too deep.
        """
        members = self.members(group)
        to = group_path(to) or group.rpartition("/")[0]
        if to == group:
            return
        if is_within(to, group):
            raise CommandError(f'The group "{group}" cannot stand in itself.')
        moved = [replace(one, group=regrouped(one.group, group, to)) for one in members]
        known = self._groups
        off = [one for one in self._groups_off & known if is_within(one, group)]
        new = {regrouped(one, group, to) for one in off} - known - {""}
        self._groups_off = (self._groups_off - set(off)) | new
        self._specs |= {one.id: one for one in moved}

    def arrange_group(self, group: str, to: str | None, before: str | None) -> None:
        """Give a group another path, or put all of it before a display; what is None stays.

        Args:
            group: Its path.
            to: As for `regroup`.
            before: Id of a display that is not in it; empty: at the end.

        Raises:
            CommandError: One of them cannot be; nothing was changed.
        """
        ids = {one.id for one in self.members(group)}
        if before and self.get(before).id in ids:
            raise CommandError("A group cannot stand before a display that is in it.")
        if to is not None:
            self.regroup(group, to)
        if before is not None:
            others = [one for one in self if one.id not in ids]
            at = others.index(self.get(before)) if before else len(others)
            moved = [one for one in self if one.id in ids]
            self._arrange([*others[:at], *moved, *others[at:]])

    def _check_room(self) -> None:
        if len(self._specs) >= DISPLAYS_MAX:
            raise CommandError(f"There are {DISPLAYS_MAX} displays: remove one first.")

    def _arrange(self, specs: list[DisplaySpec]) -> None:
        self._specs = {one.id: one for one in specs}

    def _free_name(self, wanted: str) -> str:
        taken = {one.name for one in self}
        stem = wanted.rstrip("0123456789 ") or wanted
        names = (wanted, *(f"{stem} {number}" for number in range(2, DISPLAYS_MAX + 3)))
        return next(name for name in names if name not in taken)

"""Where the parts of a robot come from, and what each text changes, as the page receives it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.description.origins.origin_values import (
    Aspect,
    PartOrigin,
    PartOriginQuery,
    SiteEffects,
    SiteEffectsQuery,
)
from studio.protocol.commands import Commands, Scope
from studio.protocol.origins import Effects, GetEffects, GetOrigin, Origin, PartEffect

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from studio.documents.model import Model
    from studio.documents.runs import Runs
    from studio.protocol.listeners import Listener
    from studio.robot.values import Robot


PARTS_KEPT: Final = 1_000
_APPEARANCE: Final = frozenset({Aspect.SIZE, Aspect.SHAPE, Aspect.COLOR, Aspect.PRESENCE})


class Origins:
    """Asks the worker, and finds in the robot which links a change moves along."""

    def __init__(self, runs: Runs, model: Model) -> None:
        self._runs, self._model = runs, model

    async def origin(self, command: GetOrigin, asker: Listener) -> Origin:
        """Return where a part comes from.

        Raises:
            CommandError: There is no such part, or it cannot be found out.
        """
        origin = await self._runs.answer(PartOriginQuery(command.part), PartOrigin, asker)
        return Origin(request=command.request, origin=origin)

    async def effects(self, command: GetEffects, asker: Listener) -> Effects:
        """Return what a text changes.

        Raises:
            CommandError: There is no such text, or it cannot be found out.
        """
        query = SiteEffectsQuery(command.site)
        found = await self._runs.answer(query, SiteEffects, asker)
        return effects_event(command.request, found, self._model.robot)


COMMANDS: Final = Commands[Origins](Scope.DOCUMENT)
COMMANDS.viewer(GetOrigin, lambda origins, c, who: origins.origin(c, who))
COMMANDS.viewer(GetEffects, lambda origins, c, who: origins.effects(c, who))


def effects_event(request: int, found: SiteEffects, robot: Robot) -> Effects:
    """Name the links that light up, and count what is shaped."""
    by_part: dict[str, dict[Aspect, None]] = {}
    for effect in found.effects:
        by_part.setdefault(effect.part, {})[effect.aspect] = None
    changed = dict.fromkeys(_changed_links(by_part, robot))
    moved = dict.fromkeys(_moved_links(by_part, robot))
    there = _there(found)
    counts = _counts({part: found for part, found in by_part.items() if part not in there})
    for aspect, links in (
        (Aspect.COLOR, _recolored_links(by_part, robot)),
        (Aspect.POSE, moved),
    ):
        counts[aspect] = sum(f"link:{link}" not in there for link in dict.fromkeys(links))
    parts = list(by_part.items())
    return Effects(
        request=request,
        site=found.site,
        parts=tuple(
            PartEffect(part=part, aspects=tuple(aspects)) for part, aspects in parts[:PARTS_KEPT]
        ),
        changed_links=tuple(changed),
        moved_links=tuple(name for name in moved if name not in changed),
        links_there=_count_of("link", there),
        joints_there=_count_of("joint", there),
        counts={aspect: count for aspect, count in counts.items() if count},
        decisions=found.decisions,
        readers=found.readers,
        is_cut=found.is_cut or len(parts) > PARTS_KEPT,
    )


def _there(found: SiteEffects) -> frozenset[str]:
    """Return links and joints whose presence depends on a text.

    Its other effects on them are left out.
    """
    return frozenset(
        effect.part
        for effect in found.effects
        if effect.aspect is Aspect.PRESENCE
        and effect.element == ""
        and effect.part.startswith(("link:", "joint:"))
    )


def _count_of(kind: str, parts: Iterable[str]) -> int:
    return sum(part.startswith(f"{kind}:") for part in parts)


def _counts(by_part: dict[str, dict[Aspect, None]]) -> dict[Aspect, int]:
    counts: dict[Aspect, int] = {}
    for aspects in by_part.values():
        for aspect in aspects:
            counts[aspect] = counts.get(aspect, 0) + 1
    return counts


def _changed_links(by_part: dict[str, dict[Aspect, None]], robot: Robot) -> Iterator[str]:
    for part, aspects in by_part.items():
        if part.startswith("link:") and _APPEARANCE & aspects.keys():
            yield _name(part)
    yield from _recolored_links(by_part, robot)


def _recolored_links(by_part: dict[str, dict[Aspect, None]], robot: Robot) -> Iterator[str]:
    """Links with a colour of their own that changes, and those that use a material that does."""
    colored = [part for part, aspects in by_part.items() if Aspect.COLOR in aspects]
    yield from (_name(part) for part in colored if part.startswith("link:"))
    materials = {_name(part) for part in colored if part.startswith("material:")}
    for link in robot.links.values():
        used = {one.material.name for one in link.visuals if one.material}
        if not used.isdisjoint(materials):
            yield link.name


def _moved_links(by_part: dict[str, dict[Aspect, None]], robot: Robot) -> Iterator[str]:
    moving = [part for part, aspects in by_part.items() if Aspect.POSE in aspects]
    yield from (_name(part) for part in moving if part.startswith("link:"))
    joints = (robot.joints.get(_name(part)) for part in moving if part.startswith("joint:"))
    yield from _with_all_below((joint.child for joint in joints if joint), robot)


def _with_all_below(links: Iterable[str], robot: Robot) -> Iterator[str]:
    children: dict[str, list[str]] = {}
    for joint in robot.joints.values():
        children.setdefault(joint.parent, []).append(joint.child)
    front, seen = list(links), set[str]()
    while front:
        link = front.pop()
        if link not in seen:
            seen.add(link)
            yield link
            front += children.get(link, ())


def _name(part: str) -> str:
    """Return the name in a part's key; of a repeated one too."""
    return part.partition(":")[2].partition("#")[0]

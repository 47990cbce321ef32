"""Robots opened in a session and asked where things come from."""

from __future__ import annotations

from typing import TYPE_CHECKING
from xml.etree import ElementTree

from studio.description.origins.origin_values import (
    OriginAttribute,
    OriginInput,
    PartOrigin,
    PartOriginQuery,
    SiteEffects,
    SiteEffectsQuery,
)
from studio.description.session import open_session
from studio.description.values import Edit, EditRequest, Expansion, OpenRequest, Site, SiteKind
from tests.support.descriptions import policy_for

if TYPE_CHECKING:
    from pathlib import Path

    from studio.description.requests import Reply

Key = tuple[str, str, str]
"""Part, path of the element in it, attribute."""


class TracedRobot:
    """A session on one file below `root`, its sites and parts as the answers told them."""

    def __init__(self, file: Path, root: Path | None = None, **arguments: str) -> None:
        policy = policy_for(root or file.parent)
        session, answer = open_session(OpenRequest(str(file), arguments, policy, {}))
        assert session is not None, answer
        self.session = session
        self.sites: dict[str, Site] = {}
        self.parts: dict[str, str] = {}
        self.take(answer)

    def take(self, answer: object) -> bool:
        """Take in an answer; whether the parts are still the same ones."""
        assert isinstance(answer, Expansion), answer
        self.sites.update((site.id, site) for site in answer.changed_sites)
        self.parts.update((part.key, part.xml) for part in answer.changed_parts)
        if answer.part_order is not None:
            self.parts = {key: self.parts[key] for key in answer.part_order}
        return answer.part_order is None

    def edit(self, file: str, start: int, end: int, new: bytes) -> bool:
        """Change a text and run; whether the parts are still the same ones."""
        return self.take(self.session.answer(EditRequest((Edit(file, start, end, new),))))

    def site(self, name: str, kind: SiteKind = SiteKind.PROPERTY) -> Site:
        """The one site of that name."""
        return next(s for s in self.sites.values() if (s.name, s.kind) == (name, kind))

    def origin(self, part: str) -> PartOrigin:
        """Where a part comes from."""
        reply = self.session.query(PartOriginQuery(part))
        assert isinstance(reply, PartOrigin), reply
        return reply

    def effects(self, site: Site) -> SiteEffects:
        """What a text shapes."""
        reply = self.session.query(SiteEffectsQuery(site.id))
        assert isinstance(reply, SiteEffects), reply
        return reply

    def ask(self, site: str) -> Reply:
        """The plain reply about any site id."""
        return self.session.query(SiteEffectsQuery(site))

    def attributes(self) -> dict[Key, str]:
        """Every attribute and text of the robot."""
        found: dict[Key, str] = {}
        for part, xml in self.parts.items():
            _collect(part, "", ElementTree.fromstring(xml), found)
        return found


def _collect(part: str, path: str, element: ElementTree.Element, found: dict[Key, str]) -> None:
    found.update(((part, path, name), value) for name, value in element.attrib.items())
    if element.text and element.text.strip():
        found[part, path, ""] = element.text.strip()
    tags = [child.tag for child in element]
    seen: dict[str, int] = {}
    for child in element:
        seen[child.tag] = seen.get(child.tag, 0) + 1
        step = f"{child.tag}[{seen[child.tag]}]" if tags.count(child.tag) > 1 else child.tag
        _collect(part, f"{path}/{step}" if path else step, child, found)


def attribute(origin: PartOrigin, element: str, name: str) -> OriginAttribute:
    """One attribute of a part."""
    return next(one for one in origin.attributes if (one.element, one.attribute) == (element, name))


def behind(origin: PartOrigin, start: OriginAttribute | OriginInput) -> list[OriginInput]:
    """All that something is made of, the nearest first, each once."""
    numbers = dict.fromkeys(start.inputs)
    front = list(numbers)
    while front:
        following = [one for at in front for one in origin.inputs[at].inputs if one not in numbers]
        numbers.update(dict.fromkeys(following))
        front = following
    return [origin.inputs[at] for at in numbers]


def way_to(origin: PartOrigin, element: str, name: str) -> list[tuple[str, str]]:
    """Kinds and names of all that is behind an attribute."""
    found = behind(origin, attribute(origin, element, name))
    return [(one.kind.value, one.name) for one in found]

"""Element: one action of an XML or YAML launch file as it is written, with its line."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from studio.launch.plan import Where


@dataclass(slots=True)
class Element:
    """A tag with its attributes, and what stands in it.

    An XML attribute is a text; YAML's may be typed. `children` are elements of any tag.
    """

    tag: str
    where: Where
    attributes: dict[str, Any] = field(default_factory=dict[str, Any])
    children: list[Element] = field(default_factory=list["Element"])
    used: set[str] = field(default_factory=set[str])

    def get(self, name: str) -> Any:
        """Return an attribute, None without; it counts as read."""
        self.used.add(name)
        return self.attributes.get(name)

    def of(self, *tags: str) -> list[Element]:
        """Return the children of these tags."""
        return [one for one in self.children if one.tag in tags]

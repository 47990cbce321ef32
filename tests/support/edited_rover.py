"""Two small files, and sources that hold them with real sites."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.description.editing.sources import Sources
from studio.description.sites.editable_texts import draft_xml, draft_yaml
from studio.description.syntax.source_tree import parse_source
from studio.description.values import Expansion, Site, Widget, WidgetKind
from studio.packages.roots import ServedRoots

if TYPE_CHECKING:
    from pathlib import Path

    from studio.description.sites.editable_texts import Draft

ROVER = """\
<robot name="rover" xmlns:xacro="http://www.ros.org/wiki/xacro">\r
  <!-- Räder -->\r
  <xacro:property name="wheel_radius" value="0.1"/>\r
  <xacro:property name="wheel_count" value='4'/>\r
  <xacro:arg name="arm" default="true"/>\r
</robot>\r
"""
LIMITS = "pan: {max: 1.50, name: 'π'}\n"


def expansion_of(*files: Path) -> Expansion:
    sites = tuple(_site(draft) for path in files for draft in _drafts(path))
    order = tuple(site.id for site in sites)
    names = tuple(str(path) for path in files)
    return Expansion("rover", (), None, (), order, sites, names, (), (), "studio")


def _drafts(path: Path) -> tuple[Draft, ...]:
    data = path.read_bytes()
    if path.suffix == ".yaml":
        return draft_yaml(str(path), data).drafts
    return draft_xml(parse_source(str(path), data)).drafts


def _site(one: Draft) -> Site:
    widget = Widget(WidgetKind.TEXT)
    return Site(one.id, one.kind, one.name, one.place, one.span, one.text, "", None, 0, widget, "")


def opened(root: Path, *files: Path) -> Sources:
    roots = ServedRoots([root])
    sources = Sources(roots.read, roots.resolve, roots.may_write, {"arm": "false"})
    sources.adopt(expansion_of(*files), 0)
    return sources


def radius(path: Path) -> str:
    return f"{path}#1@value"


def count(path: Path) -> str:
    return f"{path}#2@value"

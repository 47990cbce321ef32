"""Two small files, and sources that hold them with real sites."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.description.editing.sources import Sources
from studio.description.sites.file_sites import xml_sites, yaml_sites
from studio.description.syntax.source_tree import parse_source
from studio.description.values import Expansion, Site, Widget, WidgetKind
from studio.packages.roots import ServedRoots

if TYPE_CHECKING:
    from pathlib import Path

    from studio.description.sites.file_sites import FileSite

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
    sites = tuple(_site(site) for path in files for site in _drafts(path))
    order = tuple(site.id for site in sites)
    names = tuple(str(path) for path in files)
    return Expansion("rover", (), None, (), order, sites, names, (), (), "studio")


def _drafts(path: Path) -> tuple[FileSite, ...]:
    data = path.read_bytes()
    if path.suffix == ".yaml":
        return yaml_sites(str(path), data).sites
    return xml_sites(parse_source(str(path), data)).sites


def _site(one: FileSite) -> Site:
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

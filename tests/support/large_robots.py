"""Robots of as many parts as are asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

_XACRO = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
_BOX = '<visual><geometry><box size="0.1 0.1 0.1"/></geometry></visual>'
_LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'


def robot_of_links(folder: Path, count: int) -> Path:
    """A URDF of the boxes l0, l1, ..., all joined to l0 by j1, j2, ..."""
    links = "".join(f'<link name="l{number}">{_BOX}</link>\n' for number in range(count))
    joints = "".join(
        f'<joint name="j{number}" type="revolute"><parent link="l0"/><child link="l{number}"/>'
        f'<origin xyz="{number % 100} {number // 100} 0"/><axis xyz="0 0 1"/>{_LIMIT}</joint>\n'
        for number in range(1, count)
    )
    path = folder / "many.urdf"
    path.write_text(f'<robot name="many">\n{links}{joints}</robot>\n')
    return path


def robot_of_includes(folder: Path, count: int) -> Path:
    """A xacro of a base and as many included files, each with a property and a link."""
    parts = folder / "parts"
    parts.mkdir()
    for number in range(count):
        (parts / f"part_{number}.xacro").write_text(
            f'<robot {_XACRO}><xacro:property name="size_{number}" value="0.1"/>\n'
            f'<link name="l{number}"><visual><geometry><sphere radius="${{size_{number}}}"/>'
            f'</geometry></visual></link>\n<joint name="j{number}" type="fixed">'
            f'<parent link="base"/><child link="l{number}"/></joint></robot>\n'
        )
    includes = "\n".join(
        f'<xacro:include filename="parts/part_{number}.xacro"/>' for number in range(count)
    )
    path = folder / "many.urdf.xacro"
    path.write_text(f'<robot name="many" {_XACRO}>\n<link name="base"/>\n{includes}\n</robot>\n')
    return path

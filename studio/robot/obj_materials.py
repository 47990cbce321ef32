"""MTL libraries to looks: diffuse colour, opacity and diffuse texture."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

from studio.robot.surfaces import Look
from studio.robot.textures import read_texture

if TYPE_CHECKING:
    from studio.robot.mesh_files import MeshFiles

_LEAST_OPACITY = 0.05
"""Some exporters write `Tr` upside down: what would be invisible is drawn opaque."""


def read_materials(data: bytes, files: MeshFiles) -> dict[str, Look | None]:
    """Looks by material name; None for a material that says nothing about colour.

    Raises:
        ValueError: A number of it is none.
    """
    looks: dict[str, Look | None] = {}
    name = ""
    for line in data.decode("utf-8", "replace").splitlines():
        key, _, rest = line.strip().partition(" ")
        if key == "newmtl":
            name = rest.strip()
            looks[name] = None
        elif key.lower() in {"kd", "d", "tr", "map_kd"} and rest.strip():
            looks[name] = _with(looks.get(name), key.lower(), rest.strip(), files)
    return looks


def _with(look: Look | None, key: str, rest: str, files: MeshFiles) -> Look:
    known = look or Look()
    red, green, blue, alpha = known.rgba
    match key:
        case "kd" if known.texture is None:
            red, green, blue = (min(1.0, max(0.0, float(one))) for one in _three(rest))
        case "d" | "tr":
            value = float(rest.rsplit(maxsplit=1)[-1])
            opacity = value if key == "d" else 1.0 - value
            alpha = min(1.0, opacity) if opacity >= _LEAST_OPACITY else 1.0
        case "map_kd":
            texture = read_texture(files, _file_name(rest))
            if texture is not None:  # readers agree that the texture replaces the colour
                return dataclasses.replace(known, rgba=(1.0, 1.0, 1.0, alpha), texture=texture)
        case _:
            pass
    return dataclasses.replace(known, rgba=(red, green, blue, alpha))


def _three(rest: str) -> list[str]:
    words = rest.split()
    return words[:3] if len(words) >= 3 else [words[0]] * 3


def _file_name(rest: str) -> str:
    """The name behind options such as `-s 1 1 1`; a name may hold blanks, options start with -."""
    if not rest.startswith("-"):
        return rest
    return rest.rsplit(maxsplit=1)[-1]

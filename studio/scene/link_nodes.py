"""Links of other robots as nodes: the same layers as those of the document's own robot."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Final

from studio.scene.layers import LAYERS, LinkContext

if TYPE_CHECKING:
    from studio.displays.drawing import LinkParts
    from studio.scene.geometry_drawing import MeshShelf
    from studio.scene.node import Node

_GROUPS: Final = frozenset({"visual", "collision"})


def link_nodes(shape: LinkParts, shelf: MeshShelf) -> dict[str, Node]:
    """All that is shown of a link, flat: meshes that have not come yet are left out."""
    context = LinkContext(shape.link, None, shape.robot, shelf)
    shown = {
        "visual": shape.visual,
        "collision": shape.collision,
        "com": shape.mass,
        "inertia": shape.inertia,
    }
    nodes: dict[str, Node] = {}
    for layer in (name for name, is_shown in shown.items() if is_shown):
        for below, drawn in LAYERS[layer](context).items():
            if below not in _GROUPS:
                nodes[below.replace("/", "-")] = _faded(drawn, shape.opacity)
    return nodes


def _faded(drawn: Node, opacity: float) -> Node:
    """As opaque as its material, times this; the page fades a mesh with materials of its own."""
    if "opacity" not in drawn.props:
        return replace(drawn, props={**drawn.props, "studio_opacity": opacity})
    own = drawn.props["opacity"]
    both = opacity if own is None else own * opacity
    return replace(drawn, props={**drawn.props, "opacity": None if both >= 1.0 else both})

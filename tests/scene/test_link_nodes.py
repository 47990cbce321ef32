from __future__ import annotations

import pytest

from studio.displays.drawing import LinkParts
from studio.robot.urdf_text import robot_from_urdf
from studio.scene.link_nodes import MeshShelf, link_nodes
from tests.support.watched_scene import triangle

ROBOT = robot_from_urdf(
    """<robot name="r"><material name="glass"><color rgba="0 0 1 0.5"/></material>
    <link name="l">
      <inertial><mass value="2"/>
        <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
      <visual><geometry><box size="1 2 3"/></geometry><material name="glass"/></visual>
      <visual><geometry><mesh filename="package://p/a.dae"/></geometry></visual>
      <collision><geometry><sphere radius="1"/></geometry></collision>
    </link></robot>"""
)
LINK = ROBOT.links["l"]
URI = "package://p/a.dae"


def test_what_is_switched_on_becomes_nodes_below_the_link():
    shelf = MeshShelf()
    assert link_nodes(LinkParts(LINK, ROBOT), shelf).keys() == {"visual-0"}
    shelf.put(URI, triangle())
    every = LinkParts(LINK, ROBOT, visual=True, collision=True, mass=True, inertia=True)
    assert link_nodes(every, shelf).keys() == {
        "visual-0", "visual-1", "collision-0", "com", "inertia",
    }  # fmt: skip
    assert link_nodes(LinkParts(LINK, ROBOT, visual=False), shelf) == {}


def test_the_opacity_is_that_of_the_material_times_that_of_the_display():
    [box] = link_nodes(LinkParts(LINK, ROBOT, opacity=0.5), MeshShelf()).values()
    assert box.props["color"] == (0, 0, 255)
    assert box.props["opacity"] == pytest.approx(0.25)


@pytest.mark.parametrize("opacity", [1.0, 0.3])
def test_a_mesh_with_materials_of_its_own_is_faded_by_the_page(opacity: float):
    shelf = MeshShelf()
    shelf.put(URI, triangle(glb=b"glTF"))
    nodes = link_nodes(LinkParts(LINK, ROBOT, opacity=opacity), shelf)
    assert nodes["visual-1"].props["studio_opacity"] == opacity


def test_a_mesh_that_cannot_be_loaded_leaves_a_sign():
    shelf = MeshShelf()
    shelf.put(URI, None)
    assert link_nodes(LinkParts(LINK, ROBOT), shelf)["visual-1"].props["wireframe"]

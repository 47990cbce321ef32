"""The names in xacro and URDF: elements and their content, attributes and their values.

The tables are for offering and recognising names; the evaluator decides what a file may contain.
"""

from __future__ import annotations

from typing import Final

XACRO_TAGS: Final[dict[str, tuple[tuple[str, ...], tuple[str, ...]]]] = {
    "property": (("name", "value"), ("default", "scope", "lazy_eval", "remove")),
    "arg": (("name", "default"), ()),
    "macro": (("name", "params"), ()),
    "include": (("filename",), ("ns", "optional")),
    "if": (("value",), ()),
    "unless": (("value",), ()),
    "insert_block": (("name",), ()),
    "call": (("macro",), ()),
    "element": (("xacro:name",), ()),
    "attribute": (("name", "value"), ()),
}
"""Tags of xacro itself: attributes that they need, and those that they may have."""
XACRO_WITH_CONTENT: Final = frozenset({"macro", "if", "unless", "element"})

_BOOLEANS: Final = ("true", "false")
XACRO_VALUES: Final[dict[tuple[str, str], tuple[str, ...]]] = {
    ("property", "scope"): ("parent", "global"),
    ("property", "lazy_eval"): _BOOLEANS,
    ("property", "remove"): _BOOLEANS,
    ("include", "optional"): _BOOLEANS,
}

ELEMENTS: Final[dict[str, tuple[str, ...]]] = {
    "robot": ("link", "joint", "material", "gazebo", "transmission", "ros2_control"),
    "link": ("visual", "collision", "inertial"),
    "visual": ("origin", "geometry", "material"),
    "collision": ("origin", "geometry"),
    "inertial": ("origin", "mass", "inertia"),
    "geometry": ("box", "cylinder", "sphere", "capsule", "mesh"),
    "material": ("color", "texture"),
    "joint": (
        "parent",
        "child",
        "origin",
        "axis",
        "limit",
        "dynamics",
        "mimic",
        "safety_controller",
        "calibration",
    ),
    "transmission": ("type", "joint", "actuator"),
    "ros2_control": ("hardware", "joint", "sensor", "gpio"),
    "hardware": ("plugin", "param"),
    "gazebo": ("plugin", "sensor", "material"),
}
"""Elements allowed in each element of URDF."""

ATTRIBUTES: Final[dict[str, tuple[str, ...]]] = {
    "robot": ("name", "version", "xmlns:xacro"),
    "link": ("name",),
    "joint": ("name", "type"),
    "visual": ("name",),
    "collision": ("name",),
    "origin": ("xyz", "rpy"),
    "mass": ("value",),
    "inertia": ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"),
    "box": ("size",),
    "cylinder": ("radius", "length"),
    "capsule": ("radius", "length"),
    "sphere": ("radius",),
    "mesh": ("filename", "scale"),
    "material": ("name",),
    "color": ("rgba",),
    "texture": ("filename",),
    "parent": ("link",),
    "child": ("link",),
    "axis": ("xyz",),
    "limit": ("lower", "upper", "effort", "velocity"),
    "dynamics": ("damping", "friction"),
    "mimic": ("joint", "multiplier", "offset"),
    "safety_controller": ("k_velocity", "k_position", "soft_lower_limit", "soft_upper_limit"),
    "calibration": ("rising", "falling"),
    "gazebo": ("reference",),
    "transmission": ("name",),
    "actuator": ("name",),
    "ros2_control": ("name", "type"),
    "plugin": ("name", "filename"),
    "param": ("name",),
}
"""Attributes of each element of URDF, those that are needed or common first."""

WRITTEN_WITH: Final[dict[str, tuple[str, ...]]] = {
    "link": ("name",),
    "joint": ("name", "type"),
    "origin": ("xyz", "rpy"),
    "mass": ("value",),
    "inertia": ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"),
    "box": ("size",),
    "cylinder": ("radius", "length"),
    "capsule": ("radius", "length"),
    "sphere": ("radius",),
    "mesh": ("filename",),
    "material": ("name",),
    "color": ("rgba",),
    "texture": ("filename",),
    "parent": ("link",),
    "child": ("link",),
    "axis": ("xyz",),
    "limit": ("lower", "upper", "effort", "velocity"),
    "dynamics": ("damping", "friction"),
    "mimic": ("joint",),
    "gazebo": ("reference",),
    "transmission": ("name",),
    "ros2_control": ("name", "type"),
}
"""Attributes that a new element is written with."""
WITH_CONTENT: Final = frozenset(ELEMENTS) - {"material"}

VALUES: Final[dict[tuple[str, str], tuple[str, ...]]] = {
    ("joint", "type"): (
        "revolute",
        "continuous",
        "prismatic",
        "fixed",
        "floating",
        "planar",
    ),
    ("ros2_control", "type"): ("system", "actuator", "sensor"),
    ("axis", "xyz"): ("1 0 0", "0 1 0", "0 0 1"),
    ("origin", "xyz"): ("0 0 0",),
    ("origin", "rpy"): ("0 0 0",),
}

PART_REFERENCES: Final[dict[tuple[str, str], str]] = {
    ("parent", "link"): "link",
    ("child", "link"): "link",
    ("mimic", "joint"): "joint",
    ("gazebo", "reference"): "link",
}
"""Attributes that name a link or joint of the robot."""

FILE_ATTRIBUTES: Final[dict[tuple[str, str], tuple[str, ...]]] = {
    ("xacro:include", "filename"): (".xacro", ".urdf", ".xml"),
    ("mesh", "filename"): (".stl", ".dae", ".obj", ".glb", ".gltf", ".ply"),
    ("texture", "filename"): (".png", ".jpg", ".jpeg", ".tif", ".tga", ".bmp"),
}
"""Attributes that name a file, and the endings that it has."""

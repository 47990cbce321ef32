"""What `.rviz` files call displays and their properties, where that differs from the names here."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.displays.catalogue import DISPLAYS
from studio.rviz.config_values import path_of, text_at

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.displays.properties import Value
    from studio.rviz.config_text import Tree
    from studio.rviz.config_values import Entry, Path


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


OURS: Final = "Studio"
"""Below it stands what would mean something else to RViz under its own name."""
GROUPS: Final = frozenset({"rviz_common/Group", "rviz/Group"})
RVIZ1: Final = "rviz"
"""The package of all classes of RViz 1."""
_IMU: Final = "rviz_imu_plugin"
_RVIZ2: Final = "rviz_default_plugins"
_PACKAGES: Final = frozenset({RVIZ1, _RVIZ2, "rviz_common", _IMU, "studio"})
_BY_KIND: Final = {one.KIND: one for one in DISPLAYS}
_MOVEIT: Final = {"moveit_rviz_plugin/Trajectory": "DisplayTrajectory"}
"""Displays of MoveIt that are here under the name of their message."""
_RVIZ1_KINDS: Final = {"WrenchStamped": "Wrench"}
_RVIZ2_KINDS: Final = _words(
    "AccelStamped Axes Camera DepthCloud Effort FluidPressure Grid GridCells Illuminance Image"
    " InteractiveMarkers LaserScan Map Marker MarkerArray Odometry Path PointCloud PointCloud2"
    " PointStamped Polygon Pose PoseArray PoseWithCovariance Range RelativeHumidity RobotModel"
    " Temperature TF TwistStamped Wrench"
)

_TOPIC: Final = {
    "DepthCloud": "Depth Map Topic",
    "DisplayTrajectory": "Trajectory Topic",
    "RobotModel": "Description Topic",
}
"""Where kinds have their topic that have no `Topic`."""
_RVIZ1_TOPIC: Final = {
    "Camera": "Image Topic",
    "Image": "Image Topic",
    "InteractiveMarkers": "Update Topic",
    "Marker": "Marker Topic",
    "MarkerArray": "Marker Topic",
    "RobotModel": "Robot Description",
}
_WITHOUT_QOS: Final = frozenset({"DepthCloud", "DisplayTrajectory", "InteractiveMarkers"})
"""Kinds whose topic has no QoS below it in RViz2."""
PLUGINS: Final = "plugins/"
"""Before the kinds of the owner's own displays, whose properties only their files know."""
UPDATE_TOPIC: Final = ("Update Topic", "Value")
"""Of a Map: always its topic and this."""
UPDATES: Final = "_updates"

_PLACES: Final[Mapping[tuple[str, str], Path]] = {
    ("Grid", "Line Width"): ("Line Style", "Line Width"),
    ("TF", "Frames"): ("Frames", "All Enabled"),
    ("Marker", "Namespaces"): (OURS, "Namespaces"),
    ("MarkerArray", "Namespaces"): (OURS, "Namespaces"),
}
LISTS: Final = {
    "Camera": "Visibility",
    "RobotModel": "Links",
    "TF": "Frames",
    "Marker": "Namespaces",
    "MarkerArray": "Namespaces",
}
"""Where kinds have a property for each name that messages bring."""
LINK_PARTS: Final = ("Alpha", "Show Axes", "Show Trail")
"""What can be set of each link."""
JOINT_AXIS: Final = "Show Joint Axis"
JOINT_PARTS: Final = ("Show Axes", JOINT_AXIS)
"""What can be set of each joint: RViz lists joints among the links."""
JOINTS: Final = "Joints"

_OURS_ONLY: Final = frozenset({
    ("Axes", "Alpha"), ("Camera", "Max Value"), ("Camera", "Median window"),
    ("Camera", "Min Value"), ("Camera", "Normalize Range"), ("Image", "Alpha"),
    ("Image", "Far clip"), ("Image", "Edge color"),
    ("TF", "Marker Alpha"), ("TF", "Name Height"), ("TF", "Show Ages"), ("TF", "Trails"),
    ("TF", "Trail Time"), ("Marker", "Namespaces"),
    ("MarkerArray", "Namespaces"), ("RobotModel", "Description Node"),
    ("RobotModel", "Description Parameter"),
})  # fmt: skip
_OURS_OF_ALL: Final = frozenset({"Points at most", "Color Map"})
"""RViz has no such properties; they are written only where they differ from their defaults."""

_CLOUD: Final[Entry] = {"Selectable": "true", "Use Fixed Frame": "true"}
_LINKS: Final[Entry] = {
    "All Links Enabled": "true",
    "Expand Joint Details": "false",
    "Expand Link Details": "false",
    "Expand Tree": "false",
    "Link Tree Style": "Links in Alphabetic Order",
}
FILTER_SIZE: Final = "Filter size"
_UNFILTERED: Final = _words(
    "Camera DepthCloud FluidPressure GridCells Illuminance Image InteractiveMarkers Marker"
    " MarkerArray Pose Range RelativeHumidity RobotModel Temperature"
)
"""Kinds whose topics have no queue of messages that wait for their transforms."""


def topic_block(topic: str, *, filtered: bool) -> Entry:
    """Return a topic with RViz2's first QoS."""
    size: Entry = {FILTER_SIZE: "10"} if filtered else {}
    return {
        "Depth": "5",
        "Durability Policy": "Volatile",
        **size,
        "History Policy": "Keep Last",
        "Reliability Policy": "Reliable",
        "Value": topic,
    }


_MORE: Final[Mapping[str, Entry]] = {
    "DepthCloud": {**_CLOUD, "Topic Filter": "true"},
    "Effort": {"Joints": {}, "Robot Description": "/robot_description"},
    "FluidPressure": _CLOUD,
    "Illuminance": _CLOUD,
    "LaserScan": _CLOUD,
    "Map": {"Update Topic": topic_block('""', filtered=False)},
    "Marker": {"Namespaces": {}},
    "MarkerArray": {"Namespaces": {}},
    "PointCloud": _CLOUD,
    "PointCloud2": _CLOUD,
    "RelativeHumidity": _CLOUD,
    "RobotModel": {"Links": _LINKS},
    "TF": {"Tree": {}},
    "Temperature": _CLOUD,
}
"""Properties of RViz2 that have no counterpart here, with their first values."""


def more_of(kind: str) -> Entry:
    """Return RViz2's properties of a kind that have no counterpart here, with their first values.

    The topic is among them, if it has one.
    """
    display = _BY_KIND.get(kind)
    if display is None or not display.TOPICS:
        return dict(_MORE.get(kind, {}))
    block = topic_block('""', filtered=kind not in _UNFILTERED)
    topic: Tree = '""' if kind in _WITHOUT_QOS else block
    return {**_MORE.get(kind, {}), topic_key(kind): topic}


def missing_of(entry: Entry, kind: str) -> Mapping[str, Value]:
    """Return what properties are in RViz2 while an entry of a file lacks them, unlike here."""
    if not text_at(entry, "Class").startswith(f"{RVIZ1}/"):
        return _MISSING.get(kind, {})
    # RViz 1 names a topic where RViz2 has the namespace.
    topic = text_at(entry, topic_key(kind, rviz1=True)).strip()
    return _BY_KIND[kind].settings_for(topic) if topic.isprintable() else {}


_MISSING: Final[Mapping[str, Mapping[str, Value]]] = {"TF": {"Show Names": False}}


def kind_of(class_name: str) -> str:
    """Return the kind of a class, or the whole class, with a slash in it, where there is none."""
    if (moveit := _MOVEIT.get(class_name)) in _BY_KIND:
        return str(moveit)
    package, slash, name = class_name.partition("/")
    name = _RVIZ1_KINDS.get(name, name)
    known = package in _PACKAGES and name in _BY_KIND
    return name if known else class_name if slash else f"unknown/{class_name}"


def class_in_rviz2(class_name: str) -> str:
    """Return RViz2's name of a class of RViz 1; another stays as it is."""
    package, _, name = class_name.partition("/")
    if package != RVIZ1:
        return class_name
    name = _RVIZ1_KINDS.get(name, name)
    return f"{'rviz_common' if name in _OF_RVIZ_COMMON else _RVIZ2}/{name}"


_OF_RVIZ_COMMON: Final = frozenset({
    "Displays", "Group", "Help", "Selection", "Time", "Tool Properties", "Views"
})  # fmt: skip


def class_of(kind: str) -> str:
    """Return RViz2's class of a kind; one that RViz2 lacks is of a package of ours."""
    if kind == "Imu":
        return f"{_IMU}/Imu"
    if moveit := next((one for one, own in _MOVEIT.items() if own == kind), None):
        return moveit
    return f"{_RVIZ2 if kind in _RVIZ2_KINDS else 'studio'}/{kind}"


def is_ours(kind: str, name: str) -> bool:
    """Whether RViz2 has no such property."""
    return name in _OURS_OF_ALL or (kind, name) in _OURS_ONLY


def topic_key(kind: str, *, rviz1: bool = False) -> str:
    """Return where a kind has its topic."""
    of_kind = _RVIZ1_TOPIC if rviz1 else _TOPIC
    return of_kind.get(kind, "Topic")


def place_of(kind: str, name: str) -> Path:
    """Return where a property stands in the entry of its display."""
    if place := _PLACES.get((kind, name)):
        return place
    group = LISTS.get(kind, "")
    if kind == "RobotModel" and name.startswith(f"{JOINTS}/"):
        joint, _, part = name.removeprefix(f"{JOINTS}/").rpartition("/")
        return (group, joint, part)
    if not group or not name.startswith(f"{group}/"):
        return path_of(name)
    inner = name.removeprefix(f"{group}/")
    if group == "Links":
        link, slash, part = inner.rpartition("/")
        if slash and part in LINK_PARTS:
            return (group, link, part)
    return (group, inner)

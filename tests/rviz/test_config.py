"""`.rviz` files as values: what is taken, what is kept, and what is written."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from studio.displays.catalogue import DISPLAYS, display_of_kind
from studio.errors import DisplayError, RvizConfigError
from studio.rviz.config import DISPLAYS_MAX, RvizConfig, for_rviz2, read_config, write_config
from studio.rviz.config_displays import ConfigDisplay, Loss, read_display, write_display
from studio.rviz.config_text import read_tree, write_tree
from studio.rviz.config_values import Entry, entries_at, entry_at, leaves, text_at
from studio.rviz.tools import ToolSpec, default_tools
from studio.rviz.views import VIEW_KINDS, ViewSpec
from tests.support.corpus import corpus
from tests.support.rviz_losses import LOSSES, listed

if TYPE_CHECKING:
    from studio.displays.properties import Property, Value

RVIZ2 = Path(__file__).parent / "rviz2_displays.yaml"
"""A new display of each kind as RViz2 saves it, by its sources."""


def config(displays: str = "[]", more: str = "") -> str:
    return f"Visualization Manager:\n  Displays: {displays}\n{more}"


def display(**entry: Any) -> tuple[ConfigDisplay, list[Loss]]:  # noqa: ANN401 - YAML
    found = read_tree(yaml.safe_dump(entry))
    assert isinstance(found, dict)
    return read_display(found)


@pytest.mark.corpus
def test_every_file_of_the_corpus_opens_with_its_losses_listed_and_is_written_as_it_was():
    for file in sorted(corpus().rglob("*.rviz")):
        text = file.read_text()
        assert write_config(read_config(text)[0]) == text, file
    found = listed()
    assert len(found) == 57
    assert found == json.loads(LOSSES.read_text())


def test_a_server_of_interactive_markers_is_named_by_its_topic_in_rviz_1():
    topic = {"Update Topic": "/arm/update", "Name": "Arm", "Enabled": True, "Value": True}
    read, losses = display(Class="rviz/InteractiveMarkers", **topic)
    assert dict(read.values) == {"Interactive Markers Namespace": "/arm"}
    assert (read.topic, losses) == ("", [])
    assert yaml.safe_load(write_tree(write_display(read))) == {
        "Class": "rviz/InteractiveMarkers",
        **topic,
    }


@pytest.mark.corpus
@pytest.mark.parametrize("every", [8, pytest.param(1, marks=pytest.mark.sweep)])
def test_after_one_edit_only_that_is_otherwise_in_every_file_of_the_corpus(every: int):
    for file in sorted(corpus().rglob("*.rviz"))[::every]:
        text = file.read_text()
        read, _ = read_config(text)
        at = next((n for n, one in enumerate(read.displays) if one.kind == "Grid"), None)
        if at is None:
            continue
        grid = read.displays[at]
        changed = replace(grid, values={**grid.values, "Alpha": 0.875})
        displays = (*read.displays[:at], changed, *read.displays[at + 1 :])
        written = write_config(replace(read, displays=displays))
        before, after = yaml.safe_load(text), yaml.safe_load(written)
        _first_grid(before["Visualization Manager"])["Alpha"] = 0.875
        assert after == before, file


def _first_grid(tree: Any) -> dict[str, Any]:  # noqa: ANN401 - YAML
    for one in tree["Displays"]:
        if one["Class"].endswith("/Grid"):
            return one
        if "Displays" in one and (found := _first_grid(one)):
            return found
    return {}


def test_a_new_display_of_each_kind_is_written_with_all_that_rviz2_writes():
    expected = {one["Class"]: one for one in yaml.safe_load(RVIZ2.read_text())}
    for kind in DISPLAYS:
        entry = write_display(ConfigDisplay(kind.KIND, kind.KIND))
        name = text_at(entry, "Class")
        if name.startswith(("studio/", "moveit_rviz_plugin/")):
            continue  # RViz2 itself has none
        assert yaml.safe_load(write_tree(entry)) == expected.pop(name), name
        read, losses = read_display(entry)
        assert read.values == {}, name
        assert not [one for one in losses if one.reason != "no_property"]
    known = {one.KIND for one in DISPLAYS}
    assert not [name for name in expected if name.partition("/")[2] in known]


def test_new_tools_and_views_are_written_with_all_that_rviz2_writes():
    views = tuple(ViewSpec(kind, "Mine") for kind in VIEW_KINDS)
    made = RvizConfig(tools=default_tools(), views=views)
    manager = yaml.safe_load(write_config(made))["Visualization Manager"]
    for written, file in ((manager["Tools"], "tools"), (manager["Views"]["Saved"], "views")):
        expected = yaml.safe_load(RVIZ2.with_name(f"rviz2_{file}.yaml").read_text())
        by_class = {one["Class"]: one for one in expected}
        assert {one["Class"]: one for one in written} == by_class
    read, losses = read_config(write_config(made))
    assert [dict(one.values) for one in (*read.tools, *read.views)] == [{}] * 14
    assert {one.names for one in losses if "/" in one.what} == {("Enable Stereo Rendering",)}


@pytest.mark.corpus
def test_rviz2_itself_wrote_no_other_properties_than_we_write():
    """Those that its later versions added are missing in some files."""
    more: Counter[str] = Counter()
    for file in sorted(corpus().rglob("*.rviz")):
        tree = read_tree(file.read_text())
        for entry in _all_displays(entry_at(tree, "Visualization Manager")):
            class_name = text_at(entry, "Class")
            if not class_name.startswith("rviz_default_plugins/"):
                continue
            kind = class_name.partition("/")[2]
            if kind not in {one.KIND for one in DISPLAYS}:
                continue
            ours = {path for path, _ in leaves(write_display(ConfigDisplay(kind, kind)))}
            theirs = {path for path, _ in leaves(entry)}
            lists = {"Links", "Frames", "Namespaces", "Tree", "Visibility"}
            more.update(
                f"{kind}: {'/'.join(path)}" for path in theirs - ours if path[0] not in lists
            )
    assert not more


def _all_displays(entry: Entry) -> list[Entry]:
    found: list[Entry] = []
    for one in entries_at(entry, "Displays"):
        found += _all_displays(one) if entries_at(one, "Displays") else [one]
    return found


@pytest.mark.parametrize("kind", [one.KIND for one in DISPLAYS])
def test_every_property_of_a_display_comes_back_from_the_file(kind: str):
    made = display_of_kind(kind)
    values: dict[str, Any] = {}
    for one in made.PROPERTIES:
        if one.kind == "switch":
            values[one.name] = not one.default
        elif one.kind == "colour":
            values[one.name] = "#0a141e"
        elif one.kind == "choice":
            values[one.name] = one.choices[-1]
        elif one.kind in ("whole", "number"):
            wished = one.checked(float(one.default) + 1)
            values[one.name] = wished if wished != one.default else one.checked(0.25)
        else:
            values[one.name] = text_for(one)
    differing = {
        one.name: values[one.name] for one in made.PROPERTIES if values[one.name] != one.default
    }
    wished = ConfigDisplay(
        kind, "Mine", False, "", "/topic" if made.TOPICS else "", values=differing
    )
    read, _ = read_display(write_display(wished))
    assert dict(read.values) == differing
    assert (read.name, read.enabled, read.topic) == (wished.name, False, wished.topic)


def text_for(one: Property) -> Value:
    """A text that has to be quoted, where the property takes any."""
    try:
        return one.checked("some text: 1")
    except DisplayError:
        return one.default


def test_a_topic_and_its_qos_are_read_and_only_what_changes_is_written():
    topic = {
        "Depth": 1, "Durability Policy": "Transient Local", "Filter size": 10,
        "History Policy": "Keep Last", "Reliability Policy": "Best Effort", "Value": "map",
    }  # fmt: skip
    updates = {**topic, "Value": "/map_updates"}
    read, losses = display(
        Class="rviz_default_plugins/Map", Name="Map", Value=True,
        Topic=topic, **{"Update Topic": updates},
    )  # fmt: skip
    assert (read.topic, read.reliable, read.latched, read.depth) == ("/map", False, True, 1)
    assert [one.names for one in losses] == [("Topic/Filter size",)]
    moved = replace(read, topic="/other", reliable=None)
    written = yaml.safe_load(write_tree(write_display(moved)))
    assert written["Topic"] == {**topic, "Value": "/other", "Reliability Policy": "Reliable"}
    assert written["Update Topic"] == {**updates, "Value": "/other_updates"}


def test_what_a_topic_says_of_its_qos_and_is_not_taken_is_listed_and_kept():
    topic = {
        "Depth": "many", "Durability Policy": "System Default", "History Policy": "Keep All",
        "Reliability Policy": "System Default", "Deadline": 3, "Value": "/scan",
    }  # fmt: skip
    class_name = "rviz_default_plugins/LaserScan"
    entry = {"Class": class_name, "Name": "Scan", "Topic": topic}
    read, losses = display(**entry)
    policies = ("Depth", "Durability Policy", "History Policy", "Reliability Policy")
    assert losses == [
        Loss("no_value", class_name, tuple(f"Topic/{one}" for one in policies)),
        Loss("no_property", class_name, ("Topic/Deadline",)),
    ]
    assert yaml.safe_load(write_tree(write_display(read))) == entry
    broken, losses = display(**entry | {"Topic": {**topic, "Value": "a\nb"}})
    assert broken.topic == ""
    assert losses[0].names[0] == "Topic"


def test_settings_of_panels_that_are_not_rvizs_first_are_listed():
    panels = """Panels:
  - {Class: rviz_common/Time, Name: Time, Experimental: false, SyncMode: 0, SyncSource: ""}
  - {Class: rviz_common/Time, Name: Time, SyncMode: 1, SyncSource: LaserScan}
  - {Class: rviz_common/Views, Name: Views, Expanded: [/Current View1], Splitter Ratio: 0.5}
  - {Class: rviz/Displays, Name: Displays, Help Height: 78, Filter: "a"}
  - {Class: rviz_common/Unheard, Name: Unheard}
"""
    _, losses = read_config(panels + config())
    assert losses == (
        Loss("no_property", "rviz_common/Time", ("SyncMode", "SyncSource")),
        Loss("no_property", "rviz/Displays", ("Filter",)),
        Loss("no_panel", "rviz_common/Unheard"),
    )


def test_displays_of_rviz_1_are_understood_and_keep_its_names():
    read, losses = display(
        Class="rviz/MarkerArray", Enabled=True, Name="Marks",
        Namespaces={"0": True, "on": False, "a/b": False}, Value=True,
        **{"Marker Topic": "marks", "Queue Size": 100},
    )  # fmt: skip
    assert (read.kind, read.topic) == ("MarkerArray", "/marks")
    assert dict(read.values) == {"Namespaces/on": False, "Namespaces/a/b": False}
    assert losses == [Loss("no_property", "rviz/MarkerArray", ("Queue Size",))]
    moved = replace(read, topic="/other", values={"Namespaces/0": False})
    written = yaml.safe_load(write_tree(write_display(moved)))
    assert written["Marker Topic"] == "/other"
    assert written["Namespaces"] == {"0": False, "on": True, "a/b": True}


def test_links_and_frames_are_read_by_their_names():
    robot, _ = display(
        Class="rviz_default_plugins/RobotModel", Name="Robot", Value=True,
        Links={
            "All Links Enabled": True, "Expand Tree": False,
            "base": {"Alpha": 0.5, "Show Axes": False, "Show Trail": False},
            "arm": {"Alpha": 1, "Show Axes": True, "Value": False},
        },
        **{"Description Topic": {"Value": "robot_description", "Depth": 5}},
    )  # fmt: skip
    assert robot.topic == "/robot_description"
    assert dict(robot.values) == {
        "Links/base/Alpha": 0.5, "Links/arm": False, "Links/arm/Show Axes": True,
    }  # fmt: skip
    frames, _ = display(
        Class="rviz_default_plugins/TF", Name="TF", Value=True,
        Frames={"All Enabled": False, "odom": {"Value": True}, "map": {"Value": False}},
    )  # fmt: skip
    assert dict(frames.values) == {"Show Names": False, "Frames": False, "Frames/odom": True}


def test_what_is_set_of_a_joint_stands_among_the_links_as_in_rviz2():
    joint = {"Show Axes": False, "Show Joint Axis": True, "Value": True}
    links = {"All Links Enabled": True, "Link Tree Style": "Joints in Alphabetic Order"}
    entry: dict[str, Any] = {
        "Class": "rviz_default_plugins/RobotModel", "Name": "Robot", "Value": True,
        "Links": {**links, "elbow/pan": joint, "wrist": {**joint, "Show Joint Axis": False}},
    }  # fmt: skip
    read, losses = display(**entry)
    assert losses == []
    assert dict(read.values) == {"Joints/elbow/pan/Show Joint Axis": True}
    assert yaml.safe_load(write_tree(write_display(read))) == entry
    turned = replace(read, values={"Joints/wrist/Show Joint Axis": True})
    written = yaml.safe_load(write_tree(write_display(turned)))["Links"]
    assert [written[one]["Show Joint Axis"] for one in ("elbow/pan", "wrist")] == [False, True]
    entry["Links"]["wrist"]["Value"] = False
    assert display(**entry)[1] == [Loss("no_property", entry["Class"], ("Links/Value",))]


@pytest.mark.parametrize("part", ["Show Axes", "Show Joint Axis"])
def test_a_joint_that_is_new_in_a_file_is_found_again(part: str):
    fresh = ConfigDisplay("RobotModel", "Robot", values={f"Joints/elbow/{part}": True})
    written = write_display(fresh)
    assert text_at(written, "Links", "elbow", part) == "true"
    assert read_display(written)[0].values == fresh.values


def test_a_robot_that_rviz_cannot_name_is_found_again():
    wished = ConfigDisplay("RobotModel", "Robot", values={"Description Source": "Document"})
    written = write_display(wished)
    assert text_at(written, "Description Source") == "Topic"
    assert read_display(written)[0].values == wished.values


def test_values_that_are_none_are_listed_kept_and_written_when_set_here():
    entry = {
        "Class": "rviz_default_plugins/Grid", "Name": "Grid", "Value": True, "Alpha": "half",
        "Color": "1; 2; 300", "Plane": ["XY"], "Cell Size": float("nan"), "Plane Cell Count": 1e400,
        "Line Style": {"Value": "Dots", "Line Width": {"a": 1}}, "Offset": 7,
    }  # fmt: skip
    read, losses = display(**entry)
    assert dict(read.values) == {}
    refused = {"Alpha", "Cell Size", "Color", "Line Style", "Plane", "Plane Cell Count"}
    assert {one.reason: set(one.names) for one in losses} == {
        "no_value": refused,
        "no_property": {"Line Style/Line Width/a", "Offset"},
    }
    same = yaml.safe_load(write_tree(write_display(read)))
    assert str(same) == str(yaml.safe_load(yaml.safe_dump(entry)))
    changed = replace(read, values={"Alpha": 0.25})
    assert yaml.safe_load(write_tree(write_display(changed)))["Alpha"] == 0.25


GROUPS = """
  - Class: rviz_common/Group
    Displays:
      - {Class: rviz/Axes, Name: A, Value: true}
      - Class: rviz_common/Group
        Displays:
          - {Class: rviz/Axes, Name: B, Value: true}
        Name: a/b
        Value: false
    Name: Same
    Value: true
  - Class: rviz_common/Group
    Displays:
      - {Class: rviz/Axes, Name: C, Value: true}
    Extra: 1
    Name: Same
    Value: true
  - {Class: rviz_common/Group, Displays: [], Name: Empty, Value: true}
"""


def test_groups_in_groups_stay_where_they_are_and_two_of_one_name_stay_two():
    text = config(GROUPS)
    read, _ = read_config(text)
    assert [(one.name, one.group) for one in read.displays] == [
        ("A", "Same"), ("B", "Same/a\u2215b"), ("C", "Same 2"),
    ]  # fmt: skip
    assert read.groups_off == ("Same/a\u2215b",)
    assert yaml.safe_load(write_config(read)) == yaml.safe_load(text)
    moved = replace(read.displays[0], group="New/Inner")
    written = write_config(replace(read, displays=(moved,), groups_off=()))
    group, empty = yaml.safe_load(written)["Visualization Manager"]["Displays"]
    assert (empty["Name"], empty["Displays"]) == ("Empty", [])
    assert (group["Class"], group["Name"]) == ("rviz_common/Group", "New")
    assert group["Displays"][0]["Name"] == "Inner"


EMPTY = """
  - {Class: rviz_common/Group, Name: First, Value: false}
  - {Class: rviz/Axes, Name: A, Value: true}
  - Class: rviz_common/Group
    Displays:
      - {Class: rviz_common/Group, Displays: [], Name: Inner, Value: true}
    Name: Outer
    Value: true
  - Class: rviz_common/Group
    Displays:
      - {Class: rviz_common/Group, Displays: ~, Name: Before, Value: true}
      - {Class: rviz/Axes, Name: B, Value: true}
    Name: Full
    Value: true
"""


def test_empty_groups_are_no_displays_and_stay_where_they_are():
    text = config(EMPTY)
    read, losses = read_config(text)
    assert [(one.name, one.group) for one in read.displays] == [("A", ""), ("B", "Full")]
    empty = ("First", "Outer/Inner", "Outer", "Full/Before")
    assert losses == (Loss("empty_group", "rviz_common/Group", empty),)
    assert yaml.safe_load(write_config(read)) == yaml.safe_load(text)
    a, b = read.displays
    moved = write_config(replace(read, displays=(b, replace(a, group="First"))))
    names = [one["Name"] for one in yaml.safe_load(moved)["Visualization Manager"]["Displays"]]
    assert names == ["Full", "First", "Outer"]
    removed = write_config(replace(read, displays=()))
    names = [one["Name"] for one in yaml.safe_load(removed)["Visualization Manager"]["Displays"]]
    assert names == ["First", "Outer"]


TOOLS = """
  Tools:
    - Class: rviz_default_plugins/SetGoal
      Topic: {Value: goal, Depth: 5}
    - Class: nav2_rviz_plugins/GoalTool
    - Class: rviz_default_plugins/MoveCamera
  Views:
    Current: {Class: rviz/ThirdPersonFollower, Name: Current View, Distance: 2}
    Saved:
      - {Class: rviz_default_plugins/Orbit, Name: Front, Yaw: 1}
      - {Class: other/Fisheye, Name: Fish}
"""


def test_tools_and_views_are_taken_and_those_of_plug_ins_stay_between_them():
    text = config(more=TOOLS)
    read, losses = read_config(text)
    assert [(one.kind, dict(one.values)) for one in read.tools] == [
        ("SetGoal", {"Topic": "goal"}), ("MoveCamera", {}),
    ]  # fmt: skip
    assert [(one.kind, one.name, dict(one.values)) for one in (read.view, *read.views) if one] == [
        ("ThirdPersonFollower", "Current View", {"Distance": 2.0}),
        ("Orbit", "Front", {"Yaw": 1.0}),
    ]
    assert {(one.reason, one.what) for one in losses} == {
        ("no_tool", "nav2_rviz_plugins/GoalTool"), ("no_view", "other/Fisheye"),
    }  # fmt: skip
    assert yaml.safe_load(write_config(read)) == yaml.safe_load(text)
    tools = (*read.tools[1:], ToolSpec("", "PublishPoint", "Point", {"Single click": False}))
    views = (ViewSpec("FPS", "Walk"),)
    changed = replace(read, tools=tools, views=views)
    manager = yaml.safe_load(write_config(changed))["Visualization Manager"]
    assert [one["Class"] for one in manager["Tools"]] == [
        "nav2_rviz_plugins/GoalTool", "rviz_default_plugins/MoveCamera",
        "rviz_default_plugins/PublishPoint",
    ]  # fmt: skip
    assert manager["Tools"][2]["Single click"] is False
    assert [one["Name"] for one in manager["Views"]["Saved"]] == ["Fish", "Walk"]


LISTS = """
  Tools:
    - {Class: rviz_default_plugins/SetGoal, Extra: 1, Topic: {Value: /first}}
    - {Class: nav2_rviz_plugins/GoalTool}
    - 7
    - {Class: rviz_default_plugins/SetGoal, Extra: 2, Topic: {Value: /second}}
  Views:
    Saved:
      - {Class: rviz_default_plugins/Orbit, Name: A, Extra: 1}
      - {Class: other/Fisheye, Name: Fish}
      - {Class: rviz_default_plugins/Orbit, Name: B, Extra: 2}
      - {Class: rviz_default_plugins/Orbit, Name: B, Extra: 3}
"""


def test_each_tool_and_view_keeps_what_stands_in_its_own_entry():
    read, _ = read_config(config(more=LISTS))
    first, second = read.tools
    a, b, other_b = read.views
    changed = replace(read, tools=(second,), views=(other_b, replace(a, name="New"), b))
    manager = yaml.safe_load(write_config(changed))["Visualization Manager"]
    assert [one if one == 7 else one.get("Extra") for one in manager["Tools"]] == [None, 7, 2]
    assert [(one["Name"], one.get("Extra")) for one in manager["Views"]["Saved"]] == [
        ("B", 3), ("New", 1), ("Fish", None), ("B", 2),
    ]  # fmt: skip
    turned = replace(read, tools=(second, first, ToolSpec("", "SetGoal", "Third")))
    tools = yaml.safe_load(write_config(turned))["Visualization Manager"]["Tools"]
    assert [one if one == 7 else one.get("Extra") for one in tools] == [2, 1, None, 7, None]
    assert tools[4]["Topic"]["Value"] == "/goal_pose"


def test_standard_deviations_of_rviz_1_are_the_roots_of_covariances():
    deviations = "X std deviation: 0.4, Theta std deviation: 0.2617993950843811"
    text = config(more=f"  Tools: [{{Class: rviz/SetInitialPose, {deviations}}}]")
    read, losses = read_config(text)
    assert losses == ()
    assert read.tools[0].values == {"Covariance x": pytest.approx(0.16)}
    assert yaml.safe_load(write_config(read)) == yaml.safe_load(text)

    def written(made: RvizConfig) -> dict[str, Any]:
        return yaml.safe_load(write_config(made))["Visualization Manager"]["Tools"][0]

    wider = {**read.tools[0].values, "Covariance y": 4.0}
    changed = replace(read, tools=(replace(read.tools[0], values=wider),))
    assert written(changed) == {**written(read), "Y std deviation": 2}
    assert written(for_rviz2(changed)) == {
        "Class": "rviz_default_plugins/SetInitialPose",
        "Covariance x": pytest.approx(0.16), "Covariance y": 4,
    }  # fmt: skip


def test_the_tool_that_the_studio_always_has_is_not_added_to_a_file():
    read, _ = read_config(config(more=TOOLS))
    interact = default_tools()[0]
    with_it = replace(read, tools=(interact, *read.tools))
    assert write_config(with_it) == write_config(read)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "Visualization Manager"),
        ("[]", "Visualization Manager"),
        ("Visualization Manager: 5", "Visualization Manager"),
        (config("5"), "no list"),
        (config("{a: 1}"), "no list"),
        (config("[5]"), "no properties"),
        (config("[" + "{}," * (DISPLAYS_MAX + 1) + "]"), "more than 200 displays"),
        (config("[" + "{Class: rviz/Group}," * 5_000 + "]"), "more than 200 displays"),
        (config("[" + "{Class: rviz/Grid}," * 49_000 + "]"), "more than"),
        (config(more="  Tools: [" + "{Class: rviz/Select}," * 51 + "]"), "more than 49 tools"),
        (config(more="  Views: {Saved: [" + "{Class: rviz/FPS}," * 101 + "]}"), "100 saved views"),
        (config("[{Class: rviz/Group, Displays: " * 9 + "[{}]" + "}]" * 9), "nested deeper"),
    ],
)
def test_what_is_no_config_file_is_refused(text: str, reason: str):
    with pytest.raises(RvizConfigError, match=reason):
        read_config(text)


ANY = st.recursive(
    st.one_of(
        st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=8),
        st.sampled_from(["Orbit", "1; 2; 3", "/scan", "<Fixed Frame>", "9" * 400, "-1e999"]),
    ),
    lambda below: st.one_of(
        st.lists(below, max_size=3),
        st.dictionaries(st.sampled_from([
            "Alpha", "Class", "Color", "Enabled", "Frames", "Links", "Name", "Namespaces", "Offset",
            "Shape", "Topic", "Update Topic", "Value", "X", "Depth", "Displays", "base",
        ]), below, max_size=5),
    ),
    max_leaves=12,
)  # fmt: skip
ENTRIES = st.fixed_dictionaries(
    {"Class": st.sampled_from([f"rviz_default_plugins/{one.KIND}" for one in DISPLAYS])},
    optional=dict.fromkeys(
        (
            "Alpha", "Color", "Depth", "Displays", "Enabled", "Frames", "Links", "Name",
            "Namespaces", "Offset", "Shape", "Topic", "Description Topic", "Value",
        ),
        ANY,
    ),
)  # fmt: skip


@given(
    st.one_of(ANY, st.lists(ENTRIES, max_size=3)),
    st.dictionaries(
        st.sampled_from(["Global Options", "Tools", "Views", "Transformation", "Class"]), ANY
    ),
    st.dictionaries(st.sampled_from(["Panels", "Window Geometry", "Preferences"]), ANY),
)
def test_wrong_types_anywhere_are_kept_or_refused(
    displays: object, manager: dict[str, object], more: dict[str, object]
):
    text = yaml.safe_dump({"Visualization Manager": {"Displays": displays, **manager}, **more})
    try:
        read, _ = read_config(text)
    except RvizConfigError:
        return
    assert str(yaml.safe_load(write_config(read))) == str(yaml.safe_load(text))


def test_the_owners_own_displays_are_found_again_with_their_values():
    wished = ConfigDisplay(
        "plugins/Heat", "Heat", False, "", "/heat", values={"A/B": 0.1, "C": "#ff0000", "D": True}
    )
    entry = write_display(wished)
    assert text_at(entry, "Class") == "plugins/Heat"
    read, losses = read_display(entry)
    assert losses == []
    assert replace(read, entry={}) == wished
    changed = replace(read, values={**read.values, "A/B": 2.5})
    assert yaml.safe_load(write_tree(write_display(changed)))["A"] == {"B": 2.5}

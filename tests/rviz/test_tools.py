"""Tools as values: RViz's names, keys and defaults, and the list of a document."""

from __future__ import annotations

import math

import msgspec
import pytest

from studio.errors import DisplayPropertyError, ToolError
from studio.rviz.tools import (
    COVARIANCES,
    SEND_AS,
    TOOL_KINDS,
    TOOLS_MAX,
    TOPIC,
    ToolList,
    ToolSpec,
    default_tools,
)


def test_the_first_set_is_that_of_rviz_with_its_keys():
    assert {one.kind: TOOL_KINDS[one.kind].key for one in default_tools()} == {
        "Interact": "I",
        "MoveCamera": "M",
        "Select": "S",
        "FocusCamera": "C",
        "Measure": "N",
        "SetInitialPose": "P",
        "SetGoal": "G",
        "PublishPoint": "U",
    }
    assert [one.id for one in default_tools()] == [f"t{number}" for number in range(1, 9)]


def test_defaults_are_those_that_rviz_writes():
    of = {one.kind: one for one in default_tools()}
    assert of["SetInitialPose"].value(TOPIC) == "/initialpose"
    assert of["SetGoal"].value(TOPIC) == "/goal_pose"
    assert of["PublishPoint"].value(TOPIC) == "/clicked_point"
    assert [of["SetInitialPose"].value(name) for name in COVARIANCES] == pytest.approx(
        [0.25, 0.25, (math.pi / 12) ** 2]
    )
    written = {"Depth": 5, "History Policy": "Keep Last", "Reliability Policy": "Reliable"}
    written["Durability Policy"] = "Volatile"
    for kind in ("SetInitialPose", "SetGoal", "PublishPoint"):
        assert {name: of[kind].value(f"Topic/{name}") for name in written} == written
    assert of["Measure"].value("Line color") == "#808000"
    assert of["Interact"].value("Hide Inactive Objects") is True
    assert of["PublishPoint"].value("Single click") is True


def test_two_goals_have_their_own_names_and_topics():
    tools = ToolList()
    added = tools.add("SetGoal")
    assert (added.name, added.id) == ("2D Goal Pose 2", "t9")
    tools.set(added.id, TOPIC, "/other/goal_pose")
    tools.rename(added.id, " Other goal ")
    kept = msgspec.json.decode(msgspec.json.encode(tuple(tools)), type=tuple[ToolSpec, ...])
    again = ToolList()
    again.restore(kept)
    goals = [(one.name, one.value(TOPIC)) for one in again if one.kind == "SetGoal"]
    assert goals == [("2D Goal Pose", "/goal_pose"), ("Other goal", "/other/goal_pose")]


def test_a_default_is_not_kept_and_values_are_checked():
    tools = ToolList()
    goal = next(one.id for one in tools if one.kind == "SetGoal")
    assert tools.set(goal, "Topic/Depth", 1e9).value("Topic/Depth") == 10_000
    assert tools.set(goal, "Topic/Depth", 5).values == {}
    with pytest.raises(DisplayPropertyError, match="is one of Auto, Topic, Action"):
        tools.set(goal, SEND_AS, "Pigeon")
    with pytest.raises(ToolError, match="no property of 2D Goal Pose"):
        tools.set(goal, "Covariance x", 1.0)
    with pytest.raises(ToolError, match="at least one letter"):
        tools.rename(goal, " ")


def test_one_interact_tool_stays_and_there_are_not_too_many():
    tools = ToolList()
    for one in tuple(tools)[1:]:
        tools.remove(one.id)
    with pytest.raises(ToolError, match="One Interact tool stays"):
        tools.remove("t1")
    with pytest.raises(ToolError, match="not there any more"):
        tools.remove("t2")
    for _ in range(TOOLS_MAX - 1):
        tools.add("Measure")
    with pytest.raises(ToolError, match="remove one first"):
        tools.add("Measure")
    with pytest.raises(ToolError, match='There is no tool "Teleport"'):
        ToolList().add("Teleport")


def test_what_was_kept_is_read_as_far_as_it_makes_sense():
    tools = ToolList()
    bad = {TOPIC: "/here", "Topic/Depth": "deep", "Nonsense": 1}
    tools.restore((ToolSpec("a", "Teleport", "x"), ToolSpec("a", "SetGoal", "Goal", bad)))
    assert [(one.kind, dict(one.values)) for one in tools] == [
        ("Interact", {}),
        ("SetGoal", {TOPIC: "/here"}),
    ]
    tools.restore(())
    assert [one.kind for one in tools] == list(TOOL_KINDS)

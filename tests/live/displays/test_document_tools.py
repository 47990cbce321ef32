"""The tools of a document: their list as pages get it, and where what they point at is."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING

import pytest

from studio.errors import FrameError, ToolError
from studio.live.displays.document_tools import DocumentTools, Pointed
from studio.live.displays.scene_frames import SceneFrames
from studio.protocol.listeners import Audience
from studio.protocol.tools import (
    AddTool,
    GetToolKinds,
    RemoveTool,
    RenameTool,
    SetToolProperty,
)
from studio.rviz.tools import TOOL_KINDS
from tests.support.memory_source import MemorySource
from tests.support.open_documents import Ear
from tests.support.posed import Posed, arm
from tests.support.transforms import S, Told, columns

if TYPE_CHECKING:
    from collections.abc import Container

TURN = math.pi / 2
ORIGIN = (0.0, 0.0, 0.0)


def tools_of() -> tuple[DocumentTools, Ear, list[str]]:
    ear, audience, changes = Ear(), Audience(), list[str]()
    audience.add(ear)
    return DocumentTools(audience, lambda: changes.append("")), ear, changes


def frames_of(*rows: Told) -> SceneFrames:
    """The frames of an arm whose root link is `base`."""
    frames = SceneFrames(Posed(arm()), MemorySource())
    frames.step()
    frames.buffer.put(columns(*rows))
    return frames


def goal_of(tools: DocumentTools) -> str:
    return next(one.id for one in tools.list if one.kind == "SetGoal")


def test_every_change_is_sent_whole_and_kept():
    tools, ear, changes = tools_of()
    tools.add(AddTool(kind="SetGoal", name="Second"))
    added = tools.kept[-1].id
    tools.rename(RenameTool(tool=added, name="Other"))
    tools.set_property(SetToolProperty(tool=added, name="Topic", value="/b/goal"))
    there: list[Container[str]] = []
    tools.on_tools = there.append
    gone = tools.kept[1].id
    tools.remove(RemoveTool(tool=gone))
    assert (added in there[-1], gone in there[-1]) == (True, False)
    assert len(changes) == 4
    told = ear.events[-1]
    assert [one["kind"] for one in told["tools"]][:2] == ["Interact", "Select"]
    last = told["tools"][-1]
    assert (last["name"], last["values"]["Topic"], last["values"]["Topic/Depth"]) == (
        "Other",
        "/b/goal",
        5,
    )
    kinds = tools.kinds(GetToolKinds())
    assert [one.kind for one in kinds.kinds] == list(TOOL_KINDS)
    json.dumps(kinds.model_dump(), allow_nan=False)


def test_another_documents_tools_are_taken_over_only_if_they_differ():
    one, other = tools_of()[0], tools_of()[0]
    ids = [tool.id for tool in other.kept]
    other.mirror(one.kept)
    assert [tool.id for tool in other.kept] == ids
    one.add(AddTool(kind="Measure"))
    other.mirror(one.kept)
    assert [tool.name for tool in other.kept] == [tool.name for tool in one.kept]


def test_a_place_is_in_the_fixed_frame_unless_the_tool_has_another():
    tools, _, _ = tools_of()
    goal = goal_of(tools)
    frames = frames_of(Told("map", "base", S, (1.0, 2.0, 0.0), (0.5**0.5, 0.0, 0.0, 0.5**0.5)))
    plain = tools.use(Pointed(goal, "", (0.5, 0.0, 0.0), TURN), frames)
    assert (plain.frame, plain.xyz) == ("base", (0.5, 0.0, 0.0))
    assert plain.wxyz == pytest.approx((math.cos(TURN / 2), 0, 0, math.sin(TURN / 2)))
    tools.set_property(SetToolProperty(tool=goal, name="Frame", value="/map"))
    turned = tools.use(Pointed(goal, "", (0.5, 0.0, 0.0), TURN), frames)
    assert turned.frame == "map"
    assert turned.xyz == pytest.approx((1.0, 2.5, 0.0))
    assert turned.wxyz == pytest.approx((0, 0, 0, 1), abs=1e-12)
    tools.set_property(SetToolProperty(tool=goal, name="Frame", value="<Fixed Frame>"))
    frames.chosen = "map"
    assert tools.use(Pointed(goal, "map", ORIGIN), frames).frame == "map"


def test_what_cannot_be_sent_is_said_with_its_reason():
    tools, _, _ = tools_of()
    goal, frames = goal_of(tools), frames_of(Told("map", "base", S), Told("moon", "flag", S))
    with pytest.raises(ToolError, match="fixed frame was changed"):
        tools.use(Pointed(goal, "map", ORIGIN), frames)
    with pytest.raises(ToolError, match="Interact publishes nothing"):
        tools.use(Pointed("t1", "", ORIGIN), frames)
    tools.set_property(SetToolProperty(tool=goal, name="Frame", value="moon"))
    with pytest.raises(FrameError, match="moon"):
        tools.use(Pointed(goal, "", ORIGIN), frames)

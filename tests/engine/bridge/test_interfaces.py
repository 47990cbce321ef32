from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from studio.engine.bridge.interfaces import InterfaceDesk
from studio.engine.messages.interfaces import GetInterface
from studio.engine.wire.desk import WireDesk
from studio.errors import StudioError
from studio.settings import WireChoice

if TYPE_CHECKING:
    from studio.engine.messages.interfaces import InterfaceAnswer


def asked(name: str) -> InterfaceAnswer:
    desk = InterfaceDesk(WireDesk(WireChoice()))
    return asyncio.run(desk.interface(GetInterface(request=7, name=name)))


def test_a_message_is_told_with_all_that_it_is_made_of():
    answer = asked("geometry_msgs/msg/PoseStamped")
    assert (answer.request, answer.kind, answer.parts) == (
        7,
        "msg",
        ("geometry_msgs/msg/PoseStamped",),
    )
    names = [one.name for one in answer.messages]
    assert names[0] == "geometry_msgs/msg/PoseStamped"
    assert set(names) == {
        *("geometry_msgs/msg/PoseStamped", "geometry_msgs/msg/Pose", "geometry_msgs/msg/Point"),
        *("geometry_msgs/msg/Quaternion", "std_msgs/msg/Header", "builtin_interfaces/msg/Time"),
    }
    assert len(names) == len(set(names))
    assert answer.hash.startswith("RIHS01_")


@pytest.mark.parametrize(
    ("name", "parts"),
    [
        ("std_srvs/srv/SetBool", ("Request", "Response")),
        ("turtlesim/action/RotateAbsolute", ("Goal", "Result", "Feedback")),
    ],
)
def test_a_call_is_told_by_its_parts(name: str, parts: tuple[str, ...]):
    answer = asked(name)
    assert answer.parts == tuple(f"{name}_{part}" for part in parts)
    assert {one.name for one in answer.messages} >= set(answer.parts)


def test_arrays_bounds_constants_and_comments_are_told():
    answer = asked("sensor_msgs/msg/PointCloud2")
    by_name = {one.name: one for one in answer.messages}
    fields = {one.name: one for one in by_name["sensor_msgs/msg/PointCloud2"].fields}
    assert (fields["data"].base, fields["data"].shape) == ("uint8", "sequence")
    constants = by_name["sensor_msgs/msg/PointField"].constants
    assert ("FLOAT32", 7) in [(one.name, one.value) for one in constants]


@pytest.mark.parametrize("name", ["", "x", "no_such/msg/Type", "../msg/x", "a/b/c"])
def test_what_is_not_known_is_refused_with_a_sentence(name: str):
    with pytest.raises(StudioError, match=r"."):
        asked(name)

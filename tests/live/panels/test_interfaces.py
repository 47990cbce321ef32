from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from studio.errors import InterfaceTextError, StudioError
from studio.live.connection.ros_connection import RosConnection
from studio.live.panels.interfaces import InterfaceTypes
from studio.protocol.interfaces import AddInterfaces, GetInterface, ListInterfaces
from studio.settings import WireChoice

if TYPE_CHECKING:
    from studio.protocol.interfaces import InterfaceAnswer, InterfacesAdded, InterfacesAnswer
    from studio.ros.types.library import TypeLibrary


def added(texts: dict[str, str]) -> InterfacesAdded:
    interfaces = InterfaceTypes(RosConnection(WireChoice()))
    return asyncio.run(interfaces.add(AddInterfaces(request=2, texts=texts)))


def listed() -> InterfacesAnswer:
    interfaces = InterfaceTypes(RosConnection(WireChoice()))
    return asyncio.run(interfaces.names(ListInterfaces(request=3)))


def asked(name: str) -> InterfaceAnswer:
    interfaces = InterfaceTypes(RosConnection(WireChoice()))
    return asyncio.run(interfaces.interface(GetInterface(request=7, name=name)))


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


def test_t6_all_types_of_the_six_packages_are_listed():
    interfaces = InterfaceTypes(RosConnection(WireChoice()))
    told = asyncio.run(interfaces.names(ListInterfaces(request=3)))
    packages = {name.split("/")[0] for name in told.names}
    assert packages >= {
        *("std_msgs", "sensor_msgs", "geometry_msgs", "nav_msgs"),
        *("action_msgs", "builtin_interfaces"),
    }
    assert (told.request, list(told.names)) == (3, sorted(told.names))


def test_t11_a_type_that_was_pasted_is_usable_at_once(library: TypeLibrary):
    name = "my_robot_interfaces/msg/CustomTelemetry"
    text = "# How it is.\nstring robot_name\nfloat32 battery_percent\nint32[3] counts\n"
    (told,) = added({name: text}).types
    assert (told.name, told.trouble) == (name, "")
    assert told.hash == library.hash_of(name)
    answer = asked(name)
    assert (answer.text, answer.hash) == (text, told.hash)
    assert [one.name for one in answer.messages[0].fields] == [
        *("robot_name", "battery_percent", "counts"),
    ]
    assert library.own_names() == [name]
    value = library.message(name)(robot_name="r2", battery_percent=99.5)
    assert value.counts.tolist() == [0, 0, 0]


@pytest.mark.usefixtures("library")
def test_what_a_type_needs_may_come_after_it():
    (first,) = added({"mine/msg/Outer": "mine/Inner inner\n"}).types
    assert first.hash == ""
    assert "mine/msg/Inner" in first.trouble
    added({"mine/msg/Inner": "int32 x\n"})
    (again,) = added({"mine/msg/Outer": "mine/Inner inner\n"}).types
    assert again.hash.startswith("RIHS01_")


@pytest.mark.parametrize(
    "texts",
    [
        {"mine/msg/Bad": "this is no field at all !"},
        {"mine/msg/bad": "int32 x"},
        {"../msg/X": "int32 x"},
        {"mine/msg/Loop": "mine/Loop again"},
        {"mine/msg/Huge": "float64[4000000000] x"},
        {"mine/srv/Bad": "int32 x\n---\n---\n---\n"},
        {"builtin_interfaces/msg/Time": "int64 nanoseconds"},
    ],
)
def test_texts_that_break_a_rule_are_refused_and_none_is_taken(
    texts: dict[str, str], library: TypeLibrary
):
    with pytest.raises(StudioError, match=r"."):
        added(texts)
    assert library.own_names() == []


def test_of_several_texts_the_sound_ones_are_taken_and_the_others_named_until_they_are_mended(
    library: TypeLibrary,
):
    answer = added({"mine/msg/Good": "int32 x", "mine/srv/Bad": "int32 x\n--\n"})
    assert [one.name for one in answer.types] == ["mine/msg/Good"]
    (fault,) = answer.faults
    assert (fault.place, fault.line) == ("mine/srv/Bad", 2)
    assert fault.reason == '"--" parts nothing: write three dashes, ---'
    assert listed().faults == answer.faults
    assert library.own_names() == ["mine/msg/Good"]
    added({"mine/srv/Bad": "int32 x\n---\n"})
    assert listed().faults == ()


def test_a_type_that_was_taken_already_keeps_its_class(library: TypeLibrary):
    added({"mine/msg/Same": "int32 x\n"})
    kind = library.message("mine/msg/Same")
    added({"mine/msg/Same": "int32 x\n"})
    assert library.message("mine/msg/Same") is kind
    with pytest.raises(InterfaceTextError):
        added({"mine/msg/Same": "int32 x y\n"})

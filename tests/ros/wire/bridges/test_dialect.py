from __future__ import annotations

from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.errors import AttachmentError, TokenError
from studio.ros.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from studio.ros.tokens import EndpointKind, EndpointToken, NodeToken
from studio.ros.wire.bridges.dialect import (
    Route,
    RouteKind,
    announcement,
    bridge_key,
    parse_bridge_token,
    place_of,
    request_number,
    route_ends,
    subscription_announcement,
)

ZID = "808efd252658c6e9d13dc2de319edea7"
HEAD = f"@/{ZID}/@ros2_lv"
HASH = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
NODE = NodeToken(domain=0, zid=ZID, nid=0, namespace="/", name="talker")


def route(token: str) -> Route:
    found = parse_bridge_token(token)
    assert isinstance(found, Route)
    return found


def end(kind: EndpointKind, name: str, type_name: str, qos: QoSProfile | None = None) -> str | None:
    token = EndpointToken(NODE, 1, kind, name, type_name, HASH, qos or QoSProfile(depth=10))
    return announcement(token)


def test_the_token_of_a_bridge_itself_names_its_session():
    assert parse_bridge_token(HEAD) == ZID


def test_a_publisher_is_read_with_the_numbers_of_dds_and_its_hash():
    found = route(f"{HEAD}/MP/robot1§chatter/std_msgs§msg§String/:1:1:0,7:typehash={HASH};")
    assert (found.kind, found.name) == (RouteKind.PUBLISHER, "/robot1/chatter")
    assert (found.type_name, found.type_hash) == ("std_msgs/msg/String", HASH)
    assert found.qos == QoSProfile(depth=7, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@pytest.mark.parametrize(
    ("kind", "reliability"),
    [("MP", ReliabilityPolicy.RELIABLE), ("MS", ReliabilityPolicy.BEST_EFFORT)],
)
def test_what_a_qos_leaves_empty_is_the_default_of_dds(kind: str, reliability: ReliabilityPolicy):
    qos = route(f"{HEAD}/{kind}/chatter/std_msgs§msg§String/:::").qos
    assert qos == QoSProfile(depth=1, reliability=reliability)


def test_a_topic_that_keeps_all_has_no_depth():
    qos = route(f"{HEAD}/MP/chatter/std_msgs§msg§String/:1::1,-1").qos
    assert qos is not None
    assert (qos.history, qos.depth) == (HistoryPolicy.KEEP_ALL, 0)


def test_a_token_of_an_action_stands_for_its_parts():
    found = route_ends(route(f"{HEAD}/AS/arm§turn/turtlesim§action§RotateAbsolute"))
    assert [(one.kind, one.name, one.type_name) for one in found] == [
        (EndpointKind.SERVICE, "/arm/turn/_action/send_goal",
         "turtlesim/action/RotateAbsolute_SendGoal"),
        (EndpointKind.SERVICE, "/arm/turn/_action/cancel_goal", "action_msgs/srv/CancelGoal"),
        (EndpointKind.SERVICE, "/arm/turn/_action/get_result",
         "turtlesim/action/RotateAbsolute_GetResult"),
        (EndpointKind.PUBLISHER, "/arm/turn/_action/feedback",
         "turtlesim/action/RotateAbsolute_FeedbackMessage"),
        (EndpointKind.PUBLISHER, "/arm/turn/_action/status", "action_msgs/msg/GoalStatusArray"),
    ]  # fmt: skip
    client = route_ends(route(f"{HEAD}/AC/turn/turtlesim§action§RotateAbsolute"))
    assert {one.kind for one in client} == {EndpointKind.CLIENT, EndpointKind.SUBSCRIPTION}


@pytest.mark.parametrize(
    "token",
    [
        "@ros2_lv/0/a1/0/0/NN/%/%/talker",
        f"@/{ZID}/ros2_lv",
        "@/*/@ros2_lv",
        f"@/{ZID}x/@ros2_lv",
        f"{HEAD}/MP",
        f"{HEAD}/XX/chatter/std_msgs§msg§String/:::",
        f"{HEAD}/MP/chatter/std_msgs§msg§String",
        f"{HEAD}/MP/chatter/std_msgs%msg%String/:::",
        f"{HEAD}/MP/§chatter/std_msgs§msg§String/:::",
        f"{HEAD}/MP/chat§§ter/std_msgs§msg§String/:::",
        f"{HEAD}/MP/chatter§/std_msgs§msg§String/:::",
        f"{HEAD}/MP/chatter/§msg§String/:::",
        f"{HEAD}/MP/chatter/std_msgs§msg§String/::",
        f"{HEAD}/MP/chatter/std_msgs§msg§String/:x::",
        f"{HEAD}/MP/chatter/std_msgs§msg§String/:::0,99999999999999",
        f"{HEAD}/SS/add/example_interfaces§srv§AddTwoInts/:::",
    ],
)
def test_what_is_no_token_of_a_bridge_is_refused_in_a_sentence(token: str):
    with pytest.raises(TokenError) as refused:
        parse_bridge_token(token)
    assert str(refused.value).endswith(".")


@given(st.text(max_size=80), st.sampled_from(["", HEAD + "/", f"{HEAD}/MP/", f"@/{ZID}/"]))
def test_no_text_breaks_the_reader(text: str, head: str):
    with suppress(TokenError):
        parse_bridge_token(head + text)


@pytest.mark.parametrize(
    "told", ["typehash=RIHS01_12;", "typehash=", "x=1;typehash=RIHS02_ff;", ""]
)
def test_a_hash_that_is_none_counts_as_not_told(told: str):
    assert not route(f"{HEAD}/MP/chatter/std_msgs§msg§String/:::0,1:{told}").type_hash


names = st.from_regex(r"(/[a-z][a-z0-9_]{0,8}){1,3}", fullmatch=True)
profiles = st.builds(
    QoSProfile,
    depth=st.integers(1, 1000),
    reliability=st.sampled_from([ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT]),
    durability=st.sampled_from([DurabilityPolicy.VOLATILE, DurabilityPolicy.TRANSIENT_LOCAL]),
)


@given(names, profiles)
def test_what_we_announce_is_read_as_it_was_meant(name: str, qos: QoSProfile):
    token = end(EndpointKind.PUBLISHER, name, "std_msgs/msg/String", qos)
    assert token is not None
    found = route(token)
    assert (found.name, found.type_name, found.type_hash) == (name, "std_msgs/msg/String", HASH)
    assert found.qos == qos
    assert (found.zid, found.kind) == (ZID, RouteKind.PUBLISHER)


def test_a_subscription_is_announced_with_what_its_publisher_offers():
    assert end(EndpointKind.SUBSCRIPTION, "/scan", "sensor_msgs/msg/LaserScan") is None
    qos = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
    token = subscription_announcement(ZID, "/scan", "sensor_msgs/msg/LaserScan", "", qos)
    assert token == f"{HEAD}/MS/scan/sensor_msgs§msg§LaserScan/:0:0:0,5"
    action = "/turn/_action/feedback"
    assert subscription_announcement(ZID, action, "a/action/T_FeedbackMessage", "", qos) is None


def test_a_service_is_announced_without_qos():
    token = end(EndpointKind.SERVICE, "/arm/add", "example_interfaces/srv/AddTwoInts")
    assert token == f"{HEAD}/SS/arm§add/example_interfaces§srv§AddTwoInts"


def test_an_action_is_announced_once_for_all_its_parts():
    base, name = "/turn/_action", "turtlesim/action/RotateAbsolute"
    assert end(EndpointKind.SERVICE, f"{base}/send_goal", f"{name}_SendGoal") == (
        f"{HEAD}/AS/turn/turtlesim§action§RotateAbsolute"
    )
    assert end(EndpointKind.CLIENT, f"{base}/send_goal", f"{name}_SendGoal") == (
        f"{HEAD}/AC/turn/turtlesim§action§RotateAbsolute"
    )
    for kind, part in (
        (EndpointKind.SERVICE, "get_result"),
        (EndpointKind.CLIENT, "cancel_goal"),
        (EndpointKind.PUBLISHER, "feedback"),
        (EndpointKind.SUBSCRIPTION, "status"),
    ):
        assert end(kind, f"{base}/{part}", f"{name}_GetResult") is None


@pytest.mark.parametrize("kind", [EndpointKind.SERVICE, EndpointKind.CLIENT])
def test_bridges_know_an_action_by_its_send_goal(kind: EndpointKind):
    as_action = {
        EndpointKind.SERVICE: RouteKind.ACTION_SERVER,
        EndpointKind.CLIENT: RouteKind.ACTION_CLIENT,
    }
    assert place_of(kind, "/turn/_action/send_goal") == (as_action[kind], "/turn")
    assert place_of(kind, "/turn/_action/get_result") is None
    assert place_of(EndpointKind.PUBLISHER, "/turn/_action/send_goal") is None


@pytest.mark.parametrize("kind", list(EndpointKind))
def test_bridges_know_every_other_end_by_its_own_name(kind: EndpointKind):
    assert place_of(kind, "/a/_b") == (RouteKind(kind.value), "/a/_b")


def test_a_key_is_the_name_without_its_first_slash():
    assert bridge_key("/robot1/chatter") == "robot1/chatter"


def test_the_number_of_a_request_is_read_in_both_orders_of_bytes():
    little = bytes.fromhex("727168ee06451957e2eccc020000000000000001")
    big = bytes.fromhex("727168ee06451957e2eccc000000000000000200")
    for attachment in (little, big):
        number = request_number(attachment)
        assert number is not None
        assert number.sequence == 2
        assert number.gid == bytes.fromhex("ee06451957e2eccc") + bytes(8)
    assert request_number(None) is None


@pytest.mark.parametrize("attachment", [b"", b"rqh", b"xyz" + bytes(17), bytes(33)])
def test_another_attachment_is_no_request_of_a_bridge(attachment: bytes):
    with pytest.raises(AttachmentError):
        request_number(attachment)

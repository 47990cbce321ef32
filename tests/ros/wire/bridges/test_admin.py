from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.ros.qos import DurabilityPolicy, HistoryPolicy, ReliabilityPolicy
from studio.ros.wire.bridges.admin import Bounds, Told, read_answers, read_routes
from studio.ros.wire.bridges.dialect import RouteKind

GOLDEN = Path(__file__).parents[3] / "golden" / "dds_bridge"
ZID = "808efd252658c6e9d13dc2de319edea7"
ROBOT = "0110148101bf2c19a5072d13000001c1"
HASH = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"


def told(**answers: Any) -> Told:  # noqa: ANN401 - whatever JSON is
    """Read answers by what follows `@/ZID/ros2/`, with + for each slash."""
    pairs = [
        (f"@/{ZID}/ros2/{key.replace('+', '/')}", json.dumps(value).encode())
        for key, value in answers.items()
    ]
    return read_answers(pairs, ZID) or Told()


def writer(**qos: object) -> dict[str, object]:
    return {"key": "1", "qos": qos, "topic_name": "rt/chatter", "type_name": "x"}


def test_settings_are_read():
    config = {
        "domain": 7, "namespace": "/robot1", "nodename": "my_bridge", "ros_localhost_only": True,
        "allow": {"publishers": "^/scan$|^/tf$", "service_servers": "^/add$"},
        "pub_max_frequencies": ["/image.*=5", "/a=b=2.5", "/wrong", "/no=x"],
    }  # fmt: skip
    settings = told(config=config).settings
    assert settings is not None
    assert (settings.domain, settings.namespace, settings.node_name) == (7, "/robot1", "my_bridge")
    assert settings.localhost_only
    assert settings.rules is not None
    assert settings.rules.allows
    assert settings.rules.texts() == ("publishers: ^/scan$|^/tf$", "service_servers: ^/add$")
    assert settings.slowed == (("/image.*", 5.0), ("/a=b", 2.5))


def test_a_deny_list_is_told_from_an_allow_list():
    settings = told(config={"domain": 0, "deny": {"subscribers": "^/cmd_vel$"}}).settings
    assert settings is not None
    assert settings.rules is not None
    assert not settings.rules.allows
    assert settings.rules.patterns == {RouteKind.SUBSCRIPTION: "^/cmd_vel$"}


def test_nodes_are_read_with_their_ends():
    found = told(
        **{
            f"node+{ROBOT}+arm+driver": {
                "publishers": [{"name": "/chatter", "type": "std_msgs/msg/String"}],
                "action_servers": [{"name": "/turn", "type": "a/action/Turn"}],
                "subscribers": [{"name": "no slash", "type": "std_msgs/msg/String"}, 3],
                "service_servers": "none",
            },
            f"node+{ROBOT}+9wrong": {"publishers": []},
        }
    )
    (node,) = found.nodes
    assert (node.participant, node.path) == (ROBOT, "/arm/driver")
    assert node.ends == (
        (RouteKind.PUBLISHER, "/chatter", "std_msgs/msg/String"),
        (RouteKind.ACTION_SERVER, "/turn", "a/action/Turn"),
    )


def test_the_qos_and_hash_of_each_dds_end_are_read():
    qos = {
        "reliability": {"kind": "BEST_EFFORT"},
        "durability": {"kind": "TRANSIENT_LOCAL"},
        "history": {"kind": "KEEP_LAST", "depth": 4},
        "deadline": {"period": 500_000_000},
        "user_data": list(f"typehash={HASH};".encode()),
    }
    found = told(**{f"dds+{ROBOT}+writer+1+rt+chatter": writer(**qos)})
    end = found.dds_ends[ROBOT, RouteKind.PUBLISHER, "/chatter"]
    assert end.type_hash == HASH
    assert end.qos.reliability is ReliabilityPolicy.BEST_EFFORT
    assert end.qos.durability is DurabilityPolicy.TRANSIENT_LOCAL
    assert (end.qos.history, end.qos.depth) == (HistoryPolicy.KEEP_LAST, 4)
    assert end.qos.deadline.nanoseconds == 500_000_000


def test_what_a_dds_end_leaves_out_is_the_default_of_dds():
    found = told(
        **{
            f"dds+{ROBOT}+writer+1+rt+a": writer(),
            f"dds+{ROBOT}+reader+2+rt+a": writer(),
            f"dds+{ROBOT}+reader+3+rq+addRequest": writer(),
            f"dds+{ROBOT}+writer+4+rr+addReply": writer(),
        }
    )
    reliability = {key[1:]: one.qos.reliability for key, one in found.dds_ends.items()}
    assert reliability == {
        (RouteKind.PUBLISHER, "/a"): ReliabilityPolicy.RELIABLE,
        (RouteKind.SUBSCRIPTION, "/a"): ReliabilityPolicy.BEST_EFFORT,
        (RouteKind.SERVICE, "/add"): ReliabilityPolicy.BEST_EFFORT,
    }


def test_machines_are_known_by_participant():
    properties = {"qos": {"properties": {"__Hostname": "turtlebot"}}}
    assert told(**{f"dds+{ROBOT}": properties}).hosts == {ROBOT: "turtlebot"}


def test_answers_of_a_bridge_that_was_not_asked_are_passed_over():
    assert read_answers([(f"@/{ZID}/ros2/version", b'"v1.10.0"')], "ff") is None


@pytest.mark.parametrize("domain", [-1, 233, 2**70, True, "0", 0.0, None, [0]])
def test_settings_with_a_domain_that_is_none_are_not_known(domain: object):
    assert told(config={"domain": domain}).settings is None


@pytest.mark.parametrize("name", ["//", "/a b", "a", "/\x1b[2J", [], {}, 3, "/" + "a" * 300])
def test_names_that_break_the_rules_are_those_of_a_bridge_without(name: object):
    settings = told(config={"domain": 0, "namespace": name, "nodename": name}).settings
    assert settings is not None
    assert settings.namespace == "/"
    assert settings.node_name in {"a", "zenoh_bridge_ros2dds"}


def test_texts_hold_nothing_that_steers_a_terminal_or_cannot_be_sent():
    name = "a\n\x1b]0;x\x07\u202e\ud800b"
    found = told(
        **{
            f"dds+{ROBOT}": {"qos": {"properties": {"__Hostname": name}}},
            "config": {
                "domain": 0,
                "deny": {"publishers": name},
                "pub_max_frequencies": [f"{name}=5"],
            },
        }
    )
    assert found.settings is not None
    assert found.settings.rules is not None
    texts = [*found.hosts.values(), *found.settings.rules.texts(), found.settings.slowed[0][0]]
    assert len(texts) == 3
    assert all(text.isprintable() and text.encode() for text in texts)


@pytest.mark.parametrize("rate", ["9" * 1_500, "nan", "-1", "1e9", "", "\u0663"])
def test_a_rate_that_is_none_is_passed_over(rate: str):
    settings = told(config={"domain": 0, "pub_max_frequencies": [f"/scan={rate}"]}).settings
    assert settings is not None
    assert settings.slowed == ()


def test_a_qos_whose_kinds_are_no_texts_is_the_default_of_dds():
    odd: dict[str, object] = {"durability": {"kind": []}, "history": {"kind": {}, "depth": 10**30}}
    end = told(**{f"dds+{ROBOT}+writer+1+rt+a": writer(**odd)}).dds_ends[
        ROBOT, RouteKind.PUBLISHER, "/a"
    ]
    assert end.qos.durability is DurabilityPolicy.VOLATILE
    assert end.qos.depth == 2**31 - 1


def test_a_node_that_is_told_twice_is_one():
    node = (f"@/{ZID}/ros2/node/{ROBOT}/x", b"{}")
    found = read_answers([node, node], ZID)
    assert found is not None
    assert len(found.nodes) == 1


def test_of_ends_beyond_the_bound_nothing_is_kept():
    ends = [{"name": f"/t{one}", "type": "std_msgs/msg/String"} for one in range(10)]
    answers = [
        (f"@/{ZID}/ros2/node/{ROBOT}/n{one}", json.dumps({"publishers": ends}).encode())
        for one in range(3)
    ]
    found = read_answers(answers, ZID, ends_max=15)
    assert found is not None
    assert [len(one.ends) for one in found.nodes] == [10, 5, 0]


def test_many_bridges_share_the_bounds_of_all():
    one, many = Bounds.of_each(1), Bounds.of_each(64)
    assert one == Bounds.of_each(0) == Bounds()
    assert 64 * many.ends <= 4 * one.ends
    assert many.answers >= 5_000


json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=20),
    lambda inner: (
        st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=12), inner, max_size=4)
    ),
    max_leaves=12,
)
words = st.sampled_from(
    ["domain", "namespace", "allow", "publishers", "name", "type", "qos", "history", "depth",
     "kind", "pub_max_frequencies", "user_data", "properties", "__Hostname", "deadline", "period"]
)  # fmt: skip
keys = st.sampled_from(
    ["config", "version", f"node/{ROBOT}/x", f"dds/{ROBOT}", f"dds/{ROBOT}/writer/1/rt/a",
     f"dds/{ROBOT}/reader/1/rq/addRequest", "route/topic/pub/a", "", "node", "dds"]
)  # fmt: skip


@given(keys, st.recursive(json_values, lambda inner: st.dictionaries(words, inner, max_size=4)))
def test_no_answer_breaks_the_reader(key: str, value: object):
    read_answers([(f"@/{ZID}/ros2/{key}", json.dumps(value).encode())], ZID)


@given(st.binary(max_size=60))
def test_what_is_no_json_is_passed_over(data: bytes):
    read_answers([(f"@/{ZID}/ros2/config", data)], ZID)


def golden_routes(zid: str) -> frozenset[tuple[RouteKind, str]]:
    """What the real bridge passed on for a session while it was recorded."""
    lines = (GOLDEN / "jazzy.jsonl").read_text(encoding="utf-8").splitlines()
    told = [one for one in map(json.loads, lines) if one["what"] == "admin"]
    return read_routes(((one["key"], json.dumps(one["value"]).encode()) for one in told), zid)


def test_routes_that_a_bridge_made_for_a_session_are_read():
    first = (GOLDEN / "jazzy.jsonl").read_text(encoding="utf-8").partition("\n")[0]
    assert {kind for kind, _ in golden_routes("elsewhere")} <= {RouteKind.SUBSCRIPTION}
    assert {
        (RouteKind.SERVICE, "/add_remote"),
        (RouteKind.ACTION_SERVER, "/remote_fibonacci"),
    } <= golden_routes(json.loads(first)["zid"])


@pytest.mark.parametrize(
    "value",
    [
        {"remote_routes": ["me:x"], "is_active": False},
        {"remote_routes": ["you:x"]},
        {"remote_routes": "me:x"},
        {},
        [],
        None,
    ],
)
def test_a_route_that_does_not_serve_a_session_is_none_for_it(value: object):
    def routes(one: object) -> frozenset[tuple[RouteKind, str]]:
        answer = (f"@/{ZID}/ros2/route/topic/sub/x", json.dumps(one).encode())
        return read_routes([answer, (f"@/{ZID}/ros2/route/topic/pub/y", b"{")], "me")

    assert routes(value) == frozenset()
    assert routes({"remote_routes": ["me:x"]}) == {(RouteKind.PUBLISHER, "/x")}


@pytest.mark.parametrize(
    ("reader", "reads"), [("0110bcad6454ee6b667d87d800000904", True), ("", False)]
)
def test_a_topic_is_passed_on_while_the_bridge_reads_it(reader: str, *, reads: bool):
    route = json.dumps({"remote_routes": [], "dds_reader": reader}).encode()
    found = read_routes([(f"@/{ZID}/ros2/route/topic/pub/x", route)], "me")
    assert found == ({(RouteKind.SUBSCRIPTION, "/x")} if reads else set())

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.errors import TokenError
from studio.ros.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from studio.ros.tokens import (
    EndpointKind,
    EndpointToken,
    NodeToken,
    parse_token,
    tokens_of_domain,
)

HASH = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
ZID = "8b20917502ee955ac4476e0266340d5c"
NODE = f"@ros2_lv/2/{ZID}/0/0/NN/%/%/talker"
# What a reader of buffer-aware topics that takes plain memory only says.
CPU_BACKENDS = "backends:cpu:"
PUBLISHER = (
    f"@ros2_lv/2/{ZID}/0/10/MP/%/%/talker/%chatter/std_msgs::msg::dds_::String_/{HASH}/::,7:,:,:,,"
)
SERVER = (
    "@ros2_lv/0/a1/3/4/SS/%/%robot%arm/adder/%robot%arm%add/"
    "example_interfaces::srv::dds_::AddTwoInts_/TypeHashNotSupported/::,10:,:,:,,"
)


def endpoint(token: str) -> EndpointToken:
    parsed = parse_token(token)
    assert isinstance(parsed, EndpointToken)
    return parsed


def test_a_node_is_read_and_written():
    node = parse_token(NODE)
    assert node == NodeToken(domain=2, zid=ZID, nid=0, namespace="/", name="talker")
    assert str(node) == NODE


def test_the_publisher_of_the_design_document_is_read_and_written():
    publisher = endpoint(PUBLISHER)
    assert publisher.kind is EndpointKind.PUBLISHER
    assert (publisher.name, publisher.type_name) == ("/chatter", "std_msgs/msg/String")
    assert (publisher.type_hash, publisher.eid, publisher.qos.depth) == (HASH, 10, 7)
    assert str(publisher) == PUBLISHER


def test_names_and_namespaces_keep_their_slashes():
    server = endpoint(SERVER)
    assert server.name == "/robot/arm/add"
    assert server.node.path == "/robot/arm/adder"
    assert str(server) == SERVER


@pytest.mark.parametrize("kind", EndpointKind)
def test_every_kind_of_endpoint_is_told_apart(kind: EndpointKind):
    assert endpoint(PUBLISHER.replace("/MP/", f"/{kind}/")).kind is kind


def test_chunks_after_the_qos_are_kept_and_backends_found():
    plain, buffered = endpoint(PUBLISHER), endpoint(f"{PUBLISHER}/later/{CPU_BACKENDS}")
    assert plain.backends is None
    assert buffered.backends == "backends:cpu:"
    assert str(buffered) == f"{PUBLISHER}/later/{CPU_BACKENDS}"


@pytest.mark.parametrize(
    "token",
    [
        "",
        "0/chatter",
        NODE.rpartition("/")[0],
        NODE.replace("@ros2_lv", "@ros3_lv"),
        NODE.replace("talker", ""),
        NODE.replace("/2/", "/two/"),
        NODE.replace("/0/0/", "/0/-1/"),
        NODE.replace("talker", "1talker"),
        NODE.replace("NN", "XX"),
        PUBLISHER.rpartition("/")[0],
        PUBLISHER.replace("dds_::", ""),
        PUBLISHER.replace("%chatter", "chatter"),
        PUBLISHER.replace(",7:", ",x:"),
        PUBLISHER.replace(",7:", ",-7:"),
        PUBLISHER.replace("/::,7", "/9::,7"),
        PUBLISHER.replace(":,,", ":,"),
        PUBLISHER.replace("/MP/", "//"),
    ],
)
def test_what_is_no_token_is_refused_with_one_sentence(token: str):
    with pytest.raises(TokenError, match="was not understood"):
        parse_token(token)


def test_all_tokens_of_a_domain_have_one_expression():
    assert tokens_of_domain(7) == "@ros2_lv/7/**"


PART = st.from_regex(r"[A-Za-z_][A-Za-z0-9_]{0,8}", fullmatch=True)
PATH = st.lists(PART, min_size=1, max_size=3).map(lambda parts: "/" + "/".join(parts))
NODES = st.builds(
    NodeToken,
    domain=st.integers(0, 232),
    zid=st.from_regex(r"[0-9a-f]{1,32}", fullmatch=True),
    nid=st.integers(0, 2**32),
    namespace=st.just("/") | PATH,
    name=PART,
    enclave=st.just("/") | PATH,
)
PROFILES = st.builds(
    QoSProfile,
    reliability=st.sampled_from([ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT]),
    durability=st.sampled_from([DurabilityPolicy.VOLATILE, DurabilityPolicy.TRANSIENT_LOCAL]),
    history=st.sampled_from([HistoryPolicy.KEEP_LAST, HistoryPolicy.KEEP_ALL]),
    depth=st.integers(1, 10**6),
)
ENDPOINTS = st.builds(
    EndpointToken,
    node=NODES,
    eid=st.integers(0, 2**32),
    kind=st.sampled_from(EndpointKind),
    name=PATH,
    type_name=st.sampled_from(["a/msg/T", "a/srv/T", "a/action/T_SendGoal"]),
    type_hash=st.just(HASH),
    qos=PROFILES,
    extra=st.sampled_from([(), (CPU_BACKENDS,), ("later", "backends:cuda:x;cpu:")]),
)


@given(NODES | ENDPOINTS)
def test_any_token_survives(token: NodeToken | EndpointToken):
    assert parse_token(str(token)) == token


@given(st.text(max_size=80) | st.text(alphabet="@ros2_lv/0%NMPS:,a", max_size=80))
def test_any_text_is_a_token_or_refused_by_name(text: str):
    for candidate in (text, "@ros2_lv/" + text, PUBLISHER + text, NODE.replace("talker", text)):
        try:
            token = parse_token(candidate)
        except TokenError:
            continue
        assert parse_token(str(token)) == token

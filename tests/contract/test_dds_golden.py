"""What the real bridge showed of a robot on DDS, recorded: `tests.support.dds_golden` writes it."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any, Final

import pytest

from studio.ros.attachment import ATTACHMENT_BYTES
from studio.ros.cdr import codec_of
from studio.ros.messages import types_of
from studio.ros.tokens import EndpointKind
from studio.ros.wire.bridges.admin import read_answers
from studio.ros.wire.bridges.bridge import Bridge, Met, bridges_of
from studio.ros.wire.bridges.dialect import (
    Route,
    RouteKind,
    announcement,
    parse_bridge_token,
    request_number,
)

FOLDER: Final = Path(__file__).parents[1] / "golden" / "dds_bridge"
KINDS: Final = ("jazzy", "humble", "namespace")


@cache
def recorded(kind: str) -> tuple[dict[str, Any], ...]:
    lines = (FOLDER / f"{kind}.jsonl").read_text(encoding="utf-8").splitlines()
    return tuple(json.loads(line) for line in lines)


def all_of(kind: str, what: str) -> list[dict[str, Any]]:
    return [one for one in recorded(kind) if one["what"] == what]


@cache
def bridge(kind: str) -> Bridge:
    """The bridge, made of what was recorded."""
    tokens = [one["key"] for one in all_of(kind, "token")]
    zids = [one for token in tokens if isinstance(one := parse_bridge_token(token), str)]
    routes = {t: one for t in tokens if isinstance(one := parse_bridge_token(t), Route)}
    answers = [(one["key"], json.dumps(one["value"]).encode()) for one in all_of(kind, "admin")]
    told = {zid: one for zid in zids if (one := read_answers(answers, zid)) is not None}
    ((zid, news),) = told.items()
    of_bridge = {token: one for token, one in routes.items() if one.zid == zid}
    settings = news.settings
    assert settings is not None
    (made,), _ = bridges_of([Met(zid, of_bridge, news, asked=True)], settings.domain)
    return made


@pytest.mark.parametrize("kind", KINDS)
def test_every_token_is_understood(kind: str):
    tokens = [one["key"] for one in all_of(kind, "token")]
    kinds = {one.kind for token in tokens if isinstance(one := parse_bridge_token(token), Route)}
    assert kinds == set(RouteKind)


@pytest.mark.parametrize("kind", KINDS)
def test_every_end_belongs_to_a_node_of_the_robot(kind: str):
    seen = bridge(kind)
    assert seen.version == "1.10.0"
    assert seen.ends
    nodes = {path for _, path in seen.nodes}
    assert {end.node for end in seen.ends} <= nodes
    prefix = seen.settings.namespace.rstrip("/") if seen.settings else ""
    assert all(path.startswith(f"{prefix}/") for path in nodes)
    assert seen.withheld == ()


@pytest.mark.parametrize("kind", KINDS)
def test_hashes_are_known_since_iron_and_are_those_of_rmw_zenoh(kind: str):
    ends = [one for one in bridge(kind).ends if one.type_hash]
    if kind == "humble":
        assert ends == []
        return
    types = types_of("jazzy")
    assert {one.kind for one in ends} >= set(EndpointKind)
    assert all(one.type_hash == types.hash_of(one.type_name) for one in ends)


@pytest.mark.parametrize("kind", KINDS)
def test_an_action_has_all_its_parts_at_both_ends(kind: str):
    ends = bridge(kind).ends
    served = {one.name for one in ends if one.kind is EndpointKind.SERVICE}
    called = {one.name for one in ends if one.kind is EndpointKind.CLIENT}
    told = {one.name for one in ends if one.kind is EndpointKind.PUBLISHER}
    heard = {one.name for one in ends if one.kind is EndpointKind.SUBSCRIPTION}
    for services, topics in ((served, told), (called, heard)):
        goals = [name for name in services if name.endswith("/_action/send_goal")]
        assert goals
        for name in goals:
            base = name.removesuffix("send_goal")
            assert {f"{base}cancel_goal", f"{base}get_result"} <= services
            assert {f"{base}feedback", f"{base}status"} <= topics


@pytest.mark.parametrize("kind", KINDS)
def test_samples_are_plain_cdr_without_attachment_stamped_by_the_bridge(kind: str):
    samples = all_of(kind, "sample")
    assert samples
    types = types_of("humble" if kind == "humble" else "jazzy")
    type_names = {one.name.removeprefix("/"): one.type_name for one in bridge(kind).ends}
    read = 0
    for one in samples:
        assert one["attachment"] is None
        assert one["timestamp"].endswith(f"/{bridge(kind).zid}")
        if one["key"] in type_names and one["payload"]:
            codec_of(types.message(type_names[one["key"]])).decode(bytes.fromhex(one["payload"]))
            read += 1
    assert read


@pytest.mark.parametrize("kind", KINDS)
def test_requests_of_dds_clients_are_numbered(kind: str):
    queries = [one for one in all_of(kind, "query") if one.get("attachment")]
    assert queries
    for one in queries:
        attachment = bytes.fromhex(one["attachment"])
        assert len(attachment) != ATTACHMENT_BYTES
        number = request_number(attachment)
        assert number is not None
        assert number.sequence > 0


def test_what_we_announce_is_written_as_the_bridge_writes_it():
    from studio.ros.tokens import EndpointToken, NodeToken

    seen = bridge("jazzy")
    token = next(
        one["key"]
        for one in all_of("jazzy", "token")
        if f"{seen.zid}/@ros2_lv/MP" in one["key"] and ":1::0,10:typehash" in one["key"]
    )
    route = parse_bridge_token(token)
    assert isinstance(route, Route)
    assert route.qos is not None
    node = NodeToken(0, seen.zid, 0, "/", "any")
    ours = announcement(
        EndpointToken(
            node, 1, EndpointKind.PUBLISHER, route.name, route.type_name, route.type_hash, route.qos
        )
    )
    assert ours == token.replace(":1::0,10:", ":1:0:0,10:")

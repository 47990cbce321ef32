"""What a router refuses of a peer is declared for that peer, as long as the peer shows it.

Here the router is told to refuse; routers of Zenoh 1.9 and later do so with real nodes, which
tests/contract/test_router_restart.py meets.
"""

from __future__ import annotations

import json
from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING

import zenoh

from studio.ros.wire.endpoints import parse_endpoint
from studio.ros.wire.router import start_router
from studio.ros.wire.session import open_session
from studio.ros.wire.settings import WireSettings
from studio.ros.wire.zenoh import close, declare_token, insert, live_tokens
from tests.support.certificates import make_certificates
from tests.support.wire import free_endpoint, open_test_session, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator, Mapping
    from pathlib import Path

    from studio.ros.wire.session import WireSession

PEER_ID = "ab12"
NODE = f"@ros2_lv/0/{PEER_ID}/0/0/NN/%/%/old"
KEPT = f"0/kept/std_msgs::msg::dds_::String_/RIHS01_00/@adv/pub/{PEER_ID}/3/_"
BRIDGE = f"@/{PEER_ID}/@ros2_lv"
REFUSES: dict[str, object] = {
    "enabled": True,
    "default_permission": "allow",
    "rules": [
        {
            "id": "tokens",
            "permission": "deny",
            "messages": ["liveliness_token"],
            "flows": ["ingress"],
            "key_exprs": ["**", "@ros2_lv/**", "**/@adv/**", "@/*/@ros2_lv/**"],
        }
    ],
    "subjects": [{"id": "peer", "zids": [PEER_ID]}],
    "policies": [{"rules": ["tokens"], "subjects": ["peer"]}],
}


@contextmanager
def refused_peer(
    endpoint: str, tokens: tuple[str, ...] = (NODE,), keys: Mapping[str, str] | None = None
) -> Generator[zenoh.Session]:
    """A session as rmw_zenoh's nodes have, of which the router of the tests takes no token."""
    config = zenoh.Config()
    protocol = endpoint.partition("/")[0]
    as_rmw_zenoh = {
        "id": f'"{PEER_ID}"',
        "mode": '"peer"',
        "connect/endpoints": json.dumps([endpoint]),
        "listen/endpoints": json.dumps([f"{protocol}/localhost:0"]),
        "scouting/multicast/enabled": "false",
        "scouting/gossip/target": '{"router": ["router", "peer"], "peer": ["router"]}',
    }
    for key, json5 in {**as_rmw_zenoh, **(keys or {})}.items():
        insert(config, key, json5)
    session = zenoh.open(config)
    try:
        kept = [declare_token(session, token) for token in tokens]
        yield session
        del kept
    finally:
        close(session)


def refusing(**overrides: str) -> dict[str, str]:
    return {"access_control": json.dumps(REFUSES), **overrides}


def seen(wire: WireSession, tokens: str = "@ros2_lv/**") -> set[str]:
    return set(live_tokens(wire.zenoh, tokens, 3.0))


def test_a_client_sees_what_the_router_refused_of_a_peer():
    endpoint = free_endpoint()
    with (
        start_router(parse_endpoint(endpoint), refusing()),
        refused_peer(endpoint, (NODE, KEPT, BRIDGE)),
        open_test_session(endpoint) as wire,
    ):
        wait_until("the node is seen", lambda: seen(wire) == {NODE})
        wait_until("what it keeps is seen", lambda: seen(wire, "**/@adv/**") == {KEPT})
        wait_until("the bridge is seen", lambda: seen(wire, "@/*/@ros2_lv/**") == {BRIDGE})


def test_what_the_peer_takes_back_is_gone_and_so_is_all_when_the_peer_ends():
    endpoint, other = free_endpoint(), NODE.replace("old", "other")
    with (
        start_router(parse_endpoint(endpoint), refusing()),
        open_test_session(endpoint) as wire,
    ):
        with refused_peer(endpoint, (NODE,)) as peer:
            declared = declare_token(peer, other)
            wait_until("both are seen", lambda: seen(wire) == {NODE, other})
            declared.undeclare()
            wait_until("one is seen", lambda: seen(wire) == {NODE})
        wait_until("none is seen", lambda: not seen(wire))


def test_a_session_that_outlives_the_router_sees_the_peer_at_the_next():
    endpoint = free_endpoint()
    with (
        start_router(parse_endpoint(endpoint), refusing()) as first,
        open_test_session(endpoint) as wire,
        refused_peer(endpoint),
    ):
        wait_until("the node is seen", lambda: seen(wire) == {NODE})
        first.close()
        wait_until("the router is gone", lambda: not wire.is_connected)
        with start_router(parse_endpoint(endpoint), refusing()):
            wait_until("the node is seen again", lambda: seen(wire) == {NODE})


def test_the_tokens_of_a_hundred_nodes_are_seen_again_after_a_restart_and_end_with_them():
    endpoint = free_endpoint()
    tokens = tuple(
        f"@ros2_lv/0/{PEER_ID}/{node}/{part}/NN/%/%/node_{node}_{part}"
        for node in range(100)
        for part in range(18)
    )
    with (
        start_router(parse_endpoint(endpoint), refusing()) as first,
        open_test_session(endpoint) as wire,
        ExitStack() as stack,
    ):
        with refused_peer(endpoint, tokens):
            wait_until("all are seen", lambda: seen(wire) == set(tokens))
            first.close()
            wait_until("the router is gone", lambda: not wire.is_connected)
            stack.enter_context(start_router(parse_endpoint(endpoint), refusing()))
            wait_until("all are seen again", lambda: seen(wire) == set(tokens))
        wait_until("none is seen", lambda: not seen(wire))
        assert wire.is_connected


def test_a_router_at_all_addresses_is_found_beside_it():
    port = parse_endpoint(free_endpoint()).port
    with (
        start_router(parse_endpoint(f"tcp/0.0.0.0:{port}"), refusing()),
        refused_peer(f"tcp/127.0.0.1:{port}"),
        open_test_session(f"tcp/127.0.0.1:{port}") as wire,
    ):
        wait_until("the node is seen", lambda: seen(wire) == {NODE})


def test_a_router_that_asks_for_names_admits_what_is_beside_it(tmp_path: Path):
    users = tmp_path / "users.txt"
    users.write_text("robot:word\nstudio:secret\n")
    root, endpoint = "transport/auth/usrpwd", free_endpoint()
    # Whoever is to be connected to, as peers are, needs the list as well.
    asks = {f"{root}/dictionary_file": json.dumps(str(users))}
    says = {**asks, f"{root}/user": '"studio"', f"{root}/password": '"secret"'}
    with (
        start_router(parse_endpoint(endpoint), refusing(**asks)),
        refused_peer(endpoint, keys=says),
        open_session_as(endpoint, says) as wire,
    ):
        wait_until("the node is seen", lambda: seen(wire) == {NODE})


def test_a_router_behind_tls_is_reached_with_its_own_certificates(tmp_path: Path):
    made, endpoint = make_certificates(tmp_path), free_endpoint("tls")
    keys = {
        f"transport/link/tls/{key}": json.dumps(str(value))
        for key, value in (
            ("root_ca_certificate", made.authority),
            ("listen_private_key", made.key),
            ("listen_certificate", made.certificate),
        )
    }
    with (
        start_router(parse_endpoint(endpoint), refusing(**keys)),
        refused_peer(endpoint, keys=keys),
        open_session_as(endpoint, keys) as wire,
    ):
        wait_until("the node is seen", lambda: seen(wire) == {NODE})


def test_nothing_beside_a_router_can_be_connected_to():
    endpoint = free_endpoint()
    with start_router(parse_endpoint(endpoint)) as router, open_test_session(endpoint) as wire:
        wait_until("the relay has its link", lambda: len(links_of(wire, router.zid)) == 2)
        answers = wire.zenoh.get("@/*/peer")
        assert [answer for answer in answers if answer.ok] == []


def links_of(wire: WireSession, router: str) -> list[object]:
    """Who is linked with a router, by what it says itself."""
    for reply in wire.zenoh.get(f"@/{router}/router"):
        if reply.ok is not None:
            return json.loads(reply.ok.payload.to_bytes())["sessions"]
    return []


def open_session_as(endpoint: str, keys: Mapping[str, str]) -> WireSession:
    return open_session(WireSettings(connect=(endpoint,), overrides=keys))

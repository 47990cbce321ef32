"""The router of our own: alone in a process, beside another that starts at once, and ended."""

from __future__ import annotations

import json
import signal
import socket
import subprocess
import sys
from contextlib import ExitStack, closing, contextmanager, suppress
from typing import TYPE_CHECKING

import pytest

from studio.errors import RouterNotStartedError, WireSettingsError
from studio.ros.wire.endpoints import parse_endpoint
from studio.ros.wire.router import router_choice, start_router
from studio.ros.wire.session import RouterWatch, open_session, open_wire
from studio.ros.wire.settings import WireSettings
from studio.ros.wire.zenoh import declare_publisher, declare_subscription
from tests.support.patience import ended_within
from tests.support.wire import (
    PATIENCE_S,
    ConditionNotMetError,
    free_endpoint,
    open_test_session,
    router_at,
    running_router,
    wait_until,
)

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

    import zenoh

    from studio.ros.wire.zenoh import Incoming, Outgoing

END_S = 2.0

AS_RMW_ZENOH: dict[str, object] = {
    "mode": "peer",
    "listen": {"endpoints": ["tcp/localhost:0"]},
    "scouting": {
        "multicast": {"enabled": False},
        "gossip": {"enabled": True, "target": {"router": ["router", "peer"], "peer": ["router"]}},
    },
}

ROUTER = """
import sys
from studio.ros.wire.router import run_router
run_router(sys.argv[1], lambda endpoint: print(endpoint, flush=True))
"""

OPENED = """
import sys
from studio.ros.wire.session import open_wire
from studio.ros.wire.session import open_session
from studio.ros.wire.settings import WireSettings
print("ready", flush=True)
sys.stdin.readline()
with open_wire(WireSettings(connect=(sys.argv[1],))) as wire:
    print("own" if wire.router else "joined", flush=True)
    sys.stdin.readline()
"""


@contextmanager
def process(code: str, endpoint: str) -> Generator[subprocess.Popen[str]]:
    started = subprocess.Popen(
        [sys.executable, "-c", code, endpoint],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    with started:
        try:
            yield started
        finally:
            started.kill()


def said(started: subprocess.Popen[str]) -> str:
    assert started.stdout is not None
    return started.stdout.readline().strip()


def tell(started: subprocess.Popen[str]) -> None:
    assert started.stdin is not None
    started.stdin.write("\n")
    started.stdin.flush()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_router_alone_carries_sessions_and_ends_at_once_by_a_signal(number: signal.Signals):
    with process(ROUTER, free_endpoint()) as router:
        endpoint = said(router)
        with open_test_session(endpoint) as wire, RouterWatch(wire) as watch:
            assert watch.is_connected
            router.send_signal(number)
            assert ended_within(router, END_S) == 0
            assert watch.wait_for(connected=False, timeout_s=PATIENCE_S)


def test_a_peer_that_falls_silent_in_the_handshake_does_not_hold_up_the_end():
    with process(ROUTER, free_endpoint()) as router:
        at = parse_endpoint(said(router))
        with closing(socket.create_connection((at.host, at.port))):
            router.send_signal(signal.SIGTERM)
            assert ended_within(router, END_S) == 0


def test_of_two_that_start_at_once_one_has_the_router_and_the_other_joins():
    endpoint = free_endpoint()
    with process(OPENED, endpoint) as one, process(OPENED, endpoint) as other:
        assert [said(one), said(other)] == ["ready", "ready"]
        tell(one)
        tell(other)
        assert sorted([said(one), said(other)]) == ["joined", "own"]


def test_who_joined_is_connected_again_when_another_has_the_router():
    endpoint = free_endpoint()
    with process(OPENED, endpoint) as first, ExitStack() as stack:
        assert said(first) == "ready"
        tell(first)
        assert said(first) == "own"
        wire = stack.enter_context(open_wire(WireSettings(connect=(endpoint,))))
        assert wire.router is None
        watch = stack.enter_context(RouterWatch(wire))
        first.kill()
        assert watch.wait_for(connected=False, timeout_s=PATIENCE_S)
        third = stack.enter_context(open_wire(WireSettings(connect=(endpoint,))))
        assert third.router is not None
        assert watch.wait_for(connected=True, timeout_s=PATIENCE_S)


def test_nodes_in_mode_peer_as_those_of_rmw_zenoh_hear_ours_and_each_other_once(tmp_path: Path):
    """They join the router, learn of each other by it, and link directly."""
    with ExitStack() as stack:
        endpoint = stack.enter_context(running_router())
        file = tmp_path / "session.json5"
        file.write_text(json.dumps({**AS_RMW_ZENOH, "connect": {"endpoints": [endpoint]}}))
        as_peer = WireSettings(connect=(), config_file=str(file))
        peers = [stack.enter_context(open_session(as_peer)) for _ in range(2)]
        wires = [*peers, stack.enter_context(open_test_session(endpoint))]
        wait_until("the peers to link", lambda: all(list(p.zenoh.info.peers_zid()) for p in peers))
        heard = [declare_subscription(w.zenoh, "0/a", 100, reliable=True) for w in wires]
        spoken = [declare_publisher(w.zenoh, "0/a", blocking=True, reliable=True) for w in wires]
        wait_until("all to hear all", lambda: all_hear(spoken, heard, b"greeting"))
        assert all_hear(spoken, heard, b"word")


def all_hear(spoken: list[Outgoing], heard: list[Incoming[zenoh.Sample]], word: bytes) -> bool:
    """Everybody says the word; whether each hears it from each in time, and from nobody twice."""
    for publisher in spoken:
        publisher.put(word)
    counts = [0] * len(heard)

    def is_enough() -> bool:
        for at, one in enumerate(heard):
            while (sample := one.try_recv()) is not None:
                counts[at] += sample.payload.to_bytes() == word
        return min(counts) >= len(spoken)

    with suppress(ConditionNotMetError):
        wait_until("the word", is_enough, 1.0 if word == b"greeting" else PATIENCE_S)
    return counts == [len(spoken)] * len(heard)


def test_an_endpoint_that_is_held_is_told_as_such():
    with router_at(free_endpoint()) as router:
        with pytest.raises(RouterNotStartedError, match="another program") as caught:
            start_router(router.endpoint)
        assert caught.value.held


def test_settings_that_zenoh_refuses_are_told():
    endpoint = parse_endpoint(free_endpoint("tls"))
    with pytest.raises(RouterNotStartedError) as caught:
        start_router(endpoint, {"transport/link/tls/listen_private_key": json.dumps("/no/key")})
    assert not caught.value.held
    assert ".rs" not in str(caught.value)


def test_keys_that_are_of_sessions_make_no_router_a_client():
    endpoint = free_endpoint()
    overrides = {"mode": '"client"', "connect/endpoints": json.dumps([endpoint])}
    with open_wire(WireSettings(connect=(endpoint,), overrides=overrides)) as wire:
        assert wire.router is not None


def test_a_router_that_ended_leaves_its_place_free():
    endpoint = free_endpoint()
    for _ in range(3):
        router_at(endpoint).close()
    router = router_at(endpoint)
    router.close()
    router.close()


def test_a_choice_is_auto_off_or_a_place():
    assert router_choice("auto").starts
    assert not router_choice("off").starts
    assert router_choice("tcp/127.0.0.1:1").endpoint == parse_endpoint("tcp/127.0.0.1:1")


def test_a_router_takes_its_configuration_from_a_file_and_listens_where_it_is_told(tmp_path: Path):
    file = tmp_path / "router.json5"
    file.write_text('{id: "1234abcd", mode: "peer", listen: {endpoints: ["tcp/192.0.2.1:9"]}}')
    settings = WireSettings(connect=(free_endpoint(),), router_config_file=str(file))
    with open_wire(settings) as wire:
        assert wire.router is not None
        assert wire.router.zid == "1234abcd"
        assert wire.is_connected


def test_a_file_of_configuration_that_is_none_is_one_sentence(tmp_path: Path):
    file = tmp_path / "broken.json5"
    for text in (None, "{mode: "):
        if text is not None:
            file.write_text(text)
        with pytest.raises(WireSettingsError, match=r"ZENOH_ROUTER_CONFIG_URI names .*broken"):
            start_router(parse_endpoint(free_endpoint()), config_file=str(file))

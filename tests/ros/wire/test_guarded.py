"""A router that lets in only who has a certificate, each into their own domain."""

from __future__ import annotations

import json
import socket
from contextlib import contextmanager
from queue import Queue
from typing import TYPE_CHECKING, Any, cast

import pytest

from studio.classroom.nodes.pool import Pool
from studio.errors import NotAdmittedError, RouterNotStartedError
from studio.ros.messages import message
from studio.ros.node.context import Context
from studio.ros.node.node import Node
from studio.ros.wire.bridges.dialect import TOKENS
from studio.ros.wire.certificates import new_secret
from studio.ros.wire.credentials import Credentials
from studio.ros.wire.endpoints import parse_endpoint
from studio.ros.wire.guarded import DomainUser, start_guarded_router
from studio.ros.wire.router import start_router
from studio.ros.wire.session import RouterWatch, open_session, open_wire
from studio.ros.wire.settings import WireSettings
from studio.ros.wire.zenoh import admin_answers, declare_token, live_tokens
from tests.support.node_pair import context_at, spin_until
from tests.support.wire import PATIENCE_S, free_endpoint, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

ADA, BOB = 41, 42
STRING = "std_msgs/msg/String"
TRIGGER = "std_srvs/srv/Trigger"
POOL = Pool(new_secret(), (ADA, BOB))
USERS = [
    DomainUser(POOL.studio_name, (ADA, BOB)),
    DomainUser(POOL.name_of(ADA), (ADA,)),
    DomainUser(POOL.name_of(BOB), (BOB,)),
]


@contextmanager
def guarded(users: list[DomainUser] = USERS, at: str = "") -> Generator[str]:
    endpoint = parse_endpoint(at or free_endpoint("tls"))
    with start_guarded_router(endpoint, POOL.router, users):
        yield endpoint.text


def settings(endpoint: str, domain: int, own: Credentials | None = None) -> WireSettings:
    """Those of a session in a domain, by the certificate of that domain, or by another one."""
    overrides = (own or POOL.of(domain)).of_session()
    return WireSettings(connect=(endpoint,), domain=domain, overrides=overrides)


@contextmanager
def node(endpoint: str, domain: int, name: str, own: Credentials | None = None) -> Generator[Node]:
    context = Context.over(open_session(settings(endpoint, domain, own)), owns_wire=True)
    try:
        yield Node(name, context=context)
    finally:
        context.shutdown()


def heard(one: Node, topic: str = "/chatter") -> Queue[str]:
    found: Queue[str] = Queue()
    one.create_subscription(message(STRING), topic, lambda said: found.put(said.data), 10)
    return found


def paths(one: Node) -> set[str]:
    return {other.path for other in one.context.graph.nodes()}


def test_in_a_domain_nodes_hear_each_other_and_the_studio_sees_them():
    with (
        guarded() as endpoint,
        node(endpoint, ADA, "talker") as talker,
        node(endpoint, ADA, "listener") as listener,
        node(endpoint, ADA, "looks", POOL.studio) as looks,
    ):
        got = heard(listener)
        out = talker.create_publisher(message(STRING), "/chatter", 10)
        wait_until("it has a subscriber", lambda: out.get_subscription_count() == 1)
        wait_until("the studio sees both", lambda: {"/talker", "/listener"} <= paths(looks))

        def told() -> bool:
            out.publish(message(STRING)(data="hello"))
            return not got.empty()

        spin_until(told, listener)


def test_of_another_domain_nobody_hears_sees_or_asks_anything():
    with (
        guarded() as endpoint,
        node(endpoint, ADA, "ada") as ada,
        # By Bob's certificate in Ada's domain: the certificate counts, not what is asked for.
        node(endpoint, ADA, "bob", POOL.of(BOB)) as bob,
        node(endpoint, BOB, "own") as own,
        node(endpoint, ADA, "looks", POOL.studio) as looks,
    ):
        kind = ada.context.wire.types.service(TRIGGER)
        ada.create_service(kind, "/secret", lambda _, answer: answer)
        bob.create_service(kind, "/secret", lambda _, answer: answer)
        got, got_by_bob = heard(ada), heard(bob)
        from_ada = ada.create_publisher(message(STRING), "/chatter", 10)
        from_bob = bob.create_publisher(message(STRING), "/chatter", 10)
        from_studio = looks.create_publisher(message(STRING), "/chatter", 10)

        def told() -> bool:
            from_bob.publish(message(STRING)(data="evil"))
            from_ada.publish(message(STRING)(data="mine"))
            from_studio.publish(message(STRING)(data="look"))
            return "look" in got.queue and not got_by_bob.empty()

        spin_until(told, ada, bob)
        assert set(got.queue) == {"mine", "look"}
        assert set(got_by_bob.queue) == {"evil"}  # within their own session
        wait_until("Ada sees the studio", lambda: "/looks" in paths(ada))
        wait_until("the studio sees Ada", lambda: "/ada" in paths(looks))
        wait_until("they see themselves", lambda: bool(paths(bob) and paths(own)))
        assert paths(looks) == {"/ada", "/looks"}
        assert paths(bob) == {"/bob"}
        assert paths(own) == {"/own"}
        graph = looks.context.graph
        wait_until("Ada's service is there", lambda: bool(graph.servers("/secret")))
        assert len(graph.servers("/secret")) == 1
        for tokens in ("@ros2_lv/**", f"@ros2_lv/{ADA}/**"):
            seen = live_tokens(own.context.wire.zenoh, tokens, PATIENCE_S)
            assert not [one for one in seen if f"/{ADA}/" in one]


def test_a_token_in_another_domain_is_shown_to_nobody():
    with (
        guarded() as endpoint,
        node(endpoint, BOB, "bob") as bob,
        node(endpoint, ADA, "looks", POOL.studio) as looks,
    ):
        wire = bob.context.wire
        kept = [
            declare_token(wire.zenoh, f"@ros2_lv/{domain}/{wire.zid}/9/9/NN/%/%/evil")
            for domain in (ADA, BOB)
        ]
        seen = looks.context.wire.zenoh
        wait_until(
            "that of the own domain is there",
            lambda: any(live_tokens(seen, f"@ros2_lv/{BOB}/*/9/9/**", PATIENCE_S)),
        )
        assert not any(live_tokens(seen, f"@ros2_lv/{ADA}/*/9/9/**", PATIENCE_S))
        assert len(kept) == 2


def test_a_student_cannot_pass_for_a_bridge_to_dds():
    """Neither by showing and telling what one does, nor by sending where one sends."""
    with (
        guarded() as endpoint,
        node(endpoint, BOB, "bob") as bob,
        node(endpoint, BOB, "looks", POOL.studio) as looks,
    ):
        got = heard(looks)
        zenoh, zid = cast("Any", bob.context.wire.zenoh), bob.context.wire.zid
        asked: list[object] = []
        answers = zenoh.declare_queryable(f"@/{zid}/ros2/**", asked.append)
        kept = [
            declare_token(zenoh, f"@/{one}/@ros2_lv{route}")
            for one in (zid, "0badc0de")
            for route in ("", "/MP/chatter/std_msgs§msg§String/:1::0,10")
        ]
        wait_until("the studio sees Bob", lambda: "/bob" in paths(looks))
        seen = looks.context.wire.zenoh
        assert not any(live_tokens(seen, TOKENS, PATIENCE_S))
        assert not list(admin_answers(seen, f"@/{zid}/ros2/**", PATIENCE_S))
        assert looks.context.graph.settle(PATIENCE_S)
        zenoh.put("chatter", b"\0\1\0\0\3\0\0\0no\0")
        out = bob.create_publisher(message(STRING), "/chatter", 10)

        def told() -> bool:
            out.publish(message(STRING)(data="rmw"))
            return not got.empty()

        spin_until(told, looks)
        assert looks.context.graph.bridges == ()
        assert (asked, set(got.queue), len(kept)) == ([], {"rmw"}, 4)
        answers.undeclare()


def test_without_a_certificate_or_with_one_of_another_pool_nobody_joins():
    stranger = Pool(new_secret(), (ADA, BOB)).of(ADA)
    mixed = Credentials(POOL.of(ADA).authority, stranger.certificate, stranger.key)
    with guarded() as endpoint:
        for refused in (
            WireSettings(connect=(endpoint,), domain=ADA),
            settings(endpoint, ADA, stranger),
            settings(endpoint, ADA, mixed),
        ):
            with pytest.raises(NotAdmittedError, match="lets nobody in without"):
                open_wire(refused, "off")


def test_a_students_certificate_is_no_routers():
    """Else one student could pass for the router before another."""
    false = POOL.of(BOB)
    endpoint = parse_endpoint(free_endpoint("tls"))
    with (
        start_guarded_router(endpoint, false, USERS),
        pytest.raises(NotAdmittedError),
    ):
        open_wire(settings(endpoint.text, ADA), "off")


@pytest.mark.sweep
def test_who_connects_and_says_nothing_is_let_go_and_keeps_nobody_out():
    with guarded() as endpoint:
        place = parse_endpoint(endpoint)
        silent = [socket.create_connection((place.host, place.port)) for _ in range(20)]
        try:
            with open_session(settings(endpoint, ADA)) as wire:
                assert wire.is_connected
            for one in silent:
                one.settimeout(PATIENCE_S)
                assert one.recv(1) == b""
        finally:
            for one in silent:
                one.close()


def test_a_router_without_a_user_lets_go_of_them_and_the_others_come_back():
    with guarded() as endpoint:
        ada = open_session(settings(endpoint, ADA))
        bob = open_session(settings(endpoint, BOB))
    with ada, bob, RouterWatch(ada) as watch, guarded(USERS[:2], endpoint):
        kept = [
            declare_token(one.zenoh, f"@ros2_lv/{one.domain}/{one.zid}/0/0/NN/%/%/n")
            for one in (ada, bob)
        ]
        assert watch.wait_for(connected=True, timeout_s=PATIENCE_S)
        with open_session(settings(endpoint, ADA, POOL.studio)) as studio:
            wait_until(
                "Ada's node is there again",
                lambda: any(live_tokens(studio.zenoh, f"@ros2_lv/{ADA}/**", PATIENCE_S)),
            )
            assert not any(live_tokens(studio.zenoh, f"@ros2_lv/{BOB}/**", PATIENCE_S))
        assert len(kept) == 2


def test_nodes_join_by_way_of_a_router_of_their_own_machine():
    near = free_endpoint()
    with (
        guarded() as endpoint,
        start_router(parse_endpoint(near), POOL.of(ADA).of_session(), joins=(endpoint,)),
        context_at(near) as context,
        node(endpoint, 0, "looks", POOL.studio),
    ):
        wire = context.wire
        kept = [
            declare_token(wire.zenoh, f"@ros2_lv/{domain}/{wire.zid}/7/7/NN/%/%/behind")
            for domain in (ADA, BOB)
        ]
        with open_session(settings(endpoint, ADA, POOL.studio)) as studio:
            wait_until(
                "it is seen in the domain",
                lambda: any(live_tokens(studio.zenoh, f"@ros2_lv/{ADA}/*/7/7/**", PATIENCE_S)),
            )
            assert not any(live_tokens(studio.zenoh, f"@ros2_lv/{BOB}/**", PATIENCE_S))
        assert len(kept) == 2


def test_a_place_that_is_held_is_one_sentence():
    with guarded() as endpoint, pytest.raises(RouterNotStartedError) as error:
        start_guarded_router(parse_endpoint(endpoint), POOL.router, USERS)
    assert error.value.held


def test_the_same_secret_makes_the_same_keys_and_another_one_others():
    again, other = Pool(POOL.secret, POOL.domains), Pool(new_secret(), POOL.domains)
    assert again.of(ADA).key == POOL.of(ADA).key
    assert len({one.of(domain).key for one in (POOL, other) for domain in (ADA, BOB)}) == 4
    assert json.loads(POOL.of(ADA).of_session()["transport/link/tls/enable_mtls"]) is True
    with guarded() as endpoint, open_session(settings(endpoint, ADA, again.of(ADA))) as wire:
        assert wire.is_connected

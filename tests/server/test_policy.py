from __future__ import annotations

import pytest

from studio.server.policy import WORKER_POLICY, probe_policy

ONE = "http://one.example:8100/room/join?pass=secret"


def test_a_probe_reaches_the_origins_of_the_neighbours_and_nothing_more():
    policy = probe_policy((ONE, "https://two.example/join?pass=secret", ONE))
    assert "connect-src 'self' http://one.example:8100 https://two.example;" in policy
    assert policy.replace(" http://one.example:8100 https://two.example", "") == WORKER_POLICY


@pytest.mark.parametrize(
    "address",
    [
        "http://one.example; script-src *",
        "http://*/join",
        "http://one.example,evil.example",
        "http://user@one.example/",
        "javascript:alert(1)",
        "//one.example/",
        "http://one.example\n/",
        "http://[::1]:8100/join",
        "",
    ],
)
def test_what_is_no_plain_address_gets_into_no_policy(address: str):
    assert probe_policy((address,)) == WORKER_POLICY

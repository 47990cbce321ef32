from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from starlette.datastructures import Headers

from studio.errors import SettingsError
from studio.server.front import Caller, Front, base_path, proxy_addresses
from studio.server.origin import Authority, KnownHosts

PROXY = "203.0.113.1"
FAR = {"x-forwarded-for": "198.51.100.7", "x-forwarded-proto": "https"}


def front(base: str = "") -> Front:
    return Front(KnownHosts.of("127.0.0.1", "robots.example"), 8765, base, frozenset({PROXY}))


def caller(address: str, headers: dict[str, str], scheme: str = "http") -> Caller | None:
    scope: dict[str, Any] = {"client": (address, 5), "scheme": scheme}
    return front().caller(scope, Headers(headers))


def test_directly_the_address_is_that_of_the_connection_whatever_headers_say():
    found = caller("198.51.100.9", {"host": "127.0.0.1:8765", **FAR})
    assert found == Caller(Authority("127.0.0.1", 8765), "198.51.100.9", is_secure=False)
    assert caller("198.51.100.9", {"host": "evil.example", **FAR}) is None
    assert caller("198.51.100.9", {}) is None


def test_through_a_trusted_proxy_it_is_the_one_that_the_proxy_saw():
    found = caller(PROXY, {"host": "robots.example", **FAR})
    assert found == Caller(Authority("robots.example", None), "198.51.100.7", is_secure=True)
    named = caller(PROXY, {"host": "upstream:1", "x-forwarded-host": "robots.example:444", **FAR})
    assert named is not None
    assert named.host == Authority("robots.example", 444)
    assert caller(PROXY, {"host": "evil.example", **FAR}) is None


@pytest.mark.parametrize(
    ("passed", "expected"),
    [
        ("10.9.9.9, 198.51.100.7", "198.51.100.7"),
        (f"10.9.9.9, 198.51.100.7, {PROXY}", "198.51.100.7"),
        (PROXY, PROXY),
        ("", PROXY),
    ],
)
def test_what_stands_before_it_may_be_made_up(passed: str, expected: str):
    found = caller(PROXY, {"host": "robots.example", "x-forwarded-for": passed})
    assert found is not None
    assert found.address == expected


def test_a_public_name_is_one_of_ours():
    assert caller("198.51.100.9", {"host": "robots.example"}) is not None


@given(st.text(max_size=300), st.text(max_size=300))
def test_no_header_of_a_proxy_breaks_it(passed: str, host: str):
    headers = {"host": "a", "x-forwarded-for": passed, "x-forwarded-host": host}
    scope: dict[str, Any] = {"client": (PROXY, 5), "scheme": "http"}
    raw = [(name.encode(), value.encode("utf-8")) for name, value in headers.items()]
    found = front().caller(scope, Headers(raw=raw))
    assert found is None or len(found.address) <= 64


def test_of_several_lines_the_last_is_the_proxys():
    raw = [(b"host", b"robots.example"), (b"x-forwarded-for", b"10.0.0.1")]
    raw.append((b"x-forwarded-for", b"198.51.100.7"))
    scope: dict[str, Any] = {"client": (f"::ffff:{PROXY}", 5), "scheme": "http"}
    found = front().caller(scope, Headers(raw=raw))
    assert found is not None
    assert found.address == "198.51.100.7"


@pytest.mark.parametrize(
    ("path", "expected"),
    [
        ("/studio/d/rover", "/d/rover"),
        ("/studio/", "/"),
        ("/d/rover", "/d/rover"),
        ("/studios/d", "/studios/d"),
        ("/", "/"),
    ],
)
def test_the_sub_path_is_taken_off_if_the_proxy_left_it(path: str, expected: str):
    scope: dict[str, Any] = {"path": path, "raw_path": path.encode()}
    assert front("/studio").enter(scope)
    assert (scope["path"], scope["raw_path"]) == (expected, expected.encode())


def test_the_sub_path_without_its_slash_is_another_address():
    scope: dict[str, Any] = {"path": "/studio", "raw_path": b"/studio"}
    assert not front("/studio").enter(scope)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", ""),
        ("/", ""),
        ("studio", "/studio"),
        ("/a/b-c_1/", "/a/b-c_1"),
        ("/~me/x.y", "/~me/x.y"),
    ],
)
def test_a_sub_path_is_written_in_one_way(text: str, expected: str):
    assert base_path(text) == expected


@pytest.mark.parametrize("text", ["/a b", '/"', "/a//b", "/ä", "/a?b", "/<x>", "/..", "http://x/"])
def test_what_cannot_stand_in_an_address_is_no_sub_path(text: str):
    with pytest.raises(SettingsError, match="--base-path"):
        base_path(text)


def test_a_proxy_is_named_by_its_address():
    assert proxy_addresses(["127.0.0.1", "::1"]) == {"127.0.0.1", "::1"}
    with pytest.raises(SettingsError, match="--trusted-proxy"):
        proxy_addresses(["proxy.example"])

"""What a session shows is known to those who follow it, at once."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.wire import open_test_session

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.ros.wire.session import WireSession

TOKEN = "@ros2_lv/0/{zid}/0/{number}/NN/%/%/talker"


@pytest.fixture
def wire(endpoint: str) -> Iterator[WireSession]:
    with open_test_session(endpoint) as found:
        yield found


def token_of(wire: WireSession, number: int) -> str:
    return TOKEN.format(zid=wire.zid, number=number)


def test_followers_are_told_what_is_shown_and_what_comes_and_goes(wire: WireSession):
    first, second = token_of(wire, 0), token_of(wire, 1)
    shown = wire.own_tokens.show(first)
    told: list[tuple[str, bool]] = []
    leave = wire.own_tokens.follow(lambda token, is_shown: told.append((token, is_shown)))
    assert told == [(first, True)]
    other = wire.own_tokens.show(second)
    shown.undeclare()
    assert told == [(first, True), (second, True), (first, False)]
    assert first not in wire.own_tokens
    assert second in wire.own_tokens
    leave()
    leave()
    other.undeclare()
    assert len(told) == 3

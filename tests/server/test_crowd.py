from __future__ import annotations

from typing import TYPE_CHECKING

from studio.protocol.roles import Role, Visitor
from studio.server.crowd import VIEWER_CONNECTIONS_MAX, Allowance, Crowd

if TYPE_CHECKING:
    import pytest


class Held:
    """A connection of which is known whether it was ended."""

    def __init__(self) -> None:
        self.ended = False

    def abort(self) -> None:
        self.ended = True


def test_after_a_rest_many_units_are_spent_at_once_and_then_as_many_as_are_earned():
    allowance = Allowance(10, 100)
    assert allowance.spend(100, 1000) == 0
    assert allowance.spend(5, 1000) == 0.5
    assert allowance.spend(5, 1001) == 0
    assert allowance.spend(101, 1100) == 0.1


def test_of_too_many_strangers_the_oldest_is_ended():
    crowd = Crowd(descriptors=80)
    held = [Held() for _ in range(crowd.strangers_max + 3)]
    for one in held:
        crowd.arrive(one)
    assert [one.ended for one in held[:4]] == [True, True, True, False]


def test_who_was_recognised_is_not_ended_for_strangers():
    crowd = Crowd(descriptors=80)
    known = Held()
    crowd.arrive(known)
    assert crowd.recognise(known, Visitor(Role.GUEST, "a"))
    for _ in range(crowd.strangers_max + 3):
        crowd.arrive(Held())
    assert not known.ended


def test_one_viewer_has_so_many_connections_and_another_is_not_refused_for_it():
    crowd = Crowd(descriptors=10_000)
    greedy, other = Visitor(Role.GUEST, "a"), Visitor(Role.GUEST, "b")
    held = [Held() for _ in range(VIEWER_CONNECTIONS_MAX)]
    assert all(crowd.recognise(one, greedy) for one in held)
    assert not crowd.recognise(Held(), greedy)
    assert crowd.recognise(held[0], greedy)
    assert crowd.recognise(Held(), other)
    crowd.leave(held[0])
    assert crowd.recognise(Held(), greedy)


def test_viewers_together_leave_room_for_the_presenter():
    crowd = Crowd(descriptors=100)
    admitted = [crowd.recognise(Held(), Visitor(Role.GUEST, str(n))) for n in range(200)]
    assert sum(admitted) == crowd.viewers_max
    assert crowd.viewers_max + crowd.strangers_max < 100
    assert all(crowd.recognise(Held(), Visitor(Role.PRESENTER, "p")) for _ in range(200))


def test_a_viewer_s_flood_costs_the_presenter_nothing():
    crowd = Crowd()
    presenter = Held()
    crowd.recognise(presenter, Visitor(Role.PRESENTER, "p"))
    for number in range(100):
        viewer = Held()
        crowd.recognise(viewer, Visitor(Role.GUEST, str(number)))
        pause_s = crowd.spend(viewer, 10_000)
        assert pause_s > 1
    assert crowd.spend(presenter, 1_000) == 0


def test_refused_strangers_cost_one_line_a_minute(
    caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
):
    clock_s = [100.0]
    monkeypatch.setattr("time.monotonic", lambda: clock_s[0])
    crowd = Crowd()
    for _ in range(1_000):
        crowd.refuse("this is no HTTP request")
    assert len(caplog.records) == 1
    clock_s[0] += 61
    crowd.refuse("the headers are too long")
    (_, line) = caplog.messages
    assert "the headers are too long (999 others since" in line
    assert len(caplog.records) == 2

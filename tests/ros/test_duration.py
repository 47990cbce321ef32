from __future__ import annotations

from studio.ros.duration import Duration


def test_seconds_and_nanoseconds_are_added():
    assert Duration(seconds=1.5, nanoseconds=7).nanoseconds == 1_500_000_007
    assert Duration(seconds=1) < Duration(seconds=2)
    assert repr(Duration(nanoseconds=5)) == "Duration(nanoseconds=5)"

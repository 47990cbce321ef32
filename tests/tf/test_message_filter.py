from __future__ import annotations

from studio.errors import ExtrapolationError, UnconnectedFramesError, UnknownFrameError
from studio.tf.buffer import TransformBuffer
from studio.tf.message_filter import MessageFilter
from tests.support.transforms import S, Told, columns


def known_until(stamp_ns: int) -> TransformBuffer:
    buffer = TransformBuffer()
    for at_ns in (stamp_ns - S, stamp_ns):
        buffer.put(columns(Told("map", "laser", at_ns, (at_ns / S, 0.0, 0.0))))
    return buffer


def test_a_message_whose_transform_is_there_has_its_place_at_once():
    scans = MessageFilter[str](known_until(10 * S))
    scans.add("scan", "laser", 9 * S + S // 2, 0)
    (settled,) = scans.poll("map", 0)
    assert settled.pose is not None
    assert (settled.item, settled.pose.xyz, settled.error) == ("scan", (9.5, 0.0, 0.0), None)
    assert len(scans) == 0


def test_a_message_waits_for_a_transform_that_comes_after_it():
    buffer = known_until(10 * S)
    scans = MessageFilter[str](buffer)
    scans.add("early", "laser", 11 * S, 0)
    scans.add("now", "laser", 10 * S, 0)
    assert [one.item for one in scans.poll("map", 0)] == ["now"]
    assert scans.poll("map", S // 2) == []
    buffer.put(columns(Told("map", "laser", 12 * S, (12.0, 0.0, 0.0))))
    (settled,) = scans.poll("map", S // 2)
    assert settled.pose is not None
    assert settled.pose.xyz == (11.0, 0.0, 0.0)


def test_who_waited_in_vain_is_told_why():
    scans = MessageFilter[str](known_until(10 * S), wait_ns=S)
    scans.add("future", "laser", 11 * S, 0)
    scans.add("camera", "camera", 10 * S, 0)
    assert scans.poll("map", S - 1) == []
    settled = scans.poll("map", S)
    assert [(one.item, type(one.error)) for one in settled] == [
        ("future", ExtrapolationError),
        ("camera", UnknownFrameError),
    ]
    assert all(one.pose is None for one in settled)


def test_what_is_older_than_the_buffer_does_not_wait():
    scans = MessageFilter[str](known_until(10 * S))
    scans.add("old", "laser", 5 * S, 0)
    (settled,) = scans.poll("map", 0)
    assert isinstance(settled.error, ExtrapolationError)


def test_the_oldest_goes_when_too_many_wait():
    scans = MessageFilter[int](known_until(10 * S), depth=3)
    for number in range(5):
        scans.add(number, "laser", 11 * S + number, 0)
    assert [one.item for one in scans.poll("map", 0)] == [0, 1]
    assert len(scans) == 3
    scans.clear()
    assert scans.poll("map", 99 * S) == []


def test_another_fixed_frame_is_tried_at_once():
    buffer = known_until(10 * S)
    scans = MessageFilter[str](buffer)
    scans.add("scan", "laser", 10 * S, 0)
    buffer.put(columns(Told("odom", "base", S)))
    assert scans.poll("odom", 0) == []
    assert [one.item for one in scans.poll("map", 0)] == ["scan"]
    scans.add("scan", "laser", 10 * S, 0)
    scans.poll("odom", 0)
    (settled,) = scans.poll("odom", 2 * S)
    assert isinstance(settled.error, UnconnectedFramesError)

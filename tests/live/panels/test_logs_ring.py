from __future__ import annotations

from typing import TYPE_CHECKING

from studio.live.panels import logs as log_ring
from studio.live.panels.logs import LogRing
from studio.protocol.logs import LINES_MAX
from studio.ros.messages import message

if TYPE_CHECKING:
    import pytest

LOG = message("rcl_interfaces/msg/Log")


def filled(*texts: str) -> LogRing:
    ring = LogRing()
    for text in texts:
        ring.take(LOG(level=20, name="talker", msg=text))
    return ring


def test_lines_are_told_by_number_after_one_that_is_known():
    lines, first, last = filled("a", "b", "c").after(1)
    assert [(one.number, one.text) for one in lines] == [(2, "b"), (3, "c")]
    assert (first, last) == (1, 3)
    assert filled("a").after(1)[0] == ()
    assert filled("a").after(99)[0] == ()
    assert filled().after(0) == ((), 0, 0)


def test_a_line_keeps_all_that_was_said():
    ring = LogRing()
    said = LOG(level=40, name="arm.motor", msg="hot", file="motor.py", function="turn", line=12)
    said.stamp.sec, said.stamp.nanosec = 100, 500_000_000
    ring.take(said)
    ((line,), _, _) = ring.after(0)
    assert (line.stamp_s, line.level, line.node, line.text) == (100.5, 40, "arm.motor", "hot")
    assert (line.file, line.function, line.line) == ("motor.py", "turn", 12)


def test_the_oldest_go_when_there_are_too_many(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(log_ring, "KEPT_MAX", 3)
    lines, first, last = filled(*"abcde").after(0)
    assert "".join(one.text for one in lines) == "cde"
    assert (first, last) == (3, 5)


def test_the_oldest_go_when_they_are_too_long_together(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(log_ring, "CHARACTERS_MAX", 40)
    lines, _, _ = filled("x" * 20, "y" * 20, "z").after(0)
    assert [one.text[0] for one in lines] == ["y", "z"]


def test_of_a_text_without_end_the_beginning_is_kept():
    ((line,), _, _) = filled("x" * 1_000_000).after(0)
    assert len(line.text) == log_ring.TEXT_MAX + 2


def test_one_answer_has_so_many_lines_at_most():
    ring = filled(*["x"] * (LINES_MAX + 5))
    lines, _, last = ring.after(0)
    assert len(lines) == LINES_MAX
    assert [one.number for one in ring.after(lines[-1].number)[0]][-1] == last

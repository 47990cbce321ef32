from __future__ import annotations

import math
import struct

from studio.classroom.following import Following, Seen
from studio.protocol.classroom import Focus
from studio.protocol.roles import Role
from tests.support.open_documents import Ear


def view(pointer: tuple[float, float, float] | None = (7, 8, 9), *, flat: bool = False) -> Seen:
    return Seen((1, 2, 3), (4, 5, 6), pointer, flat=flat, field_rad=0.5)


def floats(frame: bytes) -> tuple[float, ...]:
    assert (frame[0], len(frame)) == (2, 60)
    return struct.unpack_from("<13f", frame, 8)


def pair() -> tuple[Following, Ear, Ear]:
    """A presenter's page and a student's, which follows."""
    made, presenter, student = Following(), Ear(), Ear(Role.STUDENT)
    for page in (presenter, student):
        made.attach(page)
    assert made.follow(student, following=True)
    return made, presenter, student


def test_who_follows_sees_camera_and_pointer_and_nobody_else_does():
    made, presenter, student = pair()
    other = Ear(Role.STUDENT)
    made.attach(other)
    made.show_view(presenter, "rover", view())
    made.show_view(presenter, "rover", view(None, flat=True))
    first, second = map(floats, student.frames)
    assert first == (1, 2, 3, 4, 5, 6, 7, 8, 9, 0, 0, 1, 0.5)
    assert all(map(math.isnan, second[6:9]))
    assert [frame[1] for frame in student.frames] == [0, 1]
    assert other.frames == presenter.frames == []


def test_who_comes_later_sees_at_once_where_the_presenter_is():
    made, presenter, _ = pair()
    made.show_view(presenter, "rover", view())
    made.show_focus(presenter, Focus(document="rover", part="link:mast", site="", panel="joints"))
    late = Ear(Role.GUEST)
    made.attach(late)
    made.follow(late, following=True)
    assert floats(late.frames[0])[:3] == (1, 2, 3)
    assert late.last("focus") == {
        "type": "focus",
        "document": "rover",
        "part": "link:mast",
        "site": "",
        "panel": "joints",
    }


def test_who_comes_after_the_presenters_page_went_is_not_taken_to_where_it_was():
    made, presenter, _ = pair()
    made.show_view(presenter, "rover", view())
    made.show_focus(presenter, Focus(document="rover", part="link:mast", site="", panel="joints"))
    made.detach(presenter)
    late = Ear(Role.STUDENT)
    made.attach(late)
    made.follow(late, following=True)
    assert late.frames == []
    assert all(event["type"] != "focus" for event in late.events)


def test_who_explores_sees_nothing_until_they_come_back():
    made, presenter, student = pair()
    assert made.follow(student, following=False)
    assert not made.follow(student, following=False)
    made.show_view(presenter, "rover", view())
    assert student.frames == []
    made.follow(student, following=True)
    assert len(student.frames) == 1


def test_nobody_is_led_while_the_presenter_does_not_lead_and_all_are_gathered_at_once():
    made, presenter, student = pair()
    made.show_view(presenter, "rover", view())
    made.lead(leading=False)
    made.show_view(presenter, "rover", view())
    made.show_focus(presenter, Focus(document="rover", part="link:mast", site="", panel=""))
    assert len(student.frames) == 1
    assert student.last("leading")["leading"] is False
    made.gather()
    assert student.last("gather") == {"type": "gather", "document": ""}
    assert student.last("leading")["leading"] is True


def test_a_page_that_is_gone_is_sent_nothing():
    made, presenter, student = pair()
    made.detach(student)
    made.detach(presenter)
    made.show_view(presenter, "rover", view())
    assert student.frames == []


def test_nobody_is_taken_to_a_copy_before_it_is_shown_to_all_and_then_everybody_is():
    made, presenter, student = pair()
    made.show_focus(presenter, Focus(document="rover~ada", part="link:mast", site="", panel=""))
    made.show_view(presenter, "rover~ada", view())
    late = Ear(Role.STUDENT)
    made.attach(late)
    made.follow(late, following=True)
    assert [page.frames for page in (student, late)] == [[], []]
    assert not any(event["type"] == "focus" for page in (student, late) for event in page.events)
    made.gather("rover~ada")
    assert [page.last("focus")["document"] for page in (student, late)] == ["rover~ada"] * 2

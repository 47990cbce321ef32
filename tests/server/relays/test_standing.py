"""What a page asked for that lasts is asked for again, and what it ended is not."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.protocol.classroom import Follow
from studio.protocol.edits import Undo
from studio.protocol.lessons import CloseLesson, OpenLesson, SawPanel
from studio.protocol.parameters import FollowParameters
from studio.server.relays.standing import Standing
from tests.support.open_documents import Ear

if TYPE_CHECKING:
    from studio.protocol import Command


def asked_again(*commands: Command) -> list[Command]:
    """What is asked again of a page that sent these."""
    standing, page = Standing(), Ear()
    for one in commands:
        standing.note(one, page)
    return list(standing.of(page))


def test_a_lesson_comes_before_the_panels_that_were_seen_in_it():
    first = OpenLesson(document="rover", lesson="talker", request=3, id="x")
    again = asked_again(first, SawPanel(panel="origin"), FollowParameters(node="/a"), first)
    assert again == [OpenLesson(document="rover", lesson="talker"), FollowParameters(node="/a")]
    again = asked_again(first, SawPanel(panel="origin"))
    assert again == [OpenLesson(document="rover", lesson="talker"), SawPanel(panel="origin")]


def test_what_was_ended_is_not_asked_again():
    assert asked_again(OpenLesson(lesson="talker"), SawPanel(panel="x"), CloseLesson()) == []
    assert asked_again(Follow(following=True), Follow(following=False)) == []
    assert asked_again(FollowParameters(node="/a"), FollowParameters()) == []
    assert asked_again(SawPanel(panel="x"), Undo(document="rover")) == []


def test_what_is_ended_while_it_is_asked_again_is_left_out():
    standing, page = Standing(), Ear()
    for one in (OpenLesson(lesson="talker"), SawPanel(panel="x"), Follow(following=True)):
        standing.note(one, page)
    asked = standing.of(page)
    assert isinstance(next(asked), OpenLesson)
    standing.note(CloseLesson(), page)
    assert [type(one) for one in asked] == [Follow]


def test_a_page_that_was_closed_asks_for_nothing():
    standing, page = Standing(), Ear()
    standing.note(Follow(following=True), page)
    standing.forget(page)
    assert list(standing.of(page)) == []

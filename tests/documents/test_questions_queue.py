"""The order in which questions are answered, and which of them give way."""

from __future__ import annotations

import asyncio
import gc
from typing import TYPE_CHECKING
from weakref import ref

import pytest

from studio.description.language.questions import CompletionQuery, LookUpQuery, OutlineQuery
from studio.description.origins.origin_values import PartOriginQuery, SiteEffectsQuery
from studio.description.values import NoReply
from studio.documents.questions import KEPT, WAITING_LIMIT, QuestionQueue
from studio.errors import SupersededError
from studio.protocol.roles import Role
from tests.support.open_documents import Ear

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.description.requests import Query

OUTLINE, COMPLETION = OutlineQuery(), CompletionQuery("a.xacro", b"", 0)


def effects(site: str) -> SiteEffectsQuery:
    return SiteEffectsQuery(site)


def origin(number: int) -> PartOriginQuery:
    return PartOriginQuery(f"link:{number}")


def meaning(number: int) -> LookUpQuery:
    return LookUpQuery("a.xacro", b"", number)


def taken(queue: QuestionQueue) -> list[Query]:
    """All questions, in the order of their answers; each is answered with its own text."""
    order: list[Query] = []
    while one := queue.take(is_held=False):
        order.append(one.query)
        one.settle(NoReply(str(one.query)))
    return order


def on_a_loop(story: Callable[[], None]) -> None:
    """Futures want one."""

    async def run() -> None:
        story()

    asyncio.run(run())


def test_of_one_asker_and_kind_only_the_newest_is_kept():
    def story() -> None:
        queue, one, other = QuestionQueue(), Ear(), Ear()
        first = queue.add(effects("a"), one)
        queue.add(effects("b"), other)
        queue.add(OUTLINE, one)
        newest = queue.add(effects("c"), one)
        with pytest.raises(SupersededError):
            first.result()
        assert taken(queue) == [effects("b"), OUTLINE, effects("c")]
        assert newest.result() == NoReply(str(effects("c")))

    on_a_loop(story)


@pytest.mark.parametrize("query", [origin, meaning])
def test_a_page_may_ask_several_together(query: Callable[[int], Query]):
    def story() -> None:
        queue, ear = QuestionQueue(), Ear()
        asked = [queue.add(query(n), ear) for n in range(KEPT + 1)]
        assert isinstance(asked[0].exception(), SupersededError)
        assert taken(queue) == [query(n) for n in range(1, KEPT + 1)]

    on_a_loop(story)


def test_one_who_comes_back_to_a_question_that_still_waits_gets_its_answer():
    def story() -> None:
        queue, one, other = QuestionQueue(), Ear(), Ear()
        queue.add(effects("a"), other)
        left = queue.add(effects("b"), one)
        back = queue.add(effects("a"), one)
        assert taken(queue) == [effects("a")]
        assert isinstance(left.exception(), SupersededError)
        assert back.result() == NoReply(str(effects("a")))

    on_a_loop(story)


def test_what_several_ask_alike_is_answered_once_for_all():
    def story() -> None:
        queue = QuestionQueue()
        asked = [queue.add(OUTLINE, Ear(Role.GUEST)) for _ in range(200)]
        assert taken(queue) == [OUTLINE]
        assert {answer.result() for answer in asked} == {NoReply(str(OUTLINE))}

    on_a_loop(story)


def test_one_who_asks_something_newer_leaves_the_others_their_answer():
    def story() -> None:
        queue, one, other = QuestionQueue(), Ear(), Ear()
        left, kept = queue.add(effects("a"), one), queue.add(effects("a"), other)
        queue.add(effects("b"), one)
        assert taken(queue) == [effects("a"), effects("b")]
        assert isinstance(left.exception(), SupersededError)
        assert kept.result() == NoReply(str(effects("a")))

    on_a_loop(story)


def test_the_presenter_is_answered_first_and_no_viewer_keeps_another_waiting():
    def story() -> None:
        queue, greedy = QuestionQueue(), Ear(Role.GUEST)
        look_up = LookUpQuery("a.xacro", b"", 0)
        greedily = [OUTLINE, effects("a"), PartOriginQuery("link:a"), look_up]
        for query in greedily:
            queue.add(query, greedy)
        queue.add(effects("b"), Ear(Role.GUEST))
        queue.add(effects("c"), Ear(Role.PRESENTER))
        assert taken(queue) == [effects("c"), greedily[0], effects("b"), *greedily[1:]]

    on_a_loop(story)


def test_a_question_that_the_presenter_shares_counts_as_the_presenters():
    def story() -> None:
        queue, viewer = QuestionQueue(), Ear(Role.GUEST)
        queue.add(effects("a"), viewer)
        queue.add(OUTLINE, viewer)
        queue.add(OUTLINE, Ear(Role.PRESENTER))
        assert taken(queue) == [OUTLINE, effects("a")]

    on_a_loop(story)


def test_while_held_only_what_is_asked_in_the_midst_of_typing_is_answered():
    def story() -> None:
        queue, ear = QuestionQueue(), Ear()
        queue.add(effects("a"), ear)
        queue.add(COMPLETION, ear)
        one = queue.take(is_held=True)
        assert one is not None
        assert one.query == COMPLETION
        assert queue.take(is_held=True) is None
        assert taken(queue) == [effects("a")]

    on_a_loop(story)


def test_what_nobody_waits_for_any_more_is_not_answered():
    def story() -> None:
        queue = QuestionQueue()
        queue.add(effects("a"), Ear()).cancel()
        assert taken(queue) == []

    on_a_loop(story)


def test_strangers_without_a_number_keep_no_more_than_the_limit_waiting():
    def story() -> None:
        queue = QuestionQueue()
        presenters = queue.add(effects("mine"), Ear())
        asked = [queue.add(effects(str(n)), Ear(Role.GUEST)) for n in range(WAITING_LIMIT + 5)]
        assert [answer.done() for answer in asked].count(True) == 5
        assert isinstance(asked[4].exception(), SupersededError)
        assert len(taken(queue)) == WAITING_LIMIT + 1
        assert presenters.result() == NoReply(str(effects("mine")))
        for answer in asked[:4]:
            answer.exception()

    on_a_loop(story)


def test_who_has_gone_is_held_by_nothing():
    def story() -> None:
        queue, asker = QuestionQueue(), Ear()
        gone = ref(asker)
        queue.add(effects("a"), asker)
        assert len(taken(queue)) == 1
        del asker
        gc.collect()
        assert gone() is None

    on_a_loop(story)

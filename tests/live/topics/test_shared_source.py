"""What every source of topics promises: the same tests for one in memory and one at a router."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.live.topics.request import Request
from studio.ros.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from tests.support.topic_worlds import BOOL, STRING, text_of
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterable

    from studio.live.topics.subscription import Subscription
    from studio.ros.node.samples import RawSample
    from tests.support.topic_worlds import Speaker, World

pytestmark = pytest.mark.network
VOLATILE = QoSProfile(depth=10)
BEST_EFFORT = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)


def latched(depth: int = 1) -> QoSProfile:
    return QoSProfile(depth=depth, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def subscribe(world: World, topic: str, **wanted: bool | int | None) -> Subscription:
    return world.source.subscribe(Request(topic, **wanted))  # type: ignore[arg-type]


def texts(samples: Iterable[RawSample]) -> list[str]:
    return [text_of(one.payload) for one in samples]


class Taken:
    """What a subscription gave so far."""

    def __init__(self, subscription: Subscription) -> None:
        self._subscription = subscription
        self.texts: list[str] = []

    def now(self) -> list[str]:
        """With what came since this was asked last."""
        self.texts += texts(self._subscription.take())
        return self.texts


def until_receiving(world: World, topic: str, *subscriptions: Subscription) -> None:
    wait_until(
        f"{topic} to be received",
        lambda: all(one.state.kind == "receiving" for one in subscriptions),
    )
    wait_until("the subscription to be seen", lambda: bool(world.depths(topic)))


def until_told(taken: Taken, *expected: str) -> None:
    wait_until(f"{expected}", lambda: len(taken.now()) >= len(expected))
    assert taken.texts == list(expected)


def say_all(speaker: Speaker, count: int) -> list[str]:
    said = [str(number) for number in range(count)]
    for text in said:
        speaker.say(text)
    return said


def test_all_who_want_a_topic_alike_share_one_subscription_as_deep_as_the_deepest(world: World):
    speaker = world.speaker("/shared", VOLATILE)
    newest = subscribe(world, "/shared", newest_only=True)
    until_receiving(world, "/shared", newest)
    wait_until("a shallow one", lambda: world.depths("/shared") == [1])
    every, other = subscribe(world, "/shared"), subscribe(world, "/shared", depth=7)
    until_receiving(world, "/shared", every, other)
    wait_until("one that is deep", lambda: world.depths("/shared") == [4_096])
    said = say_all(speaker, 50)
    until_told(Taken(every), *said)
    until_told(Taken(other), *said)
    wait_until("the newest", lambda: "49" in texts(newest.take()))
    assert (every.received, every.lost, newest.dropped) == (50, 0, 0)


def test_a_subscription_ends_with_its_last_subscriber(world: World):
    world.speaker("/ended", VOLATILE)
    one, other = subscribe(world, "/ended"), subscribe(world, "/ended")
    until_receiving(world, "/ended", one, other)
    one.close()
    other.close()
    wait_until("the end", lambda: world.depths("/ended") == [])


def test_other_qos_is_another_subscription(world: World):
    world.speaker("/chosen", VOLATILE)
    fitted, chosen = subscribe(world, "/chosen"), subscribe(world, "/chosen", reliable=False)
    until_receiving(world, "/chosen", fitted, chosen)
    wait_until("two", lambda: len(world.depths("/chosen")) == 2)
    assert (fitted.fit and fitted.fit.reliable, chosen.fit and chosen.fit.reliable) == (True, False)


def test_what_is_latched_is_told_to_each_who_comes_later_once(world: World):
    speaker = world.speaker("/map", latched())
    speaker.say("first")
    early = Taken(subscribe(world, "/map"))
    until_told(early, "first")
    late = subscribe(world, "/map", newest_only=True)
    until_told(Taken(late), "first")
    assert texts(late.kept()) == ["first"]
    speaker.say("second")
    until_told(early, "first", "second")


def test_who_wants_more_of_what_is_latched_is_told_all_and_the_others_nothing_again(world: World):
    speaker = world.speaker("/history", latched(5))
    say_all(speaker, 3)
    shallow = Taken(subscribe(world, "/history", depth=1))
    until_told(shallow, "2")
    deep = Taken(subscribe(world, "/history", depth=5))
    until_told(deep, "0", "1", "2")
    speaker.say("3")
    until_told(shallow, "2", "3")
    until_told(deep, "0", "1", "2", "3")
    wait_until("one subscription", lambda: world.depths("/history") == [5])


def test_what_somebody_said_who_is_gone_is_told_to_nobody_later(world: World):
    stays, goes = world.speaker("/notes", latched()), world.speaker("/notes", latched())
    stays.say("stays")
    goes.say("goes")
    first = subscribe(world, "/notes")
    until_receiving(world, "/notes", first)
    taken = Taken(first)
    wait_until("both", lambda: sorted(taken.now()) == ["goes", "stays"])
    wait_until("both publishers", lambda: first.state.publishers == 2)
    goes.leave()
    wait_until("one publisher", lambda: first.state.publishers == 1)
    wait_until("it to be forgotten", lambda: texts(first.kept()) == ["stays"])
    until_told(Taken(subscribe(world, "/notes")), "stays")


def test_what_is_in_the_way_is_told_and_heals(world: World):
    world.disconnect()
    subscription = world.source.subscribe(Request("/odd", (STRING,)))

    def until_state(kind: str) -> None:
        wait_until(kind, lambda: subscription.state.kind == kind)
        assert bool(subscription.state.sentence) is (kind != "receiving")

    until_state("not_connected")
    world.connect()
    until_state("no_publisher")
    wrong = world.speaker("/odd", VOLATILE, BOOL)
    until_state("other_type")
    assert subscription.state.types == (BOOL,)
    assert BOOL in subscription.state.sentence
    wrong.leave()
    right = world.speaker("/odd", VOLATILE)
    until_state("receiving")
    wait_until("the subscription to be seen", lambda: bool(world.depths("/odd")))
    right.say("here")
    until_told(Taken(subscription), "here")
    right.leave()
    until_state("no_publisher")
    world.disconnect()
    until_state("not_connected")


def test_what_is_no_topic_or_no_known_type_is_refused_in_a_sentence(world: World):
    spaced = world.source.subscribe(Request("/a b", (STRING,)))
    unknown = world.source.subscribe(Request("/a", ("no_msgs/msg/Such",), as_known_here=True))
    for one in (spaced, unknown):
        wait_until("to be refused", lambda one=one: one.state.kind == "refused")
        assert len(one.state.sentence) > 10


def test_when_all_publishers_are_gone_it_stays_subscribed_as_it_was(world: World):
    speaker = world.speaker("/sensor", BEST_EFFORT)
    subscription = subscribe(world, "/sensor")
    until_receiving(world, "/sensor", subscription)
    before = subscription.fit
    assert before is not None
    assert not before.reliable
    speaker.leave()
    wait_until("nobody", lambda: subscription.state.kind == "no_publisher")
    assert subscription.fit == before
    assert world.depths("/sensor") == [4_096]


def test_a_queue_is_bounded_and_what_falls_out_is_counted(world: World):
    speaker = world.speaker("/flood", VOLATILE)
    slow = subscribe(world, "/flood", waiting_max=3)
    until_receiving(world, "/flood", slow)
    say_all(speaker, 10)
    wait_until("all", lambda: slow.received == 10)
    assert texts(slow.take()) == ["7", "8", "9"]
    assert (slow.dropped, slow.lost) == (7, 7)


def test_who_has_samples_handed_over_gets_each_and_none_after_the_end(world: World):
    speaker = world.speaker("/handed", VOLATILE)
    got: list[str] = []

    def take(sample: RawSample) -> None:
        text = text_of(sample.payload)
        got.append(text)
        if text == "1":
            raise ValueError(text)  # which must not end the rest

    taker = world.source.subscribe(Request("/handed"), take=take)
    witness = subscribe(world, "/handed")
    until_receiving(world, "/handed", taker, witness)
    say_all(speaker, 4)
    wait_until("all", lambda: len(got) == 4)
    taker.close()
    speaker.say("late")
    wait_until("it to come", lambda: witness.received == 5)
    assert got == ["0", "1", "2", "3"]


def test_who_waits_is_told_that_something_came_and_how_it_stands(world: World):
    came: list[None] = []
    states: list[None] = []
    subscription = world.source.subscribe(
        Request("/prompt", at_once=True),
        arrived=lambda: came.append(None),
        changed=lambda: states.append(None),
    )
    speaker = world.speaker("/prompt", VOLATILE)
    until_receiving(world, "/prompt", subscription)
    assert states
    speaker.say("now")
    wait_until("a call", lambda: bool(came))
    assert texts(subscription.take()) == ["now"]


def test_another_connection_is_another_epoch_and_nothing_of_before_is_given(world: World):
    speaker = world.speaker("/again", VOLATILE)
    subscription = subscribe(world, "/again")
    until_receiving(world, "/again", subscription)
    speaker.say("before")
    wait_until("it to come", lambda: subscription.received == 1)
    before = world.source.epoch
    world.disconnect()
    assert subscription.take() == []
    ended = world.source.epoch
    world.connect()
    assert len({before, ended, world.source.epoch}) == 3
    until_receiving(world, "/again", subscription)
    speaker.say("after")
    until_told(Taken(subscription), "after")


def test_what_is_latched_is_the_past_that_it_has(world: World):
    speaker = world.speaker("/past", latched(3))
    subscription = subscribe(world, "/past", depth=3)
    until_receiving(world, "/past", subscription)
    say_all(speaker, 2)
    wait_until("both", lambda: subscription.received == 2)
    first, last = subscription.take()
    end_ns = last.received_ns + 1
    assert texts(world.source.window("/past", first.received_ns, end_ns)) == ["0", "1"]
    assert world.source.latest(["/past", "/other"], end_ns) == {"/past": last}
    assert world.source.latest(["/past"], first.received_ns - 1) == {}
    assert world.source.window("/past", end_ns, end_ns + 1) == []


def test_the_catalogue_tells_who_publishes_what_and_how(world: World):
    world.speaker("/listed", BEST_EFFORT)

    def row() -> list[str]:
        found = [one for one in world.source.catalogue() if one.name == "/listed"]
        return [one.type_name for each in found for one in each.publishers]

    wait_until("the row", lambda: row() == [STRING])
    (offer,) = world.source.publishers("/listed")
    assert not offer.own
    assert offer.qos.reliability is ReliabilityPolicy.BEST_EFFORT
    assert offer.type_hash == world.source.types.hash_of(STRING)
    assert world.source.publishers("no topic") in ((), [])

"""Browsers of a relay are sent the same of topics as those of the studio itself."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Literal, NamedTuple

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from studio.errors import RelayLineError
from studio.live.topics.browsers import SUBSCRIPTIONS_MAX, BrowserTopics
from studio.live.topics.frames import FRAME_HEAD, LARGE_BYTES, MESSAGE_HEAD, chunk_of, frame_of
from studio.nodes.robot_state_publisher import LATCHED
from studio.protocol.roles import Role, Visitor
from studio.protocol.subscriptions import NotSubscribed, Subscribe, Unsubscribe
from studio.ros.qos import QoSProfile
from studio.server.relays.messages import TopicTick
from studio.server.relays.relayed_topics import TOPICS_MAX, RelayedTopics
from tests.live.topics.test_frames import samples
from tests.support.hearers import KeepingHearer
from tests.support.memory_source import MemorySource
from tests.support.open_documents import until
from tests.support.relayed_topics import Line, line_to, texts
from tests.support.topic_worlds import STRING, text_payload, zenoh_world

if TYPE_CHECKING:
    from collections.abc import Sequence

    from studio.server.relays.messages import AskTopic
    from tests.support.memory_source import MemoryPublisher

Mode = Literal["every", "newest"]
VOLATILE = QoSProfile(depth=10)


def wish(topic: str, mode: Mode = "every", subscription: int = 1, document: str = "") -> Subscribe:
    return Subscribe(subscription=subscription, topic=topic, mode=mode, document=document)


def asked_for(line: Line, topic: str) -> int:
    return sum(isinstance(one, Subscribe) and one.topic == topic for one in line.asked)


@pytest.mark.network
def test_browsers_of_a_relay_share_a_subscription_and_hear_what_those_of_the_studio_hear(
    endpoint: str,
):
    async def run() -> None:
        with zenoh_world(endpoint) as world:
            speaker = world.speaker("/every", VOLATILE)
            async with line_to(world.source) as (topics, line):
                near = line.hearer(topics)
                topics.carry_out(near, wish("/every"))
                one, other = line.hearer(), line.hearer()
                line.relayed.carry_out(one, wish("/every", subscription=5))
                line.relayed.carry_out(other, wish("/every", subscription=7))
                await until(lambda: one.state(5) == other.state(7) == "receiving")
                await until(lambda: len(world.depths("/every")) == 1)
                for number in range(300):
                    speaker.say(str(number))
                await until(lambda: len(near.came) == len(one.came) == len(other.came) == 300)
                assert near.came == one.came == other.came
                assert all(a is b for a, b in zip(one.ticks, other.ticks, strict=True))
                assert asked_for(line, "/every") == 1
                expected = near.told[-1].model_copy(update={"subscription": 7})
                assert other.told[-1] == expected
                line.relayed.detach(one)
                line.relayed.carry_out(other, Unsubscribe(subscription=7))
                topics.detach(near)
                await until(lambda: not world.depths("/every"))

    asyncio.run(run())


@pytest.mark.network
@pytest.mark.parametrize("mode", ["every", "newest"])
def test_whoever_comes_later_is_told_what_several_publishers_keep(endpoint: str, mode: Mode):
    async def run() -> None:
        with zenoh_world(endpoint) as world:
            speakers = [world.speaker("/tf_static", LATCHED) for _ in range(3)]
            for number, speaker in enumerate(speakers):
                speaker.say(f"of {number}")
            async with line_to(world.source) as (topics, line):
                first = line.hearer()
                line.relayed.carry_out(first, wish("/tf_static", mode))
                await until(lambda: "receiving" in {one.state for one in first.told})
                near = line.hearer(topics)

                async def later(expected: set[str]) -> KeepingHearer:
                    made = line.hearer()
                    line.relayed.carry_out(made, wish("/tf_static", mode))
                    await until(lambda: {*texts(made)} == expected)
                    assert made.told[-1].latched
                    return made

                before = {"of 0", "of 1", "of 2"}

                def is_kept() -> bool:
                    topics.carry_out(near, wish("/tf_static", mode, 2))
                    return before <= {*texts(near)}

                await until(is_kept)
                await later(before)
                asked = asked_for(line, "/tf_static")
                await asyncio.gather(*(later(before) for _ in range(5)))
                assert asked_for(line, "/tf_static") == asked
                speakers[1].say("another")
                await until(lambda: "another" in texts(first))
                await later(before | {"another"})
                assert asked_for(line, "/tf_static") == asked + 1

    asyncio.run(run())


def test_those_who_come_while_latched_messages_are_on_their_way_wait_for_the_same():
    async def run() -> None:
        source = MemorySource()
        publisher = source.offer("/map", STRING, LATCHED)
        publisher.say(text_payload("old"))
        async with line_to(source) as (_, line):
            first = line.hearer()
            last = Subscribe(subscription=1, topic="/map", mode="every", depth=1)
            line.relayed.carry_out(first, last)
            await until(lambda: bool(first.came))
            publisher.say(text_payload("new"))
            await until(lambda: texts(first)[-1] == "new")
            had = texts(first)
            line.is_held = True
            late = [line.hearer() for _ in range(4)]
            asked = asked_for(line, "/map")
            for one in late:
                line.relayed.carry_out(one, last)
            line.let_go()
            assert [texts(one) for one in late] == [["new"]] * 4
            assert asked_for(line, "/map") == asked + 1
            assert isinstance(line.asked[-1], Unsubscribe)
            publisher.say(text_payload("last"))
            await until(lambda: [texts(one) for one in late] == [["new", "last"]] * 4)
            assert texts(first) == [*had, "last"]

    asyncio.run(run())


def test_after_the_line_was_lost_all_is_subscribed_anew():
    async def run() -> None:
        source = MemorySource()
        publisher = source.offer("/words", STRING)
        async with line_to(source) as (_, line):
            one, other = line.hearer(), line.hearer()
            line.relayed.carry_out(one, wish("/words"))
            line.relayed.carry_out(other, wish("/words", "newest", 3))
            assert one.state(1) == other.state(3) == "receiving"
            before = one.told[-1].channel
            line.cut()
            assert one.state(1) == other.state(3) == "not_connected"
            later = line.hearer()
            line.relayed.carry_out(later, wish("/words"))
            assert later.state(1) == "not_connected"
            publisher.say(text_payload("unheard"))
            line.connect()
            assert one.state(1) == other.state(3) == later.state(1) == "receiving"
            assert one.told[-1].channel == later.told[-1].channel != before
            publisher.say(text_payload("heard"))
            await until(lambda: texts(one) == texts(other) == texts(later) == ["heard"])

    asyncio.run(run())


def test_a_studio_that_was_started_anew_has_other_channels():
    numbers: set[int] = set()

    async def run() -> None:
        async with line_to(MemorySource()) as (_, line):
            hearer = line.hearer()
            line.relayed.carry_out(hearer, wish("/words"))
            numbers.add(hearer.told[-1].channel)

    for _ in range(5):
        asyncio.run(run())
    assert len(numbers) == 5


def test_a_document_that_shows_another_time_is_heard_there_by_all_its_pages():
    async def run() -> None:
        live, past = MemorySource(), MemorySource()
        publisher = live.offer("/words", STRING)
        past.offer("/words", STRING, LATCHED).say(text_payload("then"))
        shown: dict[str, MemorySource] = {}
        async with line_to(live) as (topics, line):
            topics.source_of = shown.get
            one, other, apart = line.hearer(), line.hearer(), line.hearer()
            for hearer, document in ((one, "arm"), (other, "arm"), (apart, "rover")):
                line.relayed.carry_out(hearer, wish("/words", document=document))
            assert one.told[-1].channel == apart.told[-1].channel
            publisher.say(text_payload("now"))
            await until(lambda: texts(one) == texts(other) == texts(apart) == ["now"])
            shown["arm"] = past
            topics.switch("arm")
            await until(lambda: texts(one)[-1] == texts(other)[-1] == "then")
            assert one.told[-1].channel == other.told[-1].channel != apart.told[-1].channel
            publisher.say(text_payload("later"))
            await until(lambda: texts(apart) == ["now", "later"])
            assert "later" not in {*texts(one), *texts(other)}

    asyncio.run(run())


def test_a_copy_is_shown_to_those_alone_who_see_it_here_and_at_the_studio():
    async def run() -> None:
        async with line_to(MemorySource()) as (_, line):
            owner, stranger = line.hearer(), line.hearer()
            line.tickets = {owner: "of the presenter", stranger: "of a guest"}
            line.persons = {
                "of the presenter": Visitor(Role.PRESENTER),
                "of a guest": Visitor(Role.GUEST),
            }
            line.relayed.carry_out(stranger, wish("/words", document="arm~somebody"))
            assert stranger.refused[-1].reason == "There is no such document."
            line.relayed.carry_out(owner, wish("/words", document="arm~somebody"))
            assert owner.state(1)
            assert not owner.refused
            line.relayed.carry_out(stranger, wish("/words", document="hidden"))
            assert asked_for(line, "/words") == 2
            assert len(stranger.refused) == 2

    asyncio.run(run())


def test_a_browser_and_all_of_a_relay_have_bounds():
    async def run() -> None:
        async with line_to(MemorySource()) as (_, line):
            one, other = line.hearer(), line.hearer()
            for number in range(SUBSCRIPTIONS_MAX + 1):
                line.relayed.carry_out(one, wish(f"/one/topic{number}", "every", number))
            for number in range(SUBSCRIPTIONS_MAX):
                line.relayed.carry_out(other, wish(f"/other/topic{number}", "every", number))
            assert [told.subscription for told in one.refused] == [SUBSCRIPTIONS_MAX]
            left = TOPICS_MAX - SUBSCRIPTIONS_MAX
            assert [told.subscription for told in other.refused] == [
                *range(left, SUBSCRIPTIONS_MAX)
            ]
            line.relayed.detach(one)
            later = line.hearer()
            line.relayed.carry_out(later, wish("/later"))
            assert later.state(1)

    asyncio.run(run())


def test_messages_go_on_as_they_came_and_large_ones_are_large_still():
    asked: list[AskTopic] = []
    relayed = RelayedTopics(asked.append)
    relayed.renew()
    hearer = KeepingHearer()
    relayed.attach(hearer)
    relayed.carry_out(hearer, wish("/cloud"))
    relayed.carry_out(hearer, wish("/view", "newest", 2))
    for number, channel in ((1, 70), (2, 80)):
        tell(relayed, number, channel)
    large = chunk_of(70, samples([bytes(LARGE_BYTES + 1)]), 3, keeps_all=True)
    small = chunk_of(80, samples([b"a", b"bcd"]), 0, keeps_all=False)
    unknown = chunk_of(90, samples([b"of nobody"]), 0, keeps_all=True)
    relayed.take_tick(TopicTick(frame_of((small, unknown, large), 0)))
    (tick,) = hearer.ticks
    assert [(one.channel, one.count, one.keeps_all, one.is_large) for one in tick.chunks] == [
        (70, 1, True, True),
        (80, 2, False, False),
    ]
    assert [b"".join(one.parts) for one in tick.chunks] == [
        b"".join(one.parts) for one in (large, small)
    ]


def tell(relayed: RelayedTopics, number: int, channel: int) -> None:
    """Answer a subscription as an origin does."""
    view = (
        f'{{"type": "subscription", "subscription": {number}, "channel": {channel}, '
        '"state": "receiving", "type_name": "", "types": [], "publishers": 1, "reliable": true, '
        '"latched": false, "depth": 1, "reason": ""}'
    )
    relayed.take_state(view.encode())
    relayed.take_tick(TopicTick(frame_of((), 0), number))


def forged(version: int, count: int, lengths: list[int]) -> bytes:
    """A frame that says this of itself, and of each of its messages."""
    heads = [MESSAGE_HEAD.pack(70, length, 0, 0, 0) + bytes(4) for length in lengths]
    return FRAME_HEAD.pack(version, count, 0) + b"".join(heads)


FRAMES = st.one_of(
    st.binary(max_size=100),
    st.builds(
        forged,
        st.sampled_from([1, 2]),
        st.sampled_from([0, 1, 2, 2**32 - 1]),
        st.lists(st.sampled_from([0, 4, 5, 2**32 - 1]), max_size=3),
    ),
)


@given(FRAMES, st.integers(-3, 3), st.binary(max_size=60))
def test_what_is_forged_ends_the_line_or_goes_nowhere(frame: bytes, kept_for: int, text: bytes):
    relayed = RelayedTopics(lambda _: None)
    relayed.renew()
    hearer = KeepingHearer()
    relayed.attach(hearer)
    relayed.carry_out(hearer, wish("/words"))
    tell(relayed, 1, 70)
    try:
        relayed.take_tick(TopicTick(frame, kept_for))
    except RelayLineError:
        assert not hearer.came
    with pytest.raises(RelayLineError):
        relayed.take_state(text)
    refused = NotSubscribed(subscription=kept_for, reason="so").model_dump_json().encode()
    relayed.take_state(refused)
    assert [one.reason for one in hearer.refused] == ["so"] * (kept_for == 1)


class Step(NamedTuple):
    """Something that a browser or a publisher does."""

    what: Literal["subscribe", "unsubscribe", "say", "leave"]
    browser: int
    subscription: int
    topic: int
    mode: Mode


STEPS = st.lists(
    st.builds(
        Step,
        st.sampled_from(["subscribe", "subscribe", "unsubscribe", "say", "say", "leave"]),
        st.integers(0, 2),
        st.integers(0, 1),
        st.integers(0, 2),
        st.sampled_from(["every", "newest"]),
    ),
    max_size=25,
)
TOPICS = ("/plain", "/latched", "/latched")


class Twins:
    """Browsers of a studio, and others that do the same at a relay of one like it."""

    def __init__(self, near: BrowserTopics, line: Line, source: MemorySource) -> None:
        self._near, self._line = near, line
        self._publishers: Sequence[MemoryPublisher] = [
            source.offer(topic, STRING, VOLATILE if topic == "/plain" else LATCHED)
            for topic in TOPICS
        ]
        self.pairs = [(line.hearer(near), line.hearer()) for _ in range(3)]
        self._said = 0
        self._pulse = source.offer("/pulse", STRING)
        self._pulsed = line.hearer(near), line.hearer()
        near.carry_out(self._pulsed[0], wish("/pulse"))
        line.relayed.carry_out(self._pulsed[1], wish("/pulse"))

    async def take(self, step: Step) -> None:
        """Do it at both."""
        near, far = self.pairs[step.browser]
        if step.what == "say":
            self._said += 1
            payload = text_payload(f"{step.topic} {self._said}")
            self._publishers[step.topic].say(payload)
        elif step.what == "leave":
            for topics, hearer in ((self._near, near), (self._line.relayed, far)):
                topics.detach(hearer)
                topics.attach(hearer)
        else:
            asked = wish(TOPICS[step.topic], step.mode, step.subscription)
            command = (
                # Of one depth: for a greater one a source has latched messages told anew.
                asked.model_copy(update={"depth": 1})
                if step.what == "subscribe"
                else Unsubscribe(subscription=step.subscription)
            )
            self._near.carry_out(near, command)
            self._line.relayed.carry_out(far, command)
        # Both tick: of two messages at once, where the newest counts, either may come alone.
        self._pulse.say(text_payload("pulse"))
        count = len(self._pulsed[0].came) + 1
        await until(lambda: all(len(one.came) == count for one in self._pulsed))

    def heard(self, far: int) -> list[list[bytes]]:
        return [[one.payload for one in pair[far].came] for pair in self.pairs]


@settings(
    deadline=None, max_examples=40, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(STEPS)
def test_whatever_is_subscribed_and_said_comes_alike_near_and_over_a_relay(
    monkeypatch: pytest.MonkeyPatch, steps: list[Step]
):
    monkeypatch.setattr("studio.live.topics.browsers._TICK_S", 0.001)
    # Nothing is held for a rate: the two would hold it from different moments on.
    monkeypatch.setattr("studio.live.topics.browsers._TICK_SLACK_S", 1.0)

    async def run() -> None:
        source = MemorySource()
        async with line_to(source) as (far, line), line_to(source) as (near, _):
            del far
            twins = Twins(near, line, source)
            for step in steps:
                await twins.take(step)
            await until(lambda: twins.heard(0) == twins.heard(1))

    asyncio.run(run())

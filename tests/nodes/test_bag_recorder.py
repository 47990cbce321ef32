"""A recorder beside a talker, each in a session of its own, over real Zenoh."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

import pytest

from studio.bags.writer import Storing
from studio.nodes.bag_recorder import BagRecorder, RecordSettings
from studio.nodes.recorded_topics import TopicChoice
from studio.ros.node.node import Node
from studio.ros.node.raw_subscription import RawSubscription
from studio.ros.qos import DurabilityPolicy, QoSProfile
from tests.support.node_pair import context_at
from tests.support.wire import wait_until
from tests.support.written_bags import told_by_rosbags

if TYPE_CHECKING:
    from collections.abc import Callable, Generator
    from pathlib import Path

    from studio.ros.node.publisher import Publisher

pytestmark = pytest.mark.network
STRING = "std_msgs/msg/String"
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
ALL = RecordSettings(topics=TopicChoice(regex="^/(words|more|latched|clock)"))


class Pair:
    """A talker, and a node that records."""

    def __init__(self, talker: Node, recorder: Node, folder: Path) -> None:
        self.talker, self.node, self.folder = talker, recorder, folder
        self.said: list[str] = []
        self.kind = talker.wire.types.message(STRING)

    def publisher(self, topic: str, qos: QoSProfile | None = None) -> Publisher:
        made = self.talker.create_publisher(self.kind, topic, qos or QoSProfile(depth=10))
        wait_until("the recorder sees it", lambda: bool(self.node.graph.publishers(topic)))
        return made

    def say(self, publisher: Publisher, *words: str) -> None:
        for word in words:
            publisher.publish(self.kind(data=word))

    @contextmanager
    def recording(self, settings: RecordSettings = ALL) -> Generator[BagRecorder]:
        recorder = BagRecorder(self.node, self.folder / "bag", settings, self.said.append)
        try:
            yield recorder
        finally:
            recorder.close()

    def heard_by(self, publisher: Publisher) -> None:
        topic = publisher.topic_name
        wait_until("it is subscribed", lambda: self.talker.count_subscribers(topic) > 0)

    def words(self) -> dict[str, list[str]]:
        """What was said on each topic, as rosbags reads it."""
        found: dict[str, list[str]] = {}
        for topic, _, data in told_by_rosbags(self.folder / "bag"):
            found.setdefault(topic, []).append(data[8:].rstrip(b"\0").decode())
        return found


@pytest.fixture
def pair(endpoint: str, tmp_path: Path) -> Generator[Pair]:
    with context_at(endpoint) as one, context_at(endpoint) as other:
        yield Pair(Node("talker", context=one), Node("recorder", context=other), tmp_path)


def counted(recorder: BagRecorder, topic: str, least: int) -> Callable[[], bool]:
    return lambda: any(one.name == topic and one.count >= least for one in recorder.counts())


def test_b1_what_is_said_is_in_the_bag_also_of_topics_that_come_later(pair: Pair):
    words = pair.publisher("/words")
    with pair.recording() as recorder:
        pair.heard_by(words)
        pair.say(words, *map(str, range(100)))
        more = pair.publisher("/more")
        pair.heard_by(more)
        pair.say(more, "late")
        wait_until("all came", counted(recorder, "/words", 100))
        wait_until("all came", counted(recorder, "/more", 1))
        assert [(one.name, one.lost) for one in recorder.counts()] == [("/more", 0), ("/words", 0)]
    assert pair.words() == {"/words": [str(one) for one in range(100)], "/more": ["late"]}
    assert pair.said[0] == "Subscribed to topic '/words'"


def test_what_was_latched_before_is_recorded(pair: Pair):
    latched = pair.publisher("/latched", LATCHED)
    pair.say(latched, "once")
    with pair.recording() as recorder:
        wait_until("it came", counted(recorder, "/latched", 1))
    assert pair.words() == {"/latched": ["once"]}


def test_a_pause_leaves_out_what_is_said_meanwhile(pair: Pair):
    words = pair.publisher("/words")
    settings = RecordSettings(topics=ALL.topics, is_paused=True)
    with pair.recording(settings) as recorder:
        pair.heard_by(words)
        came: list[object] = []
        RawSubscription(  # the recorder's is read before it
            pair.node,
            "/words",
            STRING,
            None,
            QoSProfile(depth=10),
            lambda one, _, __: came.append(one),
        )
        wait_until("both are there", lambda: pair.talker.count_subscribers("/words") == 2)
        pair.say(words, "unheard")
        wait_until("it came by", lambda: bool(came))
        recorder.resume()
        pair.say(words, "heard")
        wait_until("it came", counted(recorder, "/words", 1))
        assert not recorder.is_paused
    assert pair.words()["/words"] == ["heard"]


def test_without_discovery_nothing_that_comes_later_is_recorded(pair: Pair):
    words = pair.publisher("/words")
    with pair.recording(RecordSettings(topics=ALL.topics, discovers=False)) as recorder:
        pair.heard_by(words)
        pair.publisher("/more")
        pair.say(words, "one")
        wait_until("it came", counted(recorder, "/words", 1))
        assert pair.talker.count_subscribers("/more") == 0
        recorder.discover(wanted=True)
        wait_until("it is found", lambda: pair.talker.count_subscribers("/more") == 1)
    assert pair.words() == {"/words": ["one"]}


def test_a_snapshot_writes_what_was_kept_and_each_a_file_of_its_own(pair: Pair):
    words = pair.publisher("/words")
    settings = RecordSettings(topics=ALL.topics, snapshots=True, waiting_bytes_max=40)
    with pair.recording(settings) as recorder:
        pair.heard_by(words)
        for word in ("gone", "kept 1", "kept 2"):
            before = recorder.kept_bytes
            pair.say(words, word)
            wait_until("it is kept", lambda before=before: recorder.kept_bytes != before)
        assert recorder.counts()[0].count == 0
        assert recorder.snapshot()
        wait_until("it is written", counted(recorder, "/words", 2))
        pair.say(words, "later")
        wait_until("it is kept", lambda: recorder.kept_bytes > 0)
        assert recorder.snapshot()
        wait_until("it is written", counted(recorder, "/words", 3))
    assert pair.words() == {"/words": ["kept 1", "kept 2", "later"]}
    assert len(list((pair.folder / "bag").glob("*.mcap"))) == 2


def test_a_topic_with_two_types_is_told_and_left_out(pair: Pair):
    pair.publisher("/words")
    number = pair.talker.wire.types.message("std_msgs/msg/Int32")
    pair.talker.create_publisher(number, "/words", 10)
    wait_until("both are seen", lambda: len(pair.node.graph.publishers("/words")) == 2)
    with pair.recording() as recorder:
        assert recorder.counts() == []
    assert "more than one type" in pair.said[0]


def test_an_unknown_type_is_recorded_with_an_empty_definition_and_told(pair: Pair):
    pair.talker.wire.types.add_texts({"nobody_msgs/msg/Foo": "int32 data\n"})
    kind = pair.talker.wire.types.message("nobody_msgs/msg/Foo")
    strange = pair.talker.create_publisher(kind, "/words", 10)
    wait_until("it is seen", lambda: bool(pair.node.graph.publishers("/words")))
    with pair.recording() as recorder:
        pair.heard_by(strange)
        strange.publish(kind(data=7))
        wait_until("it came", counted(recorder, "/words", 1))
    ((topic, _, data),) = told_by_rosbags(pair.folder / "bag")
    assert (topic, data) == ("/words", bytes([0, 1, 0, 0, 7, 0, 0, 0]))
    assert any("nobody_msgs/msg/Foo is not known" in one for one in pair.said)


def test_a_split_begins_another_file_while_it_records(pair: Pair):
    words = pair.publisher("/words")
    with pair.recording(RecordSettings(topics=ALL.topics, storing=Storing())) as recorder:
        pair.heard_by(words)
        pair.say(words, "one")
        wait_until("it came", counted(recorder, "/words", 1))
        recorder.split()
        pair.say(words, "two")
        wait_until("it came", counted(recorder, "/words", 2))
    assert pair.words() == {"/words": ["one", "two"]}
    assert len(list((pair.folder / "bag").glob("*.mcap"))) == 2

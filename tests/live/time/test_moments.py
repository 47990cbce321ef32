from __future__ import annotations

from typing import TYPE_CHECKING

from studio.live.time.moments import DRAGGED_MAX, SETTLED_MAX, Moments, Wanted
from studio.ros.columns.transforms import TransformCodec
from studio.ros.qos import DurabilityPolicy, QoSProfile
from tests.support.memory_recording import MemoryRecording
from tests.support.topic_worlds import STRING, text_of
from tests.support.transforms import S, Told, columns

if TYPE_CHECKING:
    from studio.ros.node.samples import RawSample

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
BEGIN = 1_700_000_000 * S


def recording() -> MemoryRecording:
    """Texts ten times a second for a minute; a latched one in the first second, and TF."""
    made = MemoryRecording()
    made.add_topic("/words", STRING, QoSProfile(depth=10))
    made.add_topic("/latched", STRING, LATCHED)
    made.add_topic("/tf", "tf2_msgs/msg/TFMessage")
    made.say("/latched", BEGIN, data="once")
    for number in range(600):
        at_ns = BEGIN + number * S // 10
        made.say("/words", at_ns, data=str(number))
        made.add("/tf", at_ns, tf("base", at_ns))
    return made


def tf(child: str, at_ns: int) -> bytes:
    return bytes(TransformCodec().encode(columns(Told("map", child, at_ns))))


def at(
    made: MemoryRecording, moments: Moments, name: str, depth: int, at_s: float, **how: bool
) -> list[RawSample]:
    topic = next(one for one in made.topics if one.name == name)
    at_ns = BEGIN + round(at_s * S)
    return moments.at([Wanted(topic, depth)], at_ns, **how)[name]  # type: ignore[arg-type]


def test_a_reader_has_the_last_messages_and_no_later_one():
    made = recording()
    found = at(made, Moments(made), "/words", 3, 30.05)
    assert [text_of(one.payload) for one in found] == ["298", "299", "300"]
    assert [text_of(one.payload) for one in at(made, Moments(made), "/words", 1, 0.0)] == ["0"]
    assert at(made, Moments(made), "/words", 5, -1.0) == []


def test_a_latched_message_of_long_ago_is_there_and_read_once():
    made = recording()
    moments = Moments(made)
    first = at(made, moments, "/latched", 1, 59.0)
    assert [text_of(one.payload) for one in first] == ["once"]
    read = made.reads["/latched"]
    assert at(made, moments, "/latched", 1, 20.0) == first
    assert made.reads["/latched"] == read


def test_while_a_bar_is_dragged_little_is_read():
    made = recording()
    moments = Moments(made)
    assert len(at(made, moments, "/words", 5_000, 59.0)) == 101  # of the last ten seconds
    assert len(at(made, moments, "/words", 5_000, 59.0, settled=False)) == DRAGGED_MAX
    assert SETTLED_MAX > DRAGGED_MAX


def test_tf_is_read_back_until_every_frame_that_moved_is_there():
    made = recording()
    settled = Moments(made)
    assert len(at(made, settled, "/tf", 100, 30.0)) == 101  # as a buffer of tf2 remembers
    assert len(at(made, settled, "/tf", 100, 29.0, settled=False)) == 32
    seldom = recording()
    moments = Moments(seldom)
    seldom.add("/tf", BEGIN + 60 * S, tf("arm", BEGIN + 60 * S))
    for number in range(40):
        at_ns = BEGIN + 60 * S + (number + 1) * S // 100
        seldom.add("/tf", at_ns, tf("base", at_ns))
    at(seldom, moments, "/tf", 100, 61.0)
    found = at(seldom, moments, "/tf", 100, 60.5, settled=False)
    children = {TransformCodec().decode(one.payload).children for one in found}
    assert ("arm",) in children

from __future__ import annotations

import pytest

from studio.errors import SettingsError
from studio.nodes.recorded_topics import TopicChoice, adapted
from studio.ros.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

STRING, INT = "std_msgs/msg/String", "std_msgs/msg/Int32"
NAMES = {
    "/words": STRING,
    "/arm/words": STRING,
    "/number": INT,
    "/_hidden": INT,
    "/add/_service_event": "example_interfaces/srv/AddTwoInts_Event",
}
LATCHED = QoSProfile(depth=3, durability=DurabilityPolicy.TRANSIENT_LOCAL)
LOSSY = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)


@pytest.mark.parametrize(
    ("choice", "taken"),
    [
        (TopicChoice(), ""),
        (TopicChoice(all=True), "/words /arm/words /number"),
        (TopicChoice(all=True, hidden=True), "/words /arm/words /number /_hidden"),
        (TopicChoice(all=True, all_services=True), "/words /arm/words /number /add/_service_event"),
        (TopicChoice(services=frozenset({"/add"})), "/add/_service_event"),
        (TopicChoice(all_services=True, exclude_services=frozenset({"/add"})), ""),
        (TopicChoice(topics=frozenset({"/words"})), "/words"),
        (TopicChoice(types=frozenset({INT})), "/number"),
        (TopicChoice(regex="words$"), "/words /arm/words"),
        (TopicChoice(regex="words", exclude_regex="^/arm"), "/words"),
        (TopicChoice(all=True, exclude_regex="number"), "/words /arm/words"),
        (TopicChoice(all=True, exclude_topics=frozenset({"/words"})), "/arm/words /number"),
        (TopicChoice(all=True, exclude_types=frozenset({STRING})), "/number"),
        (TopicChoice(topics=frozenset({"/number"}), regex="arm"), "/arm/words /number"),
    ],
)
def test_topics_are_chosen_by_the_words_of_ros2(choice: TopicChoice, taken: str):
    assert [one for one, kind in NAMES.items() if choice.takes(one, kind)] == taken.split()


@pytest.mark.parametrize("text", ["(", "*", "[z-a]"])
def test_what_is_no_regular_expression_is_refused(text: str):
    with pytest.raises(SettingsError, match="no regular expression"):
        TopicChoice(exclude_regex=text).check()


@pytest.mark.parametrize(
    ("offered", "reliability", "durability", "depth", "warnings"),
    [
        ([], "RELIABLE", "VOLATILE", 10, 0),
        ([QoSProfile(depth=50)], "RELIABLE", "VOLATILE", 50, 0),
        ([LOSSY], "BEST_EFFORT", "VOLATILE", 10, 0),
        ([LATCHED, LATCHED], "RELIABLE", "TRANSIENT_LOCAL", 10, 0),
        ([LATCHED, QoSProfile(depth=1)], "RELIABLE", "VOLATILE", 10, 1),
        ([LATCHED, LOSSY], "BEST_EFFORT", "VOLATILE", 10, 2),
        ([QoSProfile(depth=2**31)], "RELIABLE", "VOLATILE", 1_000, 0),
    ],
)
def test_a_topic_is_subscribed_as_all_of_its_publishers_allow(
    offered: list[QoSProfile], reliability: str, durability: str, depth: int, warnings: int
):
    found = adapted("/words", offered)
    qos = found.qos
    assert (qos.reliability.name, qos.durability.name) == (reliability, durability)
    assert (qos.depth, len(found.warnings)) == (depth, warnings)

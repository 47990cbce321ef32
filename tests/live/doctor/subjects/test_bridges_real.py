"""The Doctor in front of the real bridge and robots on DDS: what it finds, and is not fooled by."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.ros.client import Node
from studio.ros.messages import message
from tests.support.dds_bridge import DdsNetwork
from tests.support.patient import STRING, patient_system
from tests.support.wire import running_router, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.live.doctor.seen import Answers, Heard, System
    from tests.support.dds_bridge import DdsRobot
    from tests.support.patient import Patient

pytestmark = [pytest.mark.network, pytest.mark.timeout(240)]
CONFIG = {
    "deny": {"publishers": ["/secret"]},
    "pub_max_frequencies": ["/slow=2"],
}
FOOLED = {
    "old-rmw", "dead-node", "silent-node", "several-routers", "router-versions", "hash",
    "foreign-hash", "unseen-nodes", "clock-behind", "bridge-empty", "bridge-version", "no-route",
    "two-worlds", "stamp-past",
}  # fmt: skip
"""What nodes behind a bridge look like and are not."""


@pytest.fixture(scope="module")
def network() -> Generator[DdsNetwork]:
    with DdsNetwork() as made:
        yield made


@pytest.fixture(scope="module")
def behind(network: DdsNetwork) -> Generator[tuple[Patient, DdsRobot]]:
    """A system with a node of its own and a robot on DDS behind a bridge."""
    with running_router() as endpoint, patient_system(endpoint) as made:
        network.bridge(connect=endpoint, config=CONFIG)
        robot = network.robot()
        robot.ask("parameters", values={"speed": 1}, node="/dds_robot")
        robot.ask("advertise", topic="/secret", type_name=STRING, node="/dds_robot")
        robot.ask("subscribe", topic="/back", type_name=STRING, node="/dds_robot")
        wait_until("the robot is seen", lambda: "/dds_robot" in paths(made))
        yield made, robot


def paths(patient: Patient) -> set[str]:
    return {one.path for one in system_of(patient).nodes}


def system_of(patient: Patient) -> System:
    system = patient.seen().system
    assert system is not None
    return system


def asked(patient: Patient) -> tuple[Heard, Answers]:
    seen = patient.seen(asks=True)
    assert seen.heard is not None
    assert seen.answers is not None
    return seen.heard, seen.answers


def say(robot: DdsRobot, topic: str, text: str = "x") -> None:
    robot.ask("publish", topic=topic, type_name=STRING, values={"data": text}, node="/dds_robot")


def test_a_robot_on_dds_is_heard_and_fools_no_subject(behind: tuple[Patient, DdsRobot]):
    patient, robot = behind
    studio = Node("studio", context=patient.context)
    studio.create_publisher(message(STRING), "/back", 10)
    say(robot, "/said")

    def is_heard() -> bool:
        say(robot, "/said")
        heard, _ = asked(patient)
        said = heard.topics.get("/said")
        return said is not None and said.samples > 2 and bool(heard.offsets)

    wait_until("it is heard", is_heard)
    heard, answers = asked(patient)
    examined = patient.examined(asks=True)
    studio.destroy_node()
    assert heard.topics["/said"].not_understood == 0
    (offset,) = (one for one in heard.offsets if one.bridge)
    assert offset.nodes == ("/dds_robot",)
    assert answers.asked >= 2
    assert answers.silent == ()
    assert answers.unrouted == ()
    assert FOOLED & {one.code for one in examined.findings} == set()
    (view,) = (one for one in examined.subjects if one.subject == "bridges")
    assert ("1.10.0" in view.detail, "1 node" in view.detail) == (True, True)


def test_its_list_and_its_pace_are_said(behind: tuple[Patient, DdsRobot]):
    patient, _ = behind
    kept = patient.until("bridge-withholds", "/secret")
    assert (kept.level, kept.evidence[0]) == ("note", "deny: publishers: ^/secret$")
    assert patient.until("bridge-slows", "/slow").evidence == ("pub_max_frequencies: /slow=2",)


def test_profiles_that_do_not_match_on_dds_are_an_error(behind: tuple[Patient, DdsRobot]):
    patient, robot = behind
    robot.ask(
        "advertise",
        topic="/unmet",
        type_name=STRING,
        qos={"reliability": "best_effort"},
        node="/dds_robot",
    )
    robot.ask("subscribe", topic="/unmet", type_name=STRING, node="/dds_listener")
    found = patient.until("qos-on-dds", "/unmet")
    assert (found.level, found.talk and found.talk.meets) == ("error", False)
    robot.ask("remove_node", node="/dds_listener")


def test_a_bridge_of_another_domain_is_said_and_its_nodes_are_not_there(
    behind: tuple[Patient, DdsRobot], network: DdsNetwork
):
    patient, _ = behind
    network.bridge(connect=patient.endpoint, domain=7, distro="humble", namespace="/old")
    robot = network.robot(distro="humble", domain=7)
    robot.ask("advertise", topic="/range", type_name="sensor_msgs/msg/Range", node="/old_robot")
    found = patient.until("bridge-domain", "/old")
    assert found.evidence[0] == "it was started for domain 7"
    assert "/old/old_robot" not in paths(patient)


def test_a_second_bridge_to_the_same_robot_is_an_error(
    behind: tuple[Patient, DdsRobot], network: DdsNetwork
):
    patient, _ = behind
    second = network.bridge(connect=patient.endpoint)
    found = patient.until("two-bridges")
    second.kill()
    assert found.level == "error"
    wait_until("it is gone", lambda: "two-bridges" not in patient.codes(""))


def test_a_robot_that_is_gone_leaves_an_empty_bridge(behind: tuple[Patient, DdsRobot]):
    patient, robot = behind
    robot.ask("remove_node", node="/dds_robot")
    found = patient.until("bridge-empty")
    assert found.level == "warn"

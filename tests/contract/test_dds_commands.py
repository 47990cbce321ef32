"""The `studio` command beside a robot on DDS, through the real zenoh-bridge-ros2dds."""

from __future__ import annotations

from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING, Any, NamedTuple

import pytest
import yaml
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore

from tests.support.command_line import started, studio
from tests.support.dds_bridge import DdsNetwork, DdsRobot
from tests.support.dds_classroom import URDF
from tests.support.wire import running_router, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

pytestmark = pytest.mark.network
ADD = "example_interfaces/srv/AddTwoInts"
FIBONACCI = "example_interfaces/action/Fibonacci"
STORAGES = ["mcap", pytest.param("sqlite3", marks=pytest.mark.sweep)]
RECORDED = ("/chatter", "/odom", "/scan", "/robot_description")


class World(NamedTuple):
    """The robot of a classroom, and the router of its bridge."""

    robot: DdsRobot
    endpoint: str


@contextmanager
def classroom(distro: str) -> Generator[World]:
    with ExitStack() as stack:
        endpoint = stack.enter_context(running_router())
        network = stack.enter_context(DdsNetwork())
        network.bridge(connect=endpoint, distro=distro)
        robot = network.robot("classroom", distro=distro)
        robot.ask("serve", service="/add", type_name=ADD, behaviour="add")
        robot.ask("serve_fibonacci")
        robot.ask("manage", node="/arm")
        said(World(robot, endpoint), "/arm/get_state", "service", "list")
        yield World(robot, endpoint)


@pytest.fixture(scope="module")
def world() -> Generator[World]:
    with classroom("jazzy") as made:
        yield made


def run(world: World, *words: str) -> str:
    """What a line prints that ends well."""
    ran = studio(*words, "--connect", world.endpoint)
    assert ran.code == 0, (ran.out, ran.err)
    return ran.out


def said(world: World, text: str, *words: str) -> None:
    """Wait until a line prints a text: what a robot has just begun is told a moment later."""
    wait_until(f"{text} said", lambda: text in run(world, *words))


def test_nodes_and_topics_are_listed_at_once_and_whole(world: World):
    for _ in range(2):
        assert run(world, "node", "list").split() == ["/arm", "/driver", "/laser", "/robot",
                                                      "/talker"]  # fmt: skip
        listed = run(world, "topic", "list", "-t").splitlines()
        assert "/scan [sensor_msgs/msg/LaserScan]" in listed
        assert "/cmd_vel [geometry_msgs/msg/Twist]" in listed
        assert len(listed) == len(set(listed)) > 8
    told = run(world, "node", "info", "/driver")
    assert "/odom: nav_msgs/msg/Odometry" in told
    assert "/reset_odometry: std_srvs/srv/Trigger" in told


def test_a_topic_is_told_echoed_and_its_rate_measured(world: World):
    told = run(world, "topic", "info", "-v", "/scan")
    assert "Node name: laser" in told
    assert "Reliability: BEST_EFFORT" in told
    assert "data: The robot says" in run(world, "topic", "echo", "--once", "/chatter")
    assert "<robot name" in run(world, "topic", "echo", "--once", "/robot_description")
    with started(world.endpoint, "topic", "hz", "/odom") as measuring:
        measuring.wait_for("average rate: ")


def test_what_is_published_once_reaches_it(world: World):
    twist = "{linear: {x: 0.125}}"
    run(world, "topic", "pub", "--once", "/cmd_vel", "geometry_msgs/msg/Twist", twist)
    wait_until(
        "it is heard",
        lambda: any(one["linear_m_s"] == 0.125 for one in world.robot.all_said("cmd_vel")),
    )


def test_it_is_called_led_and_given_goals_and_parameters(world: World):
    assert "sum=42" in run(world, "service", "call", "/add", ADD, "{a: 40, b: 2}")
    told = run(world, "action", "send_goal", "-f", "/fibonacci", FIBONACCI, "{order: 4}")
    assert "Feedback:" in told
    assert "SUCCEEDED" in told
    name = ("/driver", "speed_max_m_s")
    assert run(world, "param", "get", *name) == "Double value is: 1.0\n"
    assert "successful" in run(world, "param", "set", *name, "0.75")
    assert run(world, "param", "get", *name) == "Double value is: 0.75\n"
    assert run(world, "lifecycle", "set", "/arm", "configure") == "Transitioning successful\n"
    assert run(world, "lifecycle", "get", "/arm") == "inactive [2]\n"


@pytest.mark.parametrize("storage", STORAGES)
def test_it_is_recorded_and_played_back_to_it(world: World, tmp_path: Path, storage: str):
    bag = recorded(world, tmp_path / "bag", storage)
    whole(bag)
    played_back(world, bag, f"/again_{storage}")


@pytest.mark.parametrize("storage", STORAGES)
def test_a_robot_without_hashes_of_types_is_recorded_and_hears_it(tmp_path: Path, storage: str):
    with classroom("humble") as world:
        bag = recorded(world, tmp_path / "bag", storage)
        whole(bag)
        played_back(world, bag, "/again")


def played_back(world: World, bag: Path, topic: str) -> None:
    """The robot hears what it said."""
    world.robot.ask("subscribe", topic=topic, type_name="std_msgs/msg/String")
    words = ("--topics", "/chatter", "--remap", f"/chatter:={topic}", "--loop")
    with started(world.endpoint, "bag", "play", str(bag), *words):
        heard = world.robot.wait_heard(topic)["data"]
    assert heard.startswith("The robot says ")


def recorded(world: World, bag: Path, storage: str) -> Path:
    """A bag with messages on each topic."""
    words = (*RECORDED, "-s", storage, "-o", str(bag))
    with started(world.endpoint, "bag", "record", *words) as recording:
        for topic in RECORDED:
            recording.wait_for(f"Subscribed to topic '{topic}'")
        empty = size(bag)
        wait_until("it has some of each", lambda: size(bag) > empty + 30_000)
        assert recording.stop() == 0
    return bag


def size(bag: Path) -> int:
    files = [one for one in bag.iterdir() if one.suffix in {".mcap", ".db3"}]
    return sum(one.stat().st_size for one in files)


def whole(bag: Path) -> None:
    """It has messages of each topic that others can read, and tells how they were published."""
    with AnyReader([bag], default_typestore=get_typestore(Stores.ROS2_JAZZY)) as reader:
        told: dict[str, Any] = {
            connection.topic: reader.deserialize(data, connection.msgtype)
            for connection, _, data in reader.messages()
        }
    assert sorted(told) == sorted(RECORDED)
    assert told["/robot_description"].data == URDF
    assert told["/scan"].header.frame_id == "laser"
    about = yaml.safe_load((bag / "metadata.yaml").read_text())["rosbag2_bagfile_information"]
    topics = {
        one["topic_metadata"]["name"]: one["topic_metadata"]
        for one in about["topics_with_message_count"]
    }
    (latched,) = topics["/robot_description"]["offered_qos_profiles"]
    assert latched["durability"] == "transient_local"
    (sensor,) = topics["/scan"]["offered_qos_profiles"]
    assert sensor["reliability"] == "best_effort"

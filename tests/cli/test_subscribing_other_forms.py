from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.ros.qos import DurabilityPolicy, QoSProfile
from studio.ros.types.library import TypeLibrary
from tests.support.command_line import started, studio
from tests.support.demos import node_at

if TYPE_CHECKING:
    from collections.abc import Generator

TELEMETRY = "my_robot_interfaces/msg/CustomTelemetry"


@pytest.fixture(scope="module", autouse=True)
def student(endpoint: str) -> Generator[None]:
    """A node whose CustomTelemetry is not the studio's."""
    types = TypeLibrary("jazzy")
    types.add_texts({TELEMETRY: "float32 charge\ngeometry_msgs/Point[] path\n"})
    kept = QoSProfile(depth=3, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    with node_at(endpoint, "student", types) as node:
        point = types.message("geometry_msgs/msg/Point")(x=-1.0)
        kind = types.message(TELEMETRY)
        publisher = node.create_publisher(kind, "/telemetry", kept)
        for charge in (0.25, 0.5, 0.75):
            publisher.publish(kind(charge=charge, path=[point]))
        yield


def test_t11_a_form_of_a_students_own_is_shown_as_its_node_tells_it(endpoint: str):
    ran = studio("topic", "echo", "/telemetry", "--once", "--connect", endpoint)
    assert ran.code == 0
    assert ran.out == "charge: 0.25\npath:\n- x: -1.0\n  y: 0.0\n  z: 0.0\n---\n"
    assert ran.err == f"WARNING: /student has another form of {TELEMETRY}, which is shown\n"


def test_its_messages_are_counted_and_chosen_from(endpoint: str):
    at = ("--connect", endpoint)
    words = ("topic", "echo", "/telemetry", "--once", "--filter", "m.charge > 0.6", "--csv")
    assert studio(*words, *at).out == "0.75,-1.0,0.0,0.0\n"
    with started(endpoint, "topic", "bw", "/telemetry", *at) as bw:
        bw.wait_for("from 3 messages\n")


def test_a_form_of_another_distribution_is_not_taken_but_named(endpoint: str):
    ran = studio("topic", "echo", "/telemetry", "--timeout", "0.2", "--distro", "humble",
                 "--connect", endpoint)  # fmt: skip
    assert ran.code == 1
    assert "WARNING: Others have " in ran.err

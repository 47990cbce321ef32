from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.cli.commands.doctor import faults_of
from studio.ros.messages import message, service
from studio.ros.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from studio.ros.types.library import TypeLibrary
from tests.support.command_line import comes_to, studio
from tests.support.demos import node_at
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

    from studio.ros.client import Node


@pytest.fixture
def node(endpoint: str) -> Generator[Node]:
    with node_at(endpoint, "tester") as made:
        yield made


def found(node: Node, types: TypeLibrary | None = None) -> dict[str, str]:
    """The sentence of each kind of fault, as the node sees its domain."""
    node.graph.settle()
    return {
        one.kind: one.sentence
        for one in faults_of(node.graph, types or node.wire.types, node.wire.profile)
    }


def test_n6_a_sound_system_has_no_faults(node: Node):
    node.create_publisher(message("std_msgs/msg/String"), "/chatter", 10)
    assert found(node) == {}


def test_n6_quality_of_service_that_does_not_meet_is_found(node: Node):
    kind = message("std_msgs/msg/String")
    node.create_publisher(kind, "/x", QoSProfile(reliability=ReliabilityPolicy.BEST_EFFORT))
    late = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_subscription(kind, "/x", print, late)
    sentence = found(node)["QoS"]
    assert sentence.startswith("/x: the publisher is volatile, the subscription wants transient")
    assert sentence.endswith("(/tester to /tester); Zenoh carries it, DDS would not.")


def test_n6_two_types_of_one_topic_are_found(node: Node):
    node.create_publisher(message("std_msgs/msg/String"), "/x", 10)
    node.create_subscription(message("std_msgs/msg/Int64"), "/x", print, 10)
    assert found(node)["type"].startswith("/x has 2 types, std_msgs/msg/Int64, std_msgs/msg/String")


def test_n6_two_servers_and_a_form_of_another_distribution_are_found(node: Node, endpoint: str):
    kind = service("std_srvs/srv/Trigger")
    node.create_service(kind, "/go", lambda _request, response: response)
    node.create_publisher(message("std_msgs/msg/String"), "/x", 10)
    with node_at(endpoint, "other") as other:
        other.create_service(kind, "/go", lambda _request, response: response)
        other.graph.settle()
        assert found(other)["two servers"] == (
            "/go is served 2 times, by /other, /tester: keep one."
        )
    strange = TypeLibrary("jazzy")
    strange.add_texts({"std_msgs/msg/String": "string data\nstring more\n"})
    sentence = found(node, strange)["hash"]
    assert "std_msgs/msg/String as of" in sentence
    assert "choose --distro" in sentence


def test_n6_an_unknown_type_is_found(node: Node, endpoint: str):
    node.wire.types.add_texts({"own_interfaces/msg/Odd": "string data\n"})
    node.create_publisher(node.wire.types.message("own_interfaces/msg/Odd"), "/odd", 10)
    assert "own_interfaces/msg/Odd" in found(node, TypeLibrary("jazzy"))["unknown type"]
    ran = studio("doctor", "--connect", endpoint)
    assert ran.code == 1
    assert ran.out.startswith("unknown type: /odd: ")


def test_n6_the_report_names_router_domain_nodes_and_findings(node: Node, endpoint: str):
    node.create_publisher(message("std_msgs/msg/String"), "/chatter", 10)
    node.graph.settle()
    ran = studio("doctor", "--report", "--connect", endpoint)
    assert ran.code == 0
    for text in (
        "\n   RMW MIDDLEWARE\n",
        f"router          : {endpoint}\n",
        "domain          : 0\n",
        "\n   NODE LIST\n/tester : session ",
        "/chatter          : std_msgs/msg/String, publishers 1, subscribers 0\n",
        "\n   FINDINGS\nnone : all is well\n",
    ):
        assert text in ran.out


def test_two_nodes_of_one_name_are_one_finding(node: Node, endpoint: str):
    kind = service("std_srvs/srv/Trigger")
    node.create_service(kind, "/go", lambda _request, response: response)
    with node_at(endpoint, "tester") as twin:
        twin.create_service(kind, "/go", lambda _request, response: response)
        wait_until("both", lambda: node.graph.duplicate_nodes() == {"/tester": 2})
        wait_until("both serve", lambda: len(node.graph.servers("/go")) == 2)
        assert list(found(node)) == ["duplicate name"]
        lines = studio("doctor", "--connect", endpoint).out.splitlines()
    assert lines == [
        "duplicate name: 2 nodes are called /tester: start all but one with another name."
    ]


def test_one_node_that_serves_a_name_twice_is_a_finding_still(node: Node):
    kind = service("std_srvs/srv/Trigger")
    for _ in range(2):
        node.create_service(kind, "/go", lambda _request, response: response)
    assert found(node)["two servers"] == "/go is served 2 times, by /tester, /tester: keep one."


def test_a_faulty_text_of_the_workspace_is_found(
    node: Node, endpoint: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    package = tmp_path / "src" / "own_interfaces"
    (package / "msg").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>own_interfaces</name></package>")
    (package / "msg" / "Bad.msg").write_text("int32 Speed\n")
    monkeypatch.setenv("STUDIO_DATA_DIR", str(tmp_path / "data"))
    monkeypatch.chdir(tmp_path)
    ran = studio("doctor", "--connect", endpoint)
    assert ran.code == 1
    assert ran.out.startswith(f"interface text: {package / 'msg' / 'Bad.msg'}:1: ")
    assert ran.out.endswith("single underscores: write speed.\n")


@pytest.mark.sweep
def test_reports_say_that_the_nodes_are_in_another_domain(node: Node, endpoint: str):
    at = ("--connect", endpoint, "--domain", "77")
    said = "No node is in domain 77, but 1 node is in domain "
    for option in (), ("--report",), ("-rf",):
        comes_to(lambda ran: said in ran.out, "doctor", *option, *at)
        assert "all is well" not in studio("doctor", *option, *at).out

"""`studio doctor`: what it prints and writes; the findings themselves are tests/live/doctor's."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest

from studio.live.doctor.seen import short
from studio.ros.messages import message, service
from studio.ros.qos import QoSProfile, ReliabilityPolicy
from tests.support.command_line import comes_to, studio
from tests.support.demos import node_at
from tests.support.pretend_bridge import PretendBridge, talking_bridge
from tests.support.wire import free_endpoint, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

    from studio.ros.client import Node

STRING = message("std_msgs/msg/String")


@pytest.fixture
def node(endpoint: str) -> Generator[Node]:
    with node_at(endpoint, "tester") as made:
        yield made


@pytest.fixture
def at(endpoint: str) -> tuple[str, ...]:
    """The router, and no time for listening, where that is not what a test is about."""
    return ("--connect", endpoint, "--listen", "0")


def test_a_sound_system_is_well(node: Node, at: tuple[str, ...]):
    node.create_publisher(STRING, "/chatter", 10)
    node.create_subscription(STRING, "/chatter", print, 10)
    node.graph.settle()
    ran = studio("doctor", *at)
    assert (ran.code, ran.out) == (0, "All is well: 1 nodes, 3 topics.\n")


def test_each_fault_is_a_line_with_its_kind_and_exit_code_1(node: Node, at: tuple[str, ...]):
    best_effort = QoSProfile(reliability=ReliabilityPolicy.BEST_EFFORT)
    node.create_publisher(STRING, "/x", best_effort)
    node.create_subscription(STRING, "/x", print, 10)
    kind = service("std_srvs/srv/Trigger")
    for _ in range(2):
        node.create_service(kind, "/go", lambda _request, response: response)
    node.graph.settle()
    ran = studio("doctor", *at)
    assert ran.code == 1
    assert ran.out.splitlines() == [
        "QoS: /x: the publisher is best effort, the subscription wants reliable (/tester to "
        "/tester); Zenoh carries it, DDS would not.",
        "    /tester offers best effort, volatile, depth 42",
        "    /tester asks for reliable, volatile, depth 10",
        "    $ ros2 topic info -v /x",
        "two servers: /go is served 2 times, by /tester, /tester: keep one.",
        *[f"    /tester of process {node.wire.zid[:8]}: std_srvs/srv/Trigger"] * 2,
    ]
    for option in "-rf", "--report":
        lines = studio("doctor", option, *at).out.partition("\n   FINDINGS\n")[2].splitlines()
        at_qos = next(number for number, one in enumerate(lines) if one.startswith("QoS "))
        column = lines[at_qos].index("/x: the publisher is best effort")
        assert lines[at_qos][column - 3 : column] == " : "
        assert lines[at_qos + 1 : at_qos + 4] == [
            f"{'':{column}}  {one}"
            for one in (
                "/tester offers best effort, volatile, depth 42",
                "/tester asks for reliable, volatile, depth 10",
                "$ ros2 topic info -v /x",
            )
        ]


def test_a_topic_of_one_side_alone_is_no_fault(node: Node, at: tuple[str, ...]):
    node.create_publisher(STRING, "/spoken", 10)
    node.graph.settle()
    ran = studio("doctor", *at)
    assert (ran.code, ran.out) == (0, "All is well: 1 nodes, 3 topics.\n")
    report = studio("doctor", "--report", *at)
    assert "no subscriber" in report.out
    assert "/tester publishes /spoken, which nobody subscribes to." in report.out


def test_n6_an_unknown_type_is_found(node: Node, at: tuple[str, ...]):
    node.wire.types.add_texts({"own_interfaces/msg/Odd": "string data\n"})
    node.create_publisher(node.wire.types.message("own_interfaces/msg/Odd"), "/odd", 10)
    node.graph.settle()
    ran = studio("doctor", *at)
    assert ran.code == 1
    assert ran.out.startswith("unknown type: /odd: ")


def test_n6_the_report_names_router_domain_nodes_and_findings(
    node: Node, endpoint: str, at: tuple[str, ...]
):
    node.create_publisher(STRING, "/chatter", 10)
    node.create_subscription(STRING, "/chatter", print, 10)
    node.graph.settle()
    ran = studio("doctor", "--report", *at)
    assert ran.code == 0
    for text in (
        "\n   NETWORK CONFIGURATION\n",
        "\n   RMW MIDDLEWARE\n",
        f"router          : {endpoint}\n",
        "router's Zenoh  : 1.",
        "domain          : 0\n",
        "\n   NODE LIST\n/tester : session ",
        "/chatter          : std_msgs/msg/String, publishers 1, subscribers 1\n",
        "\n   FINDINGS\nnone                   : all is well\n",
    ):
        assert text in ran.out


def test_two_nodes_of_one_name_are_one_finding(node: Node, endpoint: str, at: tuple[str, ...]):
    kind = service("std_srvs/srv/Trigger")
    node.create_service(kind, "/go", lambda _request, response: response)
    with node_at(endpoint, "tester") as twin:
        twin.create_service(kind, "/go", lambda _request, response: response)
        wait_until("both", lambda: node.graph.duplicate_nodes() == {"/tester": 2})
        wait_until("both serve", lambda: len(node.graph.servers("/go")) == 2)
        lines = studio("doctor", *at).out.splitlines()
    sentence, *evidence, line = lines
    assert sentence == (
        "duplicate name: 2 nodes are called /tester: start all but one with another name."
    )
    assert [one.startswith("    /tester of process ") for one in evidence] == [True, True]
    assert line == "    $ ros2 run PACKAGE EXECUTABLE --ros-args -r __node:=OTHER_NAME"


def test_a_faulty_text_of_the_workspace_is_found(
    node: Node, at: tuple[str, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    package = tmp_path / "src" / "own_interfaces"
    (package / "msg").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>own_interfaces</name></package>")
    (package / "msg" / "Bad.msg").write_text("int32 Speed\n")
    monkeypatch.setenv("STUDIO_DATA_DIR", str(tmp_path / "data"))
    monkeypatch.chdir(tmp_path)
    node.graph.settle()
    ran = studio("doctor", *at)
    assert ran.code == 1
    assert ran.out.startswith(f"interface text: {package / 'msg' / 'Bad.msg'}:1: ")
    sentence, evidence = ran.out.splitlines()
    assert sentence.endswith("single underscores: write speed.")
    assert evidence == (
        "    own_interfaces/msg/Bad is not known because of "
        f"{short(str(package / 'msg' / 'Bad.msg'))}, line 1"
    )


def test_what_comes_is_listened_to(node: Node, endpoint: str):
    out = node.create_publisher(STRING, "/counted", 10)
    node.create_timer(0.01, lambda: out.publish(STRING(data="x")))
    node.create_subscription(STRING, "/counted", print, 10)
    node.graph.settle()
    ran = studio("doctor", "--report", "--listen", "0.5", "--connect", endpoint)
    (line,) = (one for one in ran.out.partition("LISTENED TO")[2].splitlines() if "/counted" in one)
    assert line.endswith(" Hz")
    assert int(line.split(":")[1].split()[0]) > 5


def test_json_holds_all_findings_and_what_was_examined(
    node: Node, endpoint: str, at: tuple[str, ...]
):
    node.create_publisher(STRING, "/spoken", 10)
    node.graph.settle()
    ran = studio("doctor", "--json", *at)
    told = json.loads(ran.out)
    assert ran.code == 0
    assert told["facts"]["router"] == endpoint
    assert "no-subscriber" in {one["code"] for one in told["findings"]}
    assert {one["subject"]: one["state"] for one in told["subjects"]}["nodes"] == "well"


def test_the_html_is_written_and_where_there_is_no_router_too(
    node: Node, at: tuple[str, ...], tmp_path: Path
):
    node.create_publisher(STRING, "/spoken", 10)
    node.graph.settle()
    file = tmp_path / "report.html"
    ran = studio("doctor", "--html", str(file), *at)
    assert (ran.code, ran.err) == (0, f"Report: {file}\n")
    assert "/spoken" in file.read_text()
    nowhere = ("--connect", free_endpoint())
    ran = studio("doctor", "--html", str(file), *nowhere)
    assert ran.code == 2
    assert ran.out.startswith("no router: No router answers at ")
    assert "No router answers at" in file.read_text()
    assert studio("doctor", *nowhere).code == 2
    refused = studio("doctor", "--html", str(tmp_path / "no" / "where.html"), *at)
    assert refused.code == 2
    assert "where.html cannot be written: " in refused.err


@pytest.mark.parametrize("text", ["-1", "nan", "many", "1e9"])
def test_a_time_that_is_none_is_refused(text: str):
    assert studio("doctor", f"--listen={text}").code == 2


@pytest.mark.sweep
def test_reports_say_that_the_nodes_are_in_another_domain(node: Node, endpoint: str):
    at = ("--connect", endpoint, "--domain", "77")
    said = "No node is in domain 77, but 1 node is in domain "
    for option in (), ("--report",), ("-rf",):
        comes_to(lambda ran: said in ran.out, "doctor", *option, *at)
        ran = studio("doctor", *option, *at)
        assert ("all is well" in ran.out, ran.code) == (False, 0)


def test_bridges_to_dds_and_nodes_behind_them_are_reported(endpoint: str, at: tuple[str, ...]):
    config = {"namespace": "/robot1", "ros_localhost_only": True, "pub_max_frequencies": ["/a=5"]}
    with talking_bridge(endpoint, **config) as bridge:
        ran = studio("doctor", "--report", *at)
        for text in (
            "\n   BRIDGES TO DDS\n",
            f"/robot1 : version 1.10.0, domain 0, nodes 1, session {bridge.zid}\n",
            "it meets only nodes of its own machine\n",
            "at most 5 a second of /a\n",
            "/robot1/talker : behind /robot1\n",
        ):
            assert text in ran.out
        told = json.loads(studio("doctor", "--json", *at).out)
    assert told["facts"]["bridges"] == "/robot1 1.10.0"


def test_a_bridge_that_finds_nobody_is_said_and_no_fault(endpoint: str, at: tuple[str, ...]):
    with PretendBridge(endpoint) as bridge:
        bridge.show()
        comes_to(lambda ran: "finds no node on DDS" in ran.out, "doctor", *at)
        assert studio("doctor", *at).code == 0

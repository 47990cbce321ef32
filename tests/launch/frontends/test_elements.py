from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.launch_files import planned

if TYPE_CHECKING:
    from pathlib import Path

    from studio.launch.plan import Plan

_XML = """\
<launch>
  <arg name="gui" default="true" description="show it"/>
  <arg name="kind"><choice value="a"/><choice value="b"/></arg>
  <let name="rate" value="2.5"/>
  <group>
    <push_ros_namespace namespace="left"/>
    <set_remap from="x" to="y"/>
    <node pkg="demo_nodes_py" exec="talker" name="t" args="--to $(var gui) 'b c'" respawn="true"
          output="screen" if="$(var gui)">
      <param name="rate" value="$(var rate)"/>
      <param name="text" value="7" type="str"/>
      <param name="list" value="1;2" value-sep=";"/>
      <param name="deep"><param name="er" value="true"/></param>
      <param from="$(dirname)/p.yaml"/>
      <remap from="a" to="b"/>
      <env name="E" value="1"/>
    </node>
  </group>
  <node pkg="demo_nodes_py" exec="listener" name="l"
        unless="$(eval '\\'$(var kind)\\' == \\'a\\'')"/>
  <executable cmd="echo hi $(env HOME /)" shell="true"/>
  <timer period="2.0"><log message="late"/></timer>
  <set_env name="MODEL" value="burger"/>
  <node pkg="robot_state_publisher" exec="robot_state_publisher">
    <param name="robot_description"
           value="$(command 'xacro $(find-pkg-share rover_description)/r.xacro k:=$(var kind)')"/>
  </node>
</launch>
"""
_YAML = """\
launch:
- arg: {name: gui, default: "true", description: show it}
- arg:
    name: kind
    choice:
    - value: a
    - value: b
- let: {name: rate, value: "2.5"}
- group:
  - push_ros_namespace: {namespace: left}
  - set_remap: {from: x, to: y}
  - node:
      pkg: demo_nodes_py
      exec: talker
      name: t
      args: "--to $(var gui) 'b c'"
      respawn: true
      output: screen
      if: $(var gui)
      param:
      - {name: rate, value: $(var rate)}
      - {name: text, value: "7", type: str}
      - {name: list, value: [1, 2]}
      - name: deep
        param:
        - {name: er, value: true}
      - {from: $(dirname)/p.yaml}
      remap:
      - {from: a, to: b}
      env:
      - {name: E, value: "1"}
- node: {pkg: demo_nodes_py, exec: listener, name: l, unless: "$(equals $(var kind) a)"}
- executable: {cmd: "echo hi $(env HOME /)", shell: true}
- timer:
    period: 2.0
    children:
    - log: {message: late}
- set_env: {name: MODEL, value: burger}
- node:
    pkg: robot_state_publisher
    exec: robot_state_publisher
    param:
    - name: robot_description
      value: "$(command 'xacro $(find-pkg-share rover_description)/r.xacro k:=$(var kind)')"
"""


@pytest.mark.parametrize(("name", "text"), [("a.launch.xml", _XML), ("a.launch.yaml", _YAML)])
def test_xml_and_yaml_say_the_same_as_python_would(tmp_path: Path, name: str, text: str):
    (tmp_path / "p.yaml").write_text("/**:\n  ros__parameters:\n    of_file: 1\n")
    plan = planned(tmp_path, text, name, kind="b")
    assert plan.failures == ()
    assert plan.unsupported == ()
    assert [(one.name, one.choices, one.value) for one in plan.arguments] == [
        ("gui", (), "true"),
        ("kind", ("a", "b"), "b"),
    ]
    talker, listener, publisher = plan.nodes
    assert (talker.full_name, talker.respawn, talker.output) == ("/left/t", True, "screen")
    assert talker.arguments == ("--to", "true", "b c")
    assert {one.name: one.value for one in talker.parameters} == {
        "rate": 2.5,
        "text": "7",
        "list": [1, 2],
        "deep.er": True,
        "of_file": 1,
    }
    assert [(one.source, one.target) for one in talker.remaps] == [("x", "y"), ("a", "b")]
    assert talker.environment == {"E": "1"}
    assert talker.where.line > 0
    assert listener.condition is not None
    assert listener.condition.holds is True
    assert listener.namespace == "/"
    assert plan.processes[0].shell
    assert (plan.log[0].text, plan.log[0].when) == ("late", "after 2 s")
    assert plan.settings[0].name == "MODEL"
    assert publisher.parameters[0].robot == 0
    assert plan.robots[0].mappings == {"k": "b"}
    assert plan.robots[0].file.endswith("rover_description/r.xacro")


def _sentences(plan: Plan) -> str:
    rows = [*plan.failures, *plan.unsupported]
    return " | ".join(f"{one.where.line}: {one.sentence}" for one in rows)


@pytest.mark.parametrize(
    ("element", "sentence"),
    [
        ('<node pkg="a" type="b"/>', "2: node: it needs exec= (type= is of ROS 1)"),
        ('<node pkg="a" exec="b" ns="c"/>', '2: "ns" of node is not known: it is of ROS 1'),
        ('<include file="$(find a)/b"/>', "is of ROS 1: in ROS 2 write $(find-pkg-share PACKAGE)"),
        ('<arg name="a" value="b"/>', "2: arg with value= is of ROS 1"),
        ('<rosparam file="x"/>', "2: <rosparam> here is of ROS 1"),
        ('<log message="$(var a"/>', "is not closed: write ) at its end"),
        ('<log message="$(nope a)"/>', "is no substitution that is known"),
        ('<log message="$(var a)"/>', "2: launch configuration 'a' does not exist"),
        ('<log message="a" if="maybe"/>', "is 'maybe', which is neither true nor false"),
        ("<frobnicate/>", "2: not supported: frobnicate is no action that the studio knows"),
        ('<node pkg="a" exec="b"><param name="x"/></node>', "it needs value="),
    ],
)
def test_a_fault_of_an_element_is_a_sentence_with_its_line(
    tmp_path: Path, element: str, sentence: str
):
    plan = planned(tmp_path, f"<launch>\n{element}\n</launch>\n", "a.launch.xml")
    assert sentence in _sentences(plan)

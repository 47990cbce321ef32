"""The editable texts that the bytes of a file alone tell."""

from __future__ import annotations

import time

from studio.description.sites.file_sites import FileSite, xml_sites, yaml_sites
from studio.description.syntax.annotations import Annotation
from studio.description.syntax.source_tree import parse_source
from studio.description.values import SiteKind

ROBOT = """\
<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <!-- Copyright somebody -->
  <xacro:arg name="arm" default="true"/>  <!-- with the arm -->

  <!-- Wheels -->
  <xacro:property name="radius" value="0.1"/> <!-- [0.05:0.3] m -->
  <xacro:property name="width"
                  value="${radius / 2}"/> <!-- across -->
  <!-- how heavy
       one is -->
  <xacro:property name="mass" value="2"/>
  <xacro:property name="block"><origin xyz="1 2 3"/></xacro:property>

  <xacro:macro name="wheel" params="side:=left *origin x:='1 2'">
    <link name="${side}_wheel">
      <visual><origin xyz="0 0 ${radius}" rpy="0 0 0"/></visual>
      <visual><geometry><cylinder radius="0.05" length="${width}"/></geometry></visual>
      <sensor><origin xyz="9 9 9"/></sensor>
    </link>
  </xacro:macro>
  <xacro:wheel side="right"><origin xyz="0 -1 0"/></xacro:wheel>
  <joint name="lift" type="prismatic"><xacro:if value="$(arg arm)"><limit lower="0"/></xacro:if>
    <axis xyz="0 0 1"/></joint>
  <gazebo><origin xyz="7 7 7"/></gazebo>
  <material name="red"><color rgba="1 0 0 1"/></material>
</robot>
"""


def sites(text: str = ROBOT) -> dict[str, FileSite]:
    found = xml_sites(parse_source("/r.xacro", text.encode())).sites
    return {f"{one.group}: {one.name}": one for one in found}


def test_every_kind_of_text_is_found_with_its_group_and_no_foreign_number():
    assert {key: (one.kind, one.text) for key, one in sites().items()} == {
        ": arm": (SiteKind.ARG, "true"),
        "Wheels: radius": (SiteKind.PROPERTY, "0.1"),
        "Wheels: width": (SiteKind.PROPERTY, "${radius / 2}"),
        "Wheels: mass": (SiteKind.PROPERTY, "2"),
        "block: xacro:property/origin @xyz": (SiteKind.LITERAL, "1 2 3"),
        "wheel: side": (SiteKind.PARAM_DEFAULT, "left"),
        "wheel: x": (SiteKind.PARAM_DEFAULT, "1 2"),
        "${side}_wheel: link/visual[1]/origin @rpy": (SiteKind.LITERAL, "0 0 0"),
        "${side}_wheel: link/visual[2]/geometry/cylinder @radius": (SiteKind.LITERAL, "0.05"),
        "wheel: xacro:wheel/origin @xyz": (SiteKind.LITERAL, "0 -1 0"),
        "lift: joint/limit @lower": (SiteKind.LITERAL, "0"),
        "lift: joint/axis @xyz": (SiteKind.LITERAL, "0 0 1"),
        "red: material/color @rgba": (SiteKind.LITERAL, "1 0 0 1"),
    }


def test_comments_on_the_line_and_above_are_read():
    found = sites()
    assert found[": arm"].annotation == Annotation(help="with the arm")
    assert found["Wheels: radius"].annotation == Annotation(0.05, 0.3, unit="m")
    assert found["Wheels: width"].annotation == Annotation(help="across")
    assert found["Wheels: mass"].annotation == Annotation(help="how heavy one is")


def test_the_span_holds_the_text_and_the_place_the_element():
    one = sites()["Wheels: radius"]
    assert ROBOT.encode()[one.span.start : one.span.end] == b"0.1"
    assert (one.place.file, one.place.line, one.place.column) == ("/r.xacro", 6, 3)


def test_a_joint_that_slides_says_so_in_its_path():
    assert sites()["lift: joint/limit @lower"].element_path == "joint:prismatic/limit"


def test_ids_outlast_an_edit_of_any_text_and_are_all_different():
    longer = ROBOT.replace("0.1", "0.12345").replace("0 -1 0", "0 -1.5 0").replace("left", "l")
    ids = [one.id for one in sites().values()]
    assert ids == [one.id for one in sites(longer).values()]
    assert len(set(ids)) == len(ids)


def test_a_number_that_became_an_expression_stays_editable():
    before = xml_sites(parse_source("/r.xacro", ROBOT.encode()))
    edited = ROBOT.replace('"0 -1 0"', '"0 ${-radius} 0"').encode()
    after = xml_sites(parse_source("/r.xacro", edited), before)
    assert [one.id for one in after.sites] == [one.id for one in before.sites]
    assert "0 ${-radius} 0" in {one.text for one in after.sites}


def test_a_default_of_a_property_is_a_text_of_its_own():
    text = ROBOT.replace('name="mass" value="2"', 'name="mass" default="2"')
    one = sites(text)["Wheels: mass"]
    assert (one.attribute, one.text) == ("default", "2")


YAML = """\
top: 1   # [0:5] m
joints:
  # Shoulder
  lift:
    # how far up
    max: !degrees 90.0   # [0:180]
    min: 0

  list: [1, 2]  # both
"""


def test_yaml_values_are_named_by_their_keys_and_grouped_by_their_parent():
    found = yaml_sites("/l.yaml", YAML.encode()).sites
    assert {one.name: (one.group, one.text, one.annotation) for one in found} == {
        "top": ("", "1", Annotation(0, 5, unit="m")),
        "joints.lift.max": (
            "joints.lift",
            "90.0",
            Annotation(0, 180, unit="deg", help="how far up"),
        ),
        "joints.lift.min": ("joints.lift", "0", Annotation()),
        "joints.list[0]": ("joints.list", "1", Annotation(help="both")),
        "joints.list[1]": ("joints.list", "2", Annotation(help="both")),
    }
    assert found[1].id == "/l.yaml#joints.lift.max"


def test_a_heading_above_values_at_the_top_of_a_yaml_file_groups_them():
    found = yaml_sites("/l.yaml", b"# Wheels\na: 1\nb: 2\n").sites
    assert [one.group for one in found] == ["Wheels", "Wheels"]


def test_large_hostile_files_are_drafted_soon():
    """One line of many values, many comments above one value, many brothers in one link."""
    started = time.thread_time()
    flow = "[" + ", ".join(f"é{n}" for n in range(30_000)) + "]"
    assert len(yaml_sites("/f.yaml", flow.encode()).sites) == 30_000
    commented = "".join(f"# {n}\n" for n in range(20_000)) + "a: 1 # x\n" * 10_000
    assert len(yaml_sites("/f.yaml", commented.encode()).sites) == 1
    visuals = '<visual><origin xyz="0 0 0"/></visual>' * 10_000
    robot = f'<robot name="r"><!-- {"<a" * 1_000_000} --><link name="l">{visuals}</link></robot>'
    assert len(xml_sites(parse_source("/r.xacro", robot.encode())).sites) == 10_000
    assert time.thread_time() - started < 20  # about 1 s; what grows with the square takes minutes

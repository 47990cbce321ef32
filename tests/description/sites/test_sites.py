"""Sites of real runs: values, readers and owners, and that they stay the same objects."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import pytest

from studio.description.editing.edits import decode, difference, edit_at, inverse
from studio.description.session import Session
from studio.description.sites.sites import SiteBuilder
from studio.description.values import (
    ArgumentsRequest,
    EditRequest,
    Expansion,
    OpenRequest,
    ReadPolicy,
    Site,
    SiteKind,
    WidgetKind,
)

if TYPE_CHECKING:
    from pathlib import Path

    from studio.description.evaluator.runs import RunRecord

ROVER = """\
<robot name="rover" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="sensor" default="lidar"/>
  <xacro:property name="sensor" value="$(arg sensor)"/>
  <xacro:property name="radius" value="0.1"/>
  <xacro:property name="unused" value="${radius / 2}"/>
  <xacro:property name="limits" value="${xacro.load_yaml('limits.yaml')}"/>
  <xacro:macro name="wheel" params="side y:=0.5">
    <link name="${side}_wheel">
      <visual><origin xyz="0 0 0.25"/>
        <geometry><cylinder radius="${radius}" length="0.05"/></geometry></visual>
    </link>
    <joint name="${side}_joint" type="revolute">
      <origin xyz="0 ${y} 0"/>
      <limit lower="${limits.pan.lower}" upper="${limits.pan.upper}" effort="1" velocity="1"/>
    </joint>
  </xacro:macro>
  <link name="base"><inertial><mass value="3.5"/></inertial></link>
  <xacro:wheel side="left"/>
  <xacro:wheel side="right" y="-0.5"/>
  <xacro:if value="${sensor == 'camera'}"><link name="camera"/></xacro:if>
  <xacro:unless value="${sensor in ['none', 'camera']}"><link name="lidar"/></xacro:unless>
</robot>
"""
LIMITS = """\
pan: &pan
  lower: -1.0
  upper: !degrees 90
tilt: *pan
other: 7
"""


class Opened:
    """A session on the rover, with the sites of all its runs so far."""

    def __init__(self, folder: Path, arguments: dict[str, str] | None = None) -> None:
        (folder / "rover.xacro").write_text(ROVER, "utf-8")
        (folder / "limits.yaml").write_text(LIMITS, "utf-8")
        self.xacro = str(folder / "rover.xacro")
        policy = ReadPolicy((str(folder),), {}, {})
        self.session = Session(OpenRequest(self.xacro, arguments or {}, policy, {}))
        self.sites: dict[str, Site] = {}
        self.run(OpenRequest(self.xacro, arguments or {}, policy, {}))

    def run(self, request: OpenRequest | EditRequest | ArgumentsRequest) -> set[str]:
        """Run, and name the sites that changed."""
        answer = self.session.answer(request)
        assert isinstance(answer, Expansion), answer
        self.sites.update((site.id, site) for site in answer.changed_sites)
        return {site.name for site in answer.changed_sites}

    def site(self, name: str, kind: SiteKind = SiteKind.PROPERTY) -> Site:
        return next(s for s in self.sites.values() if (s.name, s.kind) == (name, kind))


@pytest.fixture
def rover(tmp_path: Path) -> Opened:
    return Opened(tmp_path)


def test_a_property_knows_its_value_and_how_many_read_it(rover: Opened):
    radius = rover.site("radius")
    assert (radius.text, radius.value, radius.number, radius.reads) == ("0.1", "0.1", 0.1, 2)
    assert (radius.widget.kind, radius.widget.unit) == (WidgetKind.SLIDER, "m")


def test_what_nobody_reads_has_no_value(rover: Opened):
    unused = rover.site("unused")
    assert (unused.value, unused.number, unused.reads) == ("", None, 0)
    assert unused.widget.kind is WidgetKind.TEXT


def test_choices_come_from_conditions_also_through_a_property(rover: Opened):
    widget = rover.site("sensor", SiteKind.ARG).widget
    assert widget.kind is WidgetKind.CHOICE
    assert {"lidar", "camera"} <= set(widget.choices)


def test_a_default_counts_only_the_calls_that_take_it(rover: Opened):
    default = rover.site("y", SiteKind.PARAM_DEFAULT)
    assert (default.value, default.reads) == ("0.5", 1)
    assert default.widget.unit == "m"


def test_a_literal_of_one_link_names_its_owner_and_of_two_none(rover: Opened):
    mass = rover.site("link/inertial/mass @value", SiteKind.LITERAL)
    assert (mass.owner, mass.group, mass.widget.unit) == ("link:base", "base", "kg")
    length = rover.site("link/visual/geometry/cylinder @length", SiteKind.LITERAL)
    assert (length.owner, length.reads, length.group) == ("", 2, "${side}_wheel")


def test_yaml_values_are_sites_with_readers_and_units(rover: Opened):
    lower, upper = (rover.site(f"pan.{name}", SiteKind.YAML) for name in ("lower", "upper"))
    assert (lower.number, lower.reads, lower.widget.unit) == (-1.0, 2, "rad")
    assert (upper.number, upper.reads, upper.widget.unit) == (90.0, 2, "deg")
    assert rover.site("other", SiteKind.YAML).reads == 0


def test_what_is_read_through_an_alias_counts_where_it_is_written(tmp_path: Path):
    through_alias = ROVER.replace("limits.pan", "limits.tilt").encode()
    opened = Opened(tmp_path)
    edit = difference(opened.xacro, ROVER.encode(), through_alias)
    assert edit is not None
    opened.run(EditRequest((edit,)))
    assert opened.site("pan.lower", SiteKind.YAML).reads == 2


def test_an_edit_changes_its_own_site_and_moves_only_what_stands_behind(rover: Opened):
    radius = rover.site("radius")
    edit = edit_at(rover.xacro, ROVER.encode(), radius.span, "0.2")
    assert rover.run(EditRequest((edit,))) == {"radius"}
    assert rover.site("radius").number == 0.2
    assert rover.site("radius").id == radius.id


def test_a_drag_keeps_the_range_of_its_slider(rover: Opened):
    before = rover.site("radius")
    rover.run(EditRequest((edit_at(rover.xacro, ROVER.encode(), before.span, "0.3"),)))
    assert rover.site("radius").widget == before.widget


def test_a_value_that_comes_back_from_far_away_gets_its_slider_back(rover: Opened):
    before = rover.site("radius")
    far = edit_at(rover.xacro, ROVER.encode(), before.span, "50.0")
    rover.run(EditRequest((far,)))
    assert rover.site("radius").widget.maximum == 200
    rover.run(EditRequest((inverse(ROVER.encode(), far),)))
    assert rover.site("radius") == before


def test_an_argument_from_outside_is_the_value_of_its_arg(rover: Opened):
    changed = rover.run(ArgumentsRequest({"sensor": "camera"}))
    assert "sensor" in changed
    arg = rover.site("sensor", SiteKind.ARG)
    assert (arg.text, arg.value) == ("lidar", "camera")


def test_the_sites_of_an_equal_run_are_the_same_objects(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    records = recorded(monkeypatch)
    Opened(tmp_path)
    builder = SiteBuilder()
    first, second = builder.build(records[0]), builder.build(records[0])
    assert first
    assert all(one is other for one, other in zip(first, second, strict=True))


def recorded(monkeypatch: pytest.MonkeyPatch) -> list[RunRecord]:
    """The records of all runs from now on."""
    records: list[RunRecord] = []
    build = SiteBuilder.build

    def build_and_keep(self: SiteBuilder, record: RunRecord) -> list[Site]:
        records.append(record)
        return build(self, record)

    monkeypatch.setattr(SiteBuilder, "build", build_and_keep)
    return records


@pytest.mark.corpus
def test_every_site_of_a_large_robot_holds_its_text_and_is_built_soon(
    corpus: Path, monkeypatch: pytest.MonkeyPatch
):
    from tests.support.corpus_files import package_folders

    records = recorded(monkeypatch)
    policy = ReadPolicy((str(corpus),), package_folders(corpus), {})
    (entry,) = corpus.glob("PR2*/pr2_description/robots/pr2.urdf.xacro")
    session = Session(OpenRequest(str(entry), {}, policy, {}))
    answer = session.run()
    assert isinstance(answer, Expansion), answer
    files = {name: tree.data for name, tree in records[0].trees.items()}
    assert len(answer.changed_sites) > 500
    for site in answer.changed_sites:
        assert decode(files[site.place.file], site.span) == site.text, site.id
    builder = SiteBuilder()
    builder.build(records[0])
    started = time.thread_time()
    builder.build(records[0])
    assert time.thread_time() - started < 0.1  # 2 ms on an idle machine


@pytest.mark.corpus
def test_the_yaml_of_a_real_arm_is_editable(corpus: Path):
    from tests.support.corpus_files import package_folders

    policy = ReadPolicy((str(corpus),), package_folders(corpus), {})
    (entry,) = corpus.glob("Universal*/urdf/ur.urdf.xacro")
    arguments = {"ur_type": "ur10e", "name": "ur"}
    answer = Session(OpenRequest(str(entry), arguments, policy, {})).run()
    assert isinstance(answer, Expansion), answer
    yaml = {site.name: site for site in answer.changed_sites if site.kind is SiteKind.YAML}
    limit = yaml["joint_limits.shoulder_pan_joint.max_position"]
    assert (limit.number, limit.widget.unit, limit.reads) == (360.0, "deg", 1)
    assert yaml["kinematics.shoulder.z"].widget.unit == "m"

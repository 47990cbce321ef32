"""Edits that are patched: always what a full run gives, and patched where they can be."""

from __future__ import annotations

import logging
import os
import random
import re
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from studio.description.values import ArgumentsRequest, Edit, ReadPolicy, SiteKind
from studio.errors import EditError
from tests.support.corpus import corpus
from tests.support.corpus_files import package_folders
from tests.support.descriptions import policy_for, robot, write
from tests.support.generated_xacro import files, texts
from tests.support.patch_sweep import sweep
from tests.support.patched import SideBySide
from tests.support.sweep import some_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

MODELS = Path(__file__).resolve().parents[3] / "models"
NUMBERS = st.sampled_from(["3", "0.25", "-1", "7", "12.5", "0", "1", "-0.0", "left", "true"])
BODY = """
<xacro:arg name="size" default="2"/>
<xacro:property name="limits" value="${xacro.load_yaml('l.yaml')}"/>
<xacro:property name="arm" value="${limits.arm}"/>
<xacro:property name="radius" value="0.1"/>
<xacro:property name="width" value="${radius * 2 * $(arg size)}"/>
<xacro:property name="same" value="${max(radius, 100)}"/>
<xacro:property name="lonely" value="${width}"/>
<xacro:property name="tall" value="false"/>
<xacro:macro name="ball" params="name r:=0.5 mass:=1 *extra">
  <link name="${name}">
    <inertial><mass value="${mass}"/></inertial>
    <visual><geometry><sphere radius="${r}"/></geometry><xacro:insert_block name="extra"/></visual>
  </link>
</xacro:macro>
<xacro:ball name="one" r="${radius}"><origin xyz="0 0 ${width / 2}" rpy="0 0 0"/></xacro:ball>
<xacro:ball name="two"><origin xyz="${arm.upper} 0 0"/></xacro:ball>
<link name="box"><visual><origin xyz="0 0 1"/><geometry><box size="1 2 3"/></geometry></visual>
</link>
<link name="far"><visual><origin xyz="${same} ${arm['lower']} 0"/></visual></link>
<gazebo reference="one"><mu1>${radius + 1}</mu1></gazebo>
<xacro:if value="${tall}"><link name="tower"/></xacro:if>
"""
YAML = "arm:\n  lower: -1.5  # [-3:3]\n  upper: !degrees 90\nunread: 4\n"


@pytest.fixture(autouse=True)
def no_failed_patch(caplog: pytest.LogCaptureFixture) -> Iterator[None]:
    """A refusal is one of the known ones, none a mistake of ours."""
    with caplog.at_level(logging.ERROR, "studio.description"):
        yield
    assert not caplog.records, caplog.text


@pytest.fixture
def side(tmp_path: Path) -> SideBySide:
    file = write(tmp_path, {"r.xacro": robot(BODY), "l.yaml": YAML})
    return SideBySide(file, policy_for(tmp_path))


def site_of(side: SideBySide, name: str, kind: SiteKind = SiteKind.PROPERTY) -> str:
    """The id of a site, by its name."""
    sites = (side.told.site(one) for one in side.told.sites)
    return next(one.id for one in sites if (one.name, one.kind) == (name, kind))


def edited(side: SideBySide, site: str, text: str) -> bool:
    """Edit; whether that was patched, and in any case as a full run has it."""
    is_patch = side.edit(site, text)
    assert side.differences() == []
    return is_patch


@pytest.mark.parametrize(
    ("name", "kind", "text"),
    [
        ("radius", SiteKind.PROPERTY, "0.25"),
        ("width", SiteKind.PROPERTY, "3"),
        ("lonely", SiteKind.PROPERTY, "3"),
        ("arm", SiteKind.PROPERTY, "none"),
        ("size", SiteKind.ARG, "4"),
        ("r", SiteKind.PARAM_DEFAULT, "0.125"),
        ("arm.upper", SiteKind.YAML, "45"),
        ("arm.lower", SiteKind.YAML, "-0.25"),
        ("unread", SiteKind.YAML, "5"),
        ("link/visual/origin @xyz", SiteKind.LITERAL, "0 0 -1.5"),
        ("link/visual/geometry/box @size", SiteKind.LITERAL, "1 2 3.5"),
    ],
)
def test_one_text_of_every_kind_is_patched(side: SideBySide, name: str, kind: SiteKind, text: str):
    if name == "arm":
        assert not edited(side, site_of(side, name, kind), text)  # its readers fail then
    else:
        assert edited(side, site_of(side, name, kind), text)


def test_a_patch_tells_the_changed_parts_and_sites_only(side: SideBySide):
    side.edit(site_of(side, "r", SiteKind.PARAM_DEFAULT), "0.75")
    told = side.patched_answer()
    assert told.is_patch
    assert [part.key for part in told.changed_parts] == ["link:two"]
    assert [site.name for site in told.changed_sites] == ["r"]
    assert told.part_order is None
    assert told.site_order is None


def test_a_value_that_comes_to_the_same_goes_no_further(side: SideBySide):
    side.edit(site_of(side, "radius"), "0.2")
    keys = {part.key for part in side.patched_answer().changed_parts}
    assert keys == {"link:one", "other:0"}


def test_an_argument_from_outside_is_patched(tmp_path: Path):
    file = write(tmp_path, {"r.xacro": robot(BODY), "l.yaml": YAML})
    side = SideBySide(file, policy_for(tmp_path), {"size": "3"})
    assert side.send(ArgumentsRequest({"size": "5"}))
    assert side.differences() == []
    assert not side.send(ArgumentsRequest({}))
    assert side.differences() == []


def test_a_burst_of_edits_is_one_patch(side: SideBySide):
    radius, box = (
        side.told.site(site_of(side, "radius")).span,
        side.told.site(site_of(side, "link/visual/geometry/box @size", SiteKind.LITERAL)).span,
    )
    file = side.request.entry
    assert side.splice(
        Edit(file, radius.start, radius.end, b"0.11111"),
        Edit(file, radius.start, radius.start + 7, b"0.2"),
        Edit(file, box.start, box.end, b"7 8 9"),
    )
    assert side.differences() == []


@pytest.mark.parametrize(
    ("name", "text"),
    [("tall", "true"), ("radius", "${1 + 1}"), ("radius", "${unknown}"), ("radius", "'")],
)
def test_what_changes_more_than_values_is_run_in_full(side: SideBySide, name: str, text: str):
    site = site_of(side, name)
    assert not edited(side, site, text)
    edited(side, site, "0.5" if name == "radius" else "false")
    assert edited(side, site_of(side, "size", SiteKind.ARG), "3")


def test_an_angle_beyond_all_numbers_is_left_to_the_full_run(side: SideBySide):
    assert not edited(side, site_of(side, "arm.upper", SiteKind.YAML), "9" * 400)
    assert side.told.failure is not None


def test_a_whole_number_that_no_file_may_hold_is_left_to_the_full_run(side: SideBySide):
    assert not edited(side, site_of(side, "arm.lower", SiteKind.YAML), "9" * 400)
    assert side.told.failure is not None


def test_after_a_failure_the_next_good_run_is_patched_again(side: SideBySide):
    side.edit(site_of(side, "width"), "${nothing}")
    assert side.told.failure is not None
    assert side.differences() == []
    side.edit(site_of(side, "width"), "1")
    assert edited(side, site_of(side, "width"), "2")


@pytest.mark.parametrize(
    "body",
    [
        '<xacro:property name="l" value="${[3, 4]}"/><link name="${l.pop()}">'
        '<visual><origin xyz="${l.pop()} ${a} 0"/></visual></link>',
        '<xacro:property name="z" value="${python.zip([a], [2])}"/><link name="b"><visual>'
        '<origin xyz="${dict(z).get(1)} 0 ${len(list(z))}"/></visual></link>',
        '<xacro:property name="a" remove="true"/><link name="b"/>',
        '<link name="b"><visual><origin xyz="${xacro.warning(a)} 0 0"/></visual></link>',
        '<xacro:property name="p" value="${a}" scope="global"/>'
        '<link name="b"><visual><origin xyz="${p} ${a} 0"/></visual></link>'
        '<xacro:property name="a" value="9"/><link name="c"><inertial><mass value="${a}"/>'
        "</inertial></link>",
    ],
    ids=["pop", "iterator", "remove", "warning", "redefined"],
)
def test_what_depends_on_the_moment_is_as_in_a_full_run(tmp_path: Path, body: str):
    source = robot(f'<xacro:property name="a" value="1"/>{body}')
    side = SideBySide(write(tmp_path, {"r.xacro": source}), policy_for(tmp_path))
    site = side.told.sites[0]
    for text in ("2", "3.5", "1"):
        edited(side, site, text)


def test_values_are_told_apart_as_they_print(tmp_path: Path):
    body = (
        '<xacro:property name="a" value="1"/><xacro:property name="b" value="${[a, 0]}"/>'
        '<link name="c"><visual><origin xyz="${a} ${b[0]} ${-b[0] * 0}"/></visual></link>'
    )
    side = SideBySide(write(tmp_path, {"r.xacro": robot(body)}), policy_for(tmp_path))
    for text in ("1.0", "true", "-1.0", "1", "0.0", "-0.0", "0"):
        assert edited(side, side.told.sites[0], text)


@pytest.mark.parametrize(
    ("held", "reader"),
    [
        ("[python.zip([1], [2])]", "p[0]"),
        ("[[python.zip([1], [2])]]", "p[0][0]"),
        ("(python.reversed([1, 2]), 1)", "p[0]"),
        ("dict(a=map(str, [1, 2]))", "p['a']"),
        ("dict(a=map(str, [1, 2])).values()", "list(p)[0]"),
    ],
)
def test_what_holds_an_iterator_is_never_read_a_second_time(tmp_path: Path, held: str, reader: str):
    """Its first reader uses it up: evaluated once more, that one would find it empty."""
    body = (
        f'<xacro:property name="p" value="${{{held}}}"/><xacro:property name="c" value="1"/>'
        f'<link name="a"><inertial><mass value="${{len(list({reader})) + c}}"/></inertial></link>'
    )
    side = SideBySide(write(tmp_path, {"r.xacro": robot(body)}), policy_for(tmp_path))
    assert not edited(side, site_of(side, "c"), "2")


def test_choices_that_an_argument_gives_another_property_follow_it(tmp_path: Path):
    body = (
        '<xacro:arg name="t" default="left"/><xacro:property name="k" value="right"/>'
        '<xacro:property name="m" value="${1 if k == \'$(arg t)\' else 2}"/>'
        '<link name="a"><inertial><mass value="${m}"/></inertial></link>'
    )
    side = SideBySide(write(tmp_path, {"r.xacro": robot(body)}), policy_for(tmp_path))
    assert not edited(side, site_of(side, "t", SiteKind.ARG), "middle")
    assert "middle" in side.told.site(site_of(side, "k")).widget.choices


def test_a_lazy_property_is_read_by_the_next_reader_when_its_first_is_gone(tmp_path: Path):
    body = (
        '<xacro:property name="y" value="${xacro.load_yaml(\'l.yaml\')}"/>'
        '<xacro:property name="s" value="${y.arm}"/>'
        '<xacro:property name="first" value="${s.lower}"/>'
        '<xacro:property name="second" value="${s.lower + 1}"/>'
        '<link name="a"><visual><origin xyz="${first} ${second} 0"/></visual></link>'
    )
    file = write(tmp_path, {"r.xacro": robot(body), "l.yaml": YAML})
    side = SideBySide(file, policy_for(tmp_path))
    assert edited(side, site_of(side, "first"), "1.5")
    assert edited(side, site_of(side, "arm.lower", SiteKind.YAML), "-0.5")
    edited(side, site_of(side, "second"), "2")


@pytest.mark.sweep
@pytest.mark.parametrize(
    "name", sorted(str(one.relative_to(MODELS)) for one in MODELS.rglob("*.urdf.xacro"))
)
def test_every_number_of_our_models_edited_and_edited_back_is_as_in_a_full_run(name: str):
    file = MODELS / name
    done = sweep(file, policy_for(MODELS))
    assert done.wrong == []
    assert done.patched > done.full


@pytest.mark.parametrize("seed", some_of(range(6), 6))
@pytest.mark.parametrize("name", ["rover_description/urdf/rover.urdf.xacro", "arm6_description"])
def test_a_random_sequence_of_edits_of_our_models_is_as_in_full_runs(name: str, seed: int):
    file = next(iter((MODELS / name).rglob("*.urdf.xacro")), MODELS / name)
    side, choose = SideBySide(file, policy_for(MODELS)), random.Random(seed)
    for _ in range(25):
        site = side.told.site(choose.choice(side.told.sites))
        near = f"{(site.number or 1) * choose.uniform(0.5, 2):.4f}"
        text = choose.choice([near, near, near, "0", "-1.5", "100", f"${{{near}}}", "true"])
        side.edit(site.id, text)
        assert side.differences() == []
        if side.told.failure is not None:
            side.undo()
            assert side.differences() == []
    assert side.patched
    assert side.misplaced() == []


@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(files(), st.data())
def test_random_edits_of_random_files_are_as_in_a_full_run(
    tmp_path_factory: pytest.TempPathFactory, made: Mapping[str, str], data: st.DataObject
):
    folder = tmp_path_factory.mktemp("generated")
    tame = {name: _without_moments(text) for name, text in made.items()}
    arguments = data.draw(st.sampled_from([{}, {"a": "2", "b": "x"}]))
    try:
        side = SideBySide(write(folder, tame), policy_for(folder), arguments)
    except AssertionError:
        return  # it does not run at all
    for _ in range(4):
        if arguments and data.draw(st.integers(0, 4)) == 0:
            side.send(ArgumentsRequest({name: data.draw(NUMBERS) for name in arguments}))
        else:
            site = data.draw(st.sampled_from(side.told.sites))
            try:
                side.edit(site, data.draw(st.one_of(NUMBERS, NUMBERS, texts)))
            except EditError:
                continue
        assert side.differences() == []
        assert side.told.failure or side.misplaced() == []


def _without_moments(text: str) -> str:
    """Most of what makes a file impossible to patch taken out of it."""
    text = re.sub(r'<xacro:property name="[abc]" remove="[^"]*"/>', "", text)
    text = text.replace('<xacro:include filename="no.xacro" optional="true"/>', "")
    return text.replace(".pop(", ".get(").replace(" in n}", " in [1]}")


@pytest.mark.parametrize(
    ("pattern", "arguments", "every"),
    [
        ("pr2_description/robots/pr2.urdf.xacro", {}, 24),
        ("UniversalRobots*/urdf/ur.urdf.xacro", {"ur_type": "ur10e", "name": "ur"}, 8),
        ("turtlebot4_description/urdf/standard/turtlebot4.urdf.xacro", {}, 12),
        ("ANYbotics*/urdf/*.urdf", {}, 40),
        ("kortex_description/robots/gen3.xacro", {"dof": "7"}, 12),
        ("xarm_description/urdf/xarm_device.urdf.xacro", {"dof": "7", "robot_type": "xarm"}, 12),
    ],
)
def test_real_robots_edited_and_edited_back_are_as_in_a_full_run(
    pattern: str, arguments: dict[str, str], every: int
):
    folder = corpus()
    found = sorted(folder.rglob(pattern))
    assert found, pattern
    policy = ReadPolicy((str(folder),), package_folders(folder), {})
    done = sweep(found[0], policy, arguments, every=int(os.environ.get("SWEEP_EVERY", every)))
    assert done.wrong == []
    assert done.sites

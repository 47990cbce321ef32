"""What a text shapes: held against what really changes when it is edited."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from studio.description.editing.edits import edit_at
from studio.description.origins.effects import EFFECTS_KEPT, READERS_KEPT, aspect_of
from studio.description.origins.origin_values import Aspect, SiteEffects
from studio.description.sites.widgets import parse_number
from studio.description.values import NoReply, SiteKind
from tests.support.corpus import corpus
from tests.support.descriptions import robot, write
from tests.support.sweep import some_of
from tests.support.traced_robots import Key, TracedRobot

MODELS = Path(__file__).resolve().parents[3] / "models"


def opened(folder: Path, body: str) -> TracedRobot:
    return TracedRobot(write(folder, {"a.xacro": robot(body)}))


def shaped(traced: TracedRobot, name: str, kind: SiteKind = SiteKind.PROPERTY) -> set[Key]:
    found = traced.effects(traced.site(name, kind)).effects
    return {(one.part, one.element, one.attribute) for one in found}


def test_a_property_shapes_what_its_readers_readers_are_made_of(tmp_path: Path):
    body = (
        '<xacro:property name="a" value="1"/>\n<xacro:property name="b" value="${a}"/>\n'
        '<xacro:property name="c" value="1"/>\n<link name="x"><mass value="${b}"/></link>'
    )
    traced = opened(tmp_path, body)
    assert shaped(traced, "a") == {("link:x", "mass", "value")}
    assert [place.line for place in traced.effects(traced.site("a")).readers] == [2]
    assert traced.effects(traced.site("c")).effects == ()
    assert traced.effects(traced.site("c")).readers == ()


def test_what_is_read_only_by_what_nobody_reads_shapes_nothing(tmp_path: Path):
    body = (
        '<xacro:macro name="m" params="p q"><link name="x"><mass value="${p}"/></link>'
        '</xacro:macro><xacro:property name="a" value="1"/><xacro:property name="b" value="2"/>'
        '<xacro:m p="${a}" q="${b}"/>'
    )
    traced = opened(tmp_path, body)
    assert shaped(traced, "a") == {("link:x", "mass", "value")}
    assert traced.site("b").reads == 1
    assert shaped(traced, "b") == set()


def test_a_condition_decides_about_the_outermost_elements_in_it(tmp_path: Path):
    body = (
        '<xacro:arg name="on" default="true"/><xacro:if value="$(arg on)">'
        '<link name="a"><visual/></link></xacro:if>'
        '<link name="b"><xacro:if value="$(arg on)"><visual/></xacro:if></link>'
    )
    traced = opened(tmp_path, body)
    found = traced.effects(traced.site("on", SiteKind.ARG))
    assert {(one.part, one.element, one.aspect) for one in found.effects} == {
        ("link:a", "", Aspect.PRESENCE),
        ("link:b", "visual", Aspect.PRESENCE),
    }
    assert found.decisions == 2


def test_a_condition_that_is_not_met_is_decided_all_the_same(tmp_path: Path):
    body = (
        '<xacro:arg name="on" default="false"/>'
        '<xacro:if value="$(arg on)"><link name="a"/></xacro:if><link name="b"/>'
    )
    found = opened(tmp_path, body)
    told = found.effects(found.site("on", SiteKind.ARG))
    assert (told.effects, told.decisions) == ((), 1)
    assert len(told.readers) == 1


def test_a_literal_shapes_every_copy_that_came_out(tmp_path: Path):
    body = (
        '<xacro:macro name="m" params="n"><link name="${n}"><visual><geometry>'
        '<sphere radius="0.5"/></geometry></visual></link></xacro:macro>'
        '<xacro:m n="a"/><xacro:m n="b"/>'
    )
    traced = opened(tmp_path, body)
    (literal,) = [one for one in traced.sites.values() if one.kind is SiteKind.LITERAL]
    effects = traced.effects(literal).effects
    assert [(one.part, one.aspect) for one in effects] == [
        ("link:a", Aspect.SIZE),
        ("link:b", Aspect.SIZE),
    ]


def test_a_mapping_that_is_read_whole_is_shaped_by_each_of_its_values(tmp_path: Path):
    body = (
        '<xacro:property name="c" value="${xacro.load_yaml(\'c.yaml\')}"/>'
        '<link name="x"><note text="${c.all}"/><mass value="${c.one}"/></link>'
    )
    files = {"a.xacro": robot(body), "c.yaml": "all:\n  deep: 1\none: 2\n"}
    traced = TracedRobot(write(tmp_path, files))
    assert shaped(traced, "all.deep", SiteKind.YAML) == {("link:x", "note", "text")}
    assert shaped(traced, "one", SiteKind.YAML) == {("link:x", "mass", "value")}


def test_what_thousands_read_is_cut_and_it_is_said(tmp_path: Path):
    links = "".join(f'<link name="l{n}"><mass value="${{a}}"/></link>\n' for n in range(6_000))
    traced = opened(tmp_path, f'<xacro:property name="a" value="1"/>{links}')
    found = traced.effects(traced.site("a"))
    assert (len(found.effects), len(found.readers)) == (EFFECTS_KEPT, READERS_KEPT)
    assert found.is_cut


def test_a_text_that_is_gone_is_told_in_a_sentence(tmp_path: Path):
    traced = opened(tmp_path, '<link name="a"/>')
    assert isinstance(traced.ask("/no/such#1@value"), NoReply)


@pytest.mark.parametrize(
    ("part", "path", "attribute", "aspect"),
    [
        ("link:a", "visual[2]/geometry/box", "size", Aspect.SIZE),
        ("link:a", "visual/geometry/mesh", "scale", Aspect.SIZE),
        ("link:a", "visual/geometry/mesh", "filename", Aspect.SHAPE),
        ("link:a", "visual/origin", "xyz", Aspect.POSE),
        ("link:a", "visual/material/color", "rgba", Aspect.COLOR),
        ("link:a", "collision[3]/geometry/mesh", "filename", Aspect.COLLISION),
        ("link:a", "inertial/origin", "xyz", Aspect.INERTIA),
        ("link:a", "", "name", Aspect.NAME),
        ("joint:a#2", "origin", "rpy", Aspect.POSE),
        ("joint:a", "limit", "upper", Aspect.MOTION),
        ("joint:a", "parent", "link", Aspect.NAME),
        ("material:a", "color", "rgba", Aspect.COLOR),
        ("other:3", "plugin", "", Aspect.OTHER),
    ],
)
def test_an_attribute_says_what_changes_about_its_part(
    part: str, path: str, attribute: str, aspect: Aspect
):
    assert aspect_of(part, path, attribute) is aspect


def bumped(text: str) -> str | None:
    """Every number of a text a little larger; None when it has something else in it."""
    numbers = [parse_number(word) for word in text.split()]
    if not numbers or None in numbers:
        return None
    return " ".join(repr(round(n * 1.07 + 0.013, 6)) for n in numbers if n is not None)


def exchanged(changed: set[Key], told: SiteEffects) -> set[Key]:
    """Those in elements that a condition put in place of others of the same name."""
    decided = {(one.part, one.element) for one in told.effects if one.aspect is Aspect.PRESENCE}
    return {key for key in changed if key[:2] in decided}


def check_against_edits(traced: TracedRobot, count: int) -> tuple[int, int]:
    """Edit numbers, run whole, and compare; how many attributes changed, and were told beside.

    An edit that flips a condition or counts a loop further makes elements that were not there to
    be told of: it must have been told that there is a decision.
    """
    before = traced.attributes()
    sites = [site for site in traced.sites.values() if bumped(site.text)]
    changed_count = beside = 0
    for chosen in random.Random(1).sample(sites, min(count, len(sites))):
        site = traced.sites[chosen.id]
        told = traced.effects(site)
        effects = {(one.part, one.element, one.attribute) for one in told.effects}
        data = Path(site.place.file).read_bytes()
        edit = edit_at(site.place.file, data, site.span, bumped(site.text) or "")
        traced.edit(edit.file, edit.start, edit.end, edit.new)
        after = traced.attributes()
        changed = {key for key in before.keys() | after.keys() if before.get(key) != after.get(key)}
        if before.keys() == after.keys():
            assert changed - effects <= exchanged(changed, told), site
        else:
            assert told.decisions, site
        changed_count += len(changed)
        beside += sum(bool(key[2]) for key in effects - changed)
        end = edit.start + len(edit.new)
        traced.edit(edit.file, edit.start, end, data[edit.start : edit.end])
    assert traced.attributes() == before
    return changed_count, beside


@pytest.mark.parametrize("name", some_of(["rover", "arm6", "quadruped", "xacro_robot"], 2))
def test_what_is_told_is_what_changes_on_our_models(name: str):
    file = MODELS / f"{name}_description" / "urdf" / f"{name}.urdf.xacro"
    changed, beside = check_against_edits(TracedRobot(file, MODELS), 25)
    assert changed > 50
    # Told but unchanged: what happens to come out the same, as a factor of zero makes it.
    assert beside <= changed * 0.05


@pytest.mark.parametrize(
    ("file", "arguments"),
    [
        (
            "UniversalRobots+Universal_Robots_ROS2_Description/urdf/ur.urdf.xacro",
            {"ur_type": "ur10e", "name": "ur"},
        ),
        ("PR2+pr2_common/pr2_description/robots/pr2.urdf.xacro", {}),
    ],
)
def test_what_is_told_is_what_changes_on_real_robots(file: str, arguments: dict[str, str]):
    folder = corpus() / Path(file).parts[0]
    traced = TracedRobot(corpus() / file, folder, **arguments)
    changed, beside = check_against_edits(traced, 40)
    assert changed > 30
    assert beside <= changed * 0.1

"""Two robots compared line by line, as their parts lie in them."""

from __future__ import annotations

from studio.description.editing.line_diff import DiffLine
from studio.description.urdf import urdf_text
from studio.description.values import Part
from studio.documents.urdf import LINES_SHOWN, PartLines, difference, part_lines
from studio.problems import Place
from tests.support.expanded import element_of

ROOT = (("name", "r"),)


def part(key: str, xml: str) -> Part:
    return Part(key, element_of(xml), Place("/f"))


def link(name: str, size: str = "1") -> Part:
    return part(f"link:{name}", f'<link name="{name}"><box size="{size}"/></link>')


def lines(*parts: Part) -> list[PartLines]:
    return part_lines(ROOT, parts)


def changed(before: list[PartLines], after: list[PartLines]) -> list[DiffLine]:
    hunks = difference(before, after).hunks
    return [line for hunk in hunks for line in hunk if line.kind != "same"]


def test_the_lines_are_those_of_the_whole_text():
    text = [line for one in lines(link("a")) for line in one.lines]
    assert text == [
        '<?xml version="1.0" ?>',
        '<robot name="r">',
        '  <link name="a">',
        '    <box size="1" />',
        "  </link>",
        "</robot>",
    ]


def test_equal_robots_do_not_differ():
    assert difference(lines(link("a")), lines(link("a"))).hunks == ()


def test_a_changed_line_has_its_numbers_in_both():
    found = changed(lines(link("a"), link("b")), lines(link("a"), link("b", "2")))
    assert found == [
        DiffLine("old", 7, None, '    <box size="1" />'),
        DiffLine("new", None, 7, '    <box size="2" />'),
    ]


def test_a_part_that_comes_moves_the_numbers_of_those_behind():
    found = difference(lines(link("b")), lines(link("a"), link("b", "2")))
    assert (found.added, found.removed) == (4, 1)
    last = found.hunks[0][-1]
    assert (last.before, last.after, last.text) == (6, 9, "</robot>")


def test_changes_far_apart_stand_in_stretches_of_their_own():
    many = [link(f"l{n}") for n in range(20)]
    other = [link("l0", "2"), *many[1:-1], link("l19", "2")]
    first, second = difference(lines(*many), lines(*other)).hunks
    assert [line.kind for line in first].count("same") == 6
    assert second[-1].text == "</robot>"


def test_of_very_many_lines_the_first_are_shown_and_the_rest_counted():
    before = [link(f"l{n}") for n in range(3000)]
    after = [link(f"l{n}", "2") for n in range(3000)]
    found = difference(lines(*before), lines(*after))
    shown = sum(map(len, found.hunks))
    assert shown == LINES_SHOWN
    assert found.added == found.removed == 3000
    assert shown + found.left_out == 2 + 4 * 3000 + 1


def test_a_prefix_stays_as_it_was_written_and_is_declared_once():
    controller = ("xmlns:controller", "http://example.org/controller")
    attributes = (("name", "r"), controller)
    xml = f'<controller:x {controller[0]}="{controller[1]}"><controller:y k="1"/></controller:x>'
    text = urdf_text([part("other:0", xml), link("a")], attributes)
    assert "<controller:x>" in text
    assert '<controller:y k="1"' in text
    assert "ns0" not in text
    assert text.count("xmlns:controller") == 1
    shown = [line for one in part_lines(attributes, [part("other:0", xml)]) for line in one.lines]
    assert "  <controller:x>" in shown

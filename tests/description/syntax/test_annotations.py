"""The comment grammar, and which comment belongs to which value."""

from __future__ import annotations

import math

import pytest

from studio.description.syntax.annotations import (
    Annotation,
    Comment,
    Entry,
    attach_comments,
    read_annotation,
)

NOTHING = Annotation()


@pytest.mark.parametrize(
    ("comment", "text", "read"),
    [
        ("[0.05:0.3]", "0.1", Annotation(0.05, 0.3)),
        ("[0.05:0.005:0.3]", "0.1", Annotation(0.05, 0.3, 0.005)),
        ("[0.05:0.005:0.3] m", "0.1", Annotation(0.05, 0.3, 0.005, unit="m")),
        (
            " [0.05:0.005:0.3] m radius of a wheel ",
            "0.1",
            Annotation(0.05, 0.3, 0.005, unit="m", help="radius of a wheel"),
        ),
        ("Radius [0.05:0.3] m", "0.1", Annotation(0.05, 0.3, unit="m", help="Radius")),
        ("[ -1.5 : .5 : 1.5 ] rad/s", "0", Annotation(-1.5, 1.5, 0.5, unit="rad/s")),
        ("[-pi:pi/2] rad", "0", Annotation(-math.pi, math.pi / 2, unit="rad")),
        ("[0:360]°", "0", Annotation(0, 360, unit="deg")),
        ("[0:10] Nm, peak", "1", Annotation(0, 10, unit="N m", help="peak")),
        ("[0:10] kg·m²", "1", Annotation(0, 10, unit="kg m^2")),
        ("[0:10] meters", "1", Annotation(0, 10, unit="m")),
        ("[0:1] mass share", "1", Annotation(0, 1, help="mass share")),
        ("[a, b, c]", "a", Annotation(choices=("a", "b", "c"))),
        ('["two wheels", \'four\']', "four", Annotation(choices=("two wheels", "four"))),
        ("[1, 2, 4] wheels", "2", Annotation(choices=("1", "2", "4"), help="wheels")),
        ("which sensor [lidar, camera]", "camera",
         Annotation(choices=("lidar", "camera"), help="which sensor")),
        ("offsets as [x, y, z]", "a", Annotation(help="offsets as [x, y, z]")),
        ("[x, y, z]", "0 0 1", Annotation(help="[x, y, z]")),
        ("[one]", "one", Annotation(help="[one]")),
        ("max speed [rad/s]", "1", Annotation(unit="rad/s", help="max speed")),
        ("[3:1]", "2", Annotation(help="[3:1]")),
        ("[0:0:1]", "0", Annotation(help="[0:0:1]")),
        ("[0:9:1]", "0", Annotation(help="[0:9:1]")),
        ("[a:b]", "0", Annotation(help="[a:b]")),
        ("[-1e308:1e308]", "0", Annotation(help="[-1e308:1e308]")),
        ("only help.", "0", Annotation(help="only help.")),
        ("several\n     lines", "0", Annotation(help="several lines")),
        ("<xacro:property name='x'/>", "0", NOTHING),
        ("Copyright 2020 Somebody", "0", NOTHING),
        ("x" * 500, "0", NOTHING),
        ("", "0", NOTHING),
        ("=========", "0", NOTHING),
    ],
)  # fmt: skip
def test_a_comment_is_read_by_the_grammar(comment: str, text: str, read: Annotation):
    assert read_annotation([comment], text) == read


def test_of_two_comments_the_range_of_one_and_the_help_of_both_count():
    read = read_annotation(["how wide it is", "[1:2] m"], "1.5")
    assert read == Annotation(1, 2, unit="m", help="how wide it is")


def layout(text: str) -> list[tuple[tuple[str, ...], str]]:
    """Comments and heading of each value of a sketch: `v` a value, `o` no value, `#` a comment."""
    entries: list[Entry] = []
    comments: list[Comment] = []
    for number, line in enumerate(text.splitlines(), 1):
        before, mark, comment = line.partition("#")
        entries += [Entry(number, number, is_value=kind == "v") for kind in before.split()]
        if mark:
            comments.append(Comment(comment, number, number, own_line=not before.strip()))
    remarks = attach_comments(entries, comments)
    return [
        (tuple(one.strip() for one in remark.comments), remark.group)
        for entry, remark in zip(entries, remarks, strict=True)
        if entry.is_value
    ]


@pytest.mark.parametrize(
    ("sketch", "wanted"),
    [
        pytest.param("v # a\nv", [(("a",), ""), ((), "")], id="behind a value it is that value's"),
        pytest.param("v v # a", [(("a",), ""), (("a",), "")], id="behind two on a line, of both"),
        pytest.param("# a\nv\n\nv", [(("a",), ""), ((), "")], id="above one value it is its help"),
        pytest.param("# A\nv\nv", [((), "A"), ((), "A")], id="above a run it is the heading"),
        pytest.param("# A\n\nv", [((), "A")], id="standing alone it is the heading"),
        pytest.param("# [0:1]\nv\nv", [(("[0:1]",), ""), ((), "")], id="a range is no heading"),
        pytest.param("# A stop.\nv\nv", [(("A stop.",), ""), ((), "")], id="nor a sentence"),
        pytest.param(f"# {'w' * 61}\nv\nv", [(("w" * 61,), ""), ((), "")], id="nor a long text"),
        pytest.param("# === A ===\nv", [((), "A")], id="a frame makes a heading"),
        pytest.param("# A\nv\nv\n# b\nv\n\nv", [((), "A"), ((), "A"), (("b",), "A"), ((), "A")],
                     id="help does not end a group"),
        pytest.param("# A\nv\nv\no\nv", [((), "A"), ((), "A"), ((), "")], id="no value does"),
        pytest.param("# A\nv\nv\n# B\nv\nv", [((), "A"), ((), "A"), ((), "B"), ((), "B")],
                     id="and so does the next heading"),
        pytest.param("# A\n\n# [0:1] x\nv\nv", [(("[0:1] x",), "A"), ((), "A")],
                     id="a heading and help may both stand above"),
        pytest.param("# far\n# away\n\nv", [((), "away")], id="of two that stand alone the last"),
        pytest.param("# a\n# b\nv", [(("a", "b"), "")], id="two lines of help are both its"),
        pytest.param("o # a\nv", [((), "")], id="behind another element it is nobody's"),
        pytest.param("o\n# a\nv", [(("a",), "")], id="below another element it is the next one's"),
        pytest.param("v\n# a", [((), "")], id="below the last value it is nobody's"),
    ],
)  # fmt: skip
def test_comments_belong_to_values_by_their_lines(
    sketch: str, wanted: list[tuple[tuple[str, ...], str]]
):
    assert layout(sketch) == wanted

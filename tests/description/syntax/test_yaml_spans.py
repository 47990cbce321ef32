"""Positions and key paths of YAML scalars, against what PyYAML loads."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import pytest

from studio.description.editing.edits import apply, edit_at
from studio.description.syntax.annotations import Comment
from studio.description.syntax.yaml_spans import key_path_text, read_yaml_document
from tests.support.foreign_readers import yaml_value_at

if TYPE_CHECKING:
    from pathlib import Path

LIMITS = """\
# Räder, sizes
joint_limits:
  # about z
  shoulder_pan:
    max_position: !degrees  360.0   # [0:360] deg
    has_limits: true
    name: 'π "x"' # ünï
  offsets: [0.1, -2, {x: 1e-3}]
"a.b": "t\\tab"
"""


def texts(data: bytes) -> dict[str, str]:
    return {key_path_text(one.path): one.text for one in read_yaml_document(data).scalars}


def raws(data: bytes) -> dict[str, str]:
    return {
        key_path_text(one.path): data[one.span.start : one.span.end].decode()
        for one in read_yaml_document(data).scalars
    }


@pytest.mark.parametrize("mark", ["", "\ufeff"], ids=["plain", "with BOM"])
@pytest.mark.parametrize("line_end", ["\n", "\r\n"], ids=["LF", "CRLF"])
def test_spans_are_bytes_also_behind_letters_beyond_ascii(mark: str, line_end: str):
    data = (mark + LIMITS.replace("\n", line_end)).encode()
    assert raws(data) == {
        "joint_limits.shoulder_pan.max_position": "360.0",
        "joint_limits.shoulder_pan.has_limits": "true",
        "joint_limits.shoulder_pan.name": "'π \"x\"'",
        "joint_limits.offsets[0]": "0.1",
        "joint_limits.offsets[1]": "-2",
        "joint_limits.offsets[2].x": "1e-3",
        '["a.b"]': '"t\\tab"',
    }


def test_lines_columns_and_tags_are_told():
    first = read_yaml_document(LIMITS.encode()).scalars[0]
    assert (first.line, first.column, first.tag) == (5, 29, "!degrees")


def test_comments_are_found_outside_of_scalars_only():
    comments = read_yaml_document(b"a: 'x # no' # yes\n# own\nb: c#d\n").comments
    assert comments == (
        Comment(" yes", 1, 1, own_line=False),
        Comment(" own", 2, 2, own_line=True),
    )


def test_an_edit_keeps_tag_comment_and_neighbours():
    data = LIMITS.encode()
    first = read_yaml_document(data).scalars[0]
    edited = apply(data, [edit_at("f", data, first.span, "90.5")])
    assert edited == data.replace(b"360.0 ", b"90.5 ")


def test_of_a_key_that_occurs_twice_the_last_one_counts():
    data = b"a: 1\nb: 2\na: 3\n"
    assert texts(data) == {"b": "2", "a": "3"}
    assert [data[s.span.start] for s in read_yaml_document(data).scalars] == [ord("2"), ord("3")]


def test_of_a_mapping_that_occurs_twice_only_the_last_one_counts():
    assert texts(b"m:\n  a: 1\n  b: 2\nm:\n  a: 3\n") == {"m.a": "3"}


def test_scalars_over_lines_empty_ones_and_complex_keys_are_left_out():
    data = b"a: |\n  x\nb: 'one\n  two'\nc:\nd: ~\n? [1, 2]\n: 3\n? {x: 1}\n: {y: 4}\ne: 5\n"
    assert texts(data) == {"d": "~", "e": "5"}


def test_only_the_first_document_counts():
    assert texts(b"---\na: 1\n---\nb: 2\n") == {"a": "1"}


def test_an_alias_is_no_second_place_but_tells_what_it_stands_for():
    document = read_yaml_document(b"a: &x {q: 1}\nb: *x\nc:\n  <<: *x\n")
    assert [one.path for one in document.scalars] == [("a", "q")]
    assert document.aliases == ((("b",), ("a",)), (("c", "<<"), ("a",)))


@pytest.mark.parametrize(
    "text",
    ["a: [1", "a: b: c", "\tx: 1", "a: *unknown_is_fine\n b", "%YAML 9", "\0", "a: \x07"],
)
def test_a_broken_text_has_no_scalars(text: str):
    assert read_yaml_document(text.encode()).scalars == ()


def test_bytes_that_are_not_utf_8_have_no_scalars():
    assert read_yaml_document("a: é".encode("latin-1")).scalars == ()
    assert read_yaml_document("a: 1".encode("utf-16")).scalars == ()


def test_a_bomb_of_aliases_costs_no_more_than_its_text():
    lines = ["a0: &a0 [x, x, x, x, x, x, x, x, x]"]
    lines += [f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 9)}]" for n in range(1, 60)]
    started = time.thread_time()
    document = read_yaml_document("\n".join(lines).encode())
    assert len(document.scalars) == 9
    assert len(document.aliases) == 59 * 9
    assert time.thread_time() - started < 2


@pytest.mark.parametrize("text", ["- " * 50_000 + "1", "[" * 5_000, "{a: " * 5_000])
def test_a_bottomless_text_ends_soon(text: str):
    started = time.thread_time()
    read_yaml_document(text.encode())
    assert time.thread_time() - started < 5


@pytest.mark.corpus
def test_every_scalar_of_the_corpus_is_where_yaml_reads_it(corpus: Path):
    """Each is replaced by a mark, and the mark is found under its key path."""
    from tests.support.corpus_files import yaml_files

    checked = 0
    for path in yaml_files(corpus):
        data = path.read_bytes()
        document = read_yaml_document(data)
        for one in document.scalars[:: max(1, len(document.scalars) // 12)]:
            edited = apply(data, [edit_at("f", data, one.span, "m#a'r: k")])
            if b"\n---" in data or b"xacro" in data:
                continue
            assert yaml_value_at(edited, one.path) == "m#a'r: k", (path, one)
            checked += 1
    assert checked > 200


def test_a_text_of_more_values_than_any_run_reads_has_none():
    assert not read_yaml_document(b"k: [" + b"1," * 60_000 + b"1]\n").scalars

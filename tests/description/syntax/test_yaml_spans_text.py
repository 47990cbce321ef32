"""One YAML scalar, against PyYAML's own reading."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.description.syntax.yaml_spans import yaml_bytes, yaml_text
from studio.errors import EditError
from tests.support.foreign_readers import yaml_value_at

LINES = st.text(st.characters(exclude_categories=("Cs",)), max_size=20) | st.text(
    st.sampled_from(" -?:,[]{}#&*!|>'\"%@`~ab1.\\\t\n"), max_size=8
)
STYLES = st.sampled_from([b"1.5", b"'x'", b'"x"'])


PLACES: list[tuple[str, tuple[str | int, ...]]] = [
    ("key: {}\n", ("key",)),
    ("key: {{a: {}, b: 2}}\n", ("key", "a")),
    ("- {}\n", (0,)),
    ("{}\n", ()),
]


@pytest.mark.parametrize(("around", "path"), PLACES)
@given(text=LINES, like=STYLES)
def test_a_written_scalar_is_read_back_by_yaml(
    around: str, path: tuple[str | int, ...], text: str, like: bytes
):
    written = around.format(yaml_bytes(text, like).decode())
    assert yaml_value_at(written, path) == text


@given(LINES, STYLES)
def test_a_written_scalar_stands_on_one_line_and_decodes_to_its_text(text: str, like: bytes):
    written = yaml_bytes(text, like)
    assert len(written.decode().splitlines()) <= 1
    assert yaml_text(written) == text


@pytest.mark.parametrize(
    ("text", "like", "written"),
    [
        ("2.0", b"1.5", b"2.0"),
        ("true", b"false", b"true"),
        ("ur10e", b"ur5e", b"ur10e"),
        ("", b"x", b"''"),
        ("a: b", b"x", b"'a: b'"),
        ("a #b", b"x", b"'a #b'"),
        ("0:?", b"1.5", b"'0:?'"),
        ("-1.5", b"1", b"-1.5"),
        ("- 1", b"1", b"'- 1'"),
        ("it's", b"'x'", b"'it''s'"),
        ('say "x"', b'"x"', b'"say \\"x\\""'),
        ("°", b"x", "°".encode()),
        ("a\nb", b"x", b'"a\\nb"'),
    ],
)
def test_the_style_stays_and_quotes_come_only_when_needed(text: str, like: bytes, written: bytes):
    assert yaml_bytes(text, like) == written


def test_half_a_character_is_refused():
    with pytest.raises(EditError, match="half a character"):
        yaml_bytes("\ud800", b"x")


def test_bytes_that_are_not_utf_8_are_refused():
    with pytest.raises(EditError, match="not UTF-8"):
        yaml_text(b"\xff")

"""The YAML file of variants: written for people, read as hostile, comments kept."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.description.editing.variants import (
    SIZE_LIMIT_BYTES,
    VARIANT_LIMIT,
    TextName,
    Variant,
    read_variants,
    write_variants,
)
from studio.description.values import SiteKind
from studio.errors import VariantsFileError

PATH = "/robot/rover.variants.yaml"
RADIUS = TextName("rover.urdf.xacro", SiteKind.PROPERTY, "wheel_radius")
BIG = Variant("Big wheels", "For tall grass", {"arm": "true"}, {RADIUS: "0.12"})
SMALL = Variant("Small wheels")

BY_HAND = b"""\
# Our fleet.
version: 1

variants:   # the ones that we drive
  # The one of the fair.
  - name: Big wheels
    note: For tall grass   # and mud
    arguments: {arm: true}
    values:
      - {file: rover.urdf.xacro, property: wheel_radius, text: 0.12}

  # The first one.
  - name: Small wheels

# The end.
"""


def write(before: bytes, *variants: Variant) -> bytes:
    return write_variants(PATH, "rover.urdf.xacro", before, variants)


def test_a_new_file_reads_well():
    assert write(b"", BIG).decode() == (
        "# Variants of rover.urdf.xacro: named sets of arguments and values on top of what the "
        "files say.\n"
        "# Written by the studio; edit it as you like.\n"
        "version: 1\n"
        "variants:\n"
        "  - name: Big wheels\n"
        '    note: "For tall grass"\n'
        "    arguments:\n"
        '      arm: "true"\n'
        "    values:\n"
        "      - file: rover.urdf.xacro\n"
        "        property: wheel_radius\n"
        '        text: "0.12"\n'
    )


def test_what_a_person_wrote_is_read():
    assert read_variants(PATH, BY_HAND) == (BIG, SMALL)


@pytest.mark.parametrize("data", [b"", b"\n# nothing\n", b"variants:\n", b"variants: []\n"])
def test_a_file_without_variants_has_none(data: bytes):
    assert read_variants(PATH, data) == ()
    assert read_variants(PATH, write(data, BIG)) == (BIG,)


_text = st.text(st.characters(codec="utf-8"), max_size=20)
_line = _text.map(str.strip).filter(bool)
_names = st.builds(
    TextName,
    file=_line,
    kind=st.sampled_from([SiteKind.ARG, SiteKind.PROPERTY, SiteKind.YAML]),
    name=_text,
    number=st.integers(1, 9),
) | st.builds(
    TextName,
    file=_line,
    kind=st.sampled_from([SiteKind.PARAM_DEFAULT, SiteKind.LITERAL]),
    name=_text,
    within=_text,
)
_variants = st.lists(
    st.builds(
        Variant,
        name=_line,
        note=_text,
        arguments=st.dictionaries(_text, _text | st.none(), max_size=3),
        texts=st.dictionaries(_names, _text, max_size=3),
    ),
    max_size=3,
    unique_by=lambda one: one.name,
)


@given(_variants, _variants)
def test_whatever_is_written_reads_back(first: list[Variant], second: list[Variant]):
    written = write(b"", *first)
    assert read_variants(PATH, written) == tuple(first)
    assert read_variants(PATH, write(written, *second)) == tuple(second)
    others = [one for one in second if one.name not in (BIG.name, SMALL.name)]
    assert read_variants(PATH, write(BY_HAND, BIG, *others)) == (BIG, *others)


def test_variants_that_did_not_change_keep_their_lines():
    assert write(BY_HAND, BIG, SMALL) == BY_HAND


def test_a_changed_variant_keeps_the_comments_around_it():
    changed = Variant("Big wheels", "", {}, {RADIUS: "0.2"})
    written = write(BY_HAND, changed, SMALL).decode()
    assert read_variants(PATH, written.encode()) == (changed, SMALL)
    for line in ("# Our fleet.", "# The one of the fair.", "# The first one.", "# The end."):
        assert line in written
    assert "and mud" not in written


def test_a_renamed_variant_keeps_the_comments_above_it():
    renamed = Variant("Fair", BIG.note, BIG.arguments, BIG.texts)
    written = write(BY_HAND, renamed, SMALL).decode()
    assert "# The one of the fair.\n  - name: Fair\n" in written


def test_a_deleted_variant_goes_with_its_comment():
    written = write(BY_HAND, SMALL).decode()
    assert read_variants(PATH, written.encode()) == (SMALL,)
    assert "fair" not in written
    assert "# The first one.\n  - name: Small wheels\n\n# The end.\n" in written


def test_an_added_one_comes_last():
    added = Variant("Third")
    written = write(BY_HAND, BIG, SMALL, added).decode()
    assert "  - name: Small wheels\n  - name: Third\n\n# The end.\n" in written


def test_a_list_in_one_line_is_written_anew():
    flow = b"variants: [{name: Big wheels}, {name: Small wheels}]\n"
    assert read_variants(PATH, write(flow, BIG, SMALL)) == (BIG, SMALL)


BOMB = b"a: &a [x, x]\nb: &b [*a, *a]\nvariants: [*b, *b]\n"


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (BOMB, "anchor, alias or tag"),
        (b"variants:\n  - name: !!python/object/apply:os.system [id]\n", "anchor, alias or tag"),
        (b"variants: !!binary aGk=\n", "anchor, alias or tag"),
        (b"[" * 5000, "nested too deeply"),
        (b"variants: {", "no YAML"),
        (b"\xff\xfe", "not UTF-8"),
        (b"a: 1\n---\nb: 2\n", "no YAML"),
        (b"- 1\n", "must be keys with values"),
        (b"variants: 7\n", "must be a list"),
        (b"version: 2\n", "another version"),
        (b"robots: []\n", 'unknown key "robots"'),
        (b"variants:\n  - note: x\n", "line 2 is a variant without a name"),
        (b"variants:\n  - name: ' '\n", "line 2 is no name"),
        (b"variants:\n  - name: [x]\n", "must be one text"),
        (b"variants:\n  - name: a\n  - name: a\n", 'has "a" twice'),
        (b"variants:\n  - name: a\n    name: b\n", 'has "name" twice'),
        (b"variants:\n  - name: a\n    values: [{file: x, text: y}]\n", "one of argument"),
        (
            b"variants:\n  - {name: a, values: [{file: x, key: k, property: p, text: y}]}\n",
            "one of",
        ),
        (
            b"variants:\n  - {name: a, values: [{file: x, key: k, number: -1, text: y}]}\n",
            "no number from 1 on",
        ),
        (b"variants:\n  - name: " + b"x" * 101, "line 2 is no name of up to 100 letters"),
        (
            b"variants:\n" + b"".join(b"  - name: %d\n" % n for n in range(VARIANT_LIMIT + 1)),
            "more",
        ),
        (b"#" * (SIZE_LIMIT_BYTES + 1), "larger than 1 MB"),
    ],
)
def test_what_no_variant_says_is_refused_with_its_line(data: bytes, words: str):
    with pytest.raises(VariantsFileError) as refused:
        read_variants(PATH, data)
    assert words in str(refused.value)
    assert str(refused.value).startswith(f"The variants in {PATH} cannot be used: ")


def test_a_file_that_cannot_be_read_is_not_overwritten():
    with pytest.raises(VariantsFileError):
        write(b"variants: 7\n", BIG)


def test_more_than_a_file_may_hold_is_refused():
    large = [Variant(str(n), "x" * 2000, {"a": "y" * 100_000}) for n in range(12)]
    with pytest.raises(VariantsFileError, match="too many for one file"):
        write(b"", *large)


@pytest.mark.parametrize(
    "bad",
    [
        Variant("Long", arguments={"a" * 1500: "1"}),
        Variant("Long", arguments={"": "1", "\0" * 2000: "2"}),
        Variant("Long", note="x" * 3000),
        Variant("Long" * 30),
        Variant("Long", texts={TextName("f" * 5000, SiteKind.PROPERTY, "p"): "1"}),
    ],
)
@pytest.mark.parametrize("before", [b"", BY_HAND])
def test_what_could_not_be_read_again_is_not_written(before: bytes, bad: Variant):
    with pytest.raises(VariantsFileError, match=r'"Long.* has a name or a text that a file'):
        write(before, BIG, bad, SMALL)


def test_two_variants_of_one_name_are_not_written():
    with pytest.raises(VariantsFileError, match="cannot hold these variants together"):
        write(b"", SMALL, SMALL)

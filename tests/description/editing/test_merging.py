"""Two sides' changes of one text put together: laws on any texts, cases on those of robots."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from studio.description.editing.merging import hunks_between, merge, patched

BASE = b"""<robot>\r
  <!-- R\xc3\xa4der -->\r
  <xacro:property name="radius" value="0.1"/>\r
  <xacro:property name="width" value="0.05"/>\r
  <limit lower="-1" upper="1"/>\r
</robot>\r
"""
TEXTS = st.lists(
    st.sampled_from([b"a=1\n", b"b='2'\n", b"c\r\n", b"\n", b"0.1 0.2\n", b"<d/>", b"\xff\n"]),
    max_size=12,
).map(b"".join)


@st.composite
def edits_apart(draw: st.DrawFn) -> tuple[bytes, bytes, bytes, bytes]:
    """A base of numbered lines, two sides that change other lines of it, and both together."""
    count = draw(st.integers(2, 12))
    lines = [b"line %d\n" % number for number in range(count)]
    owners = draw(st.lists(st.sampled_from("mt-"), min_size=count, max_size=count))
    word = st.sampled_from([b"x", b"0.5", b"longer text", b"\xc3\xa4"])
    texts = [b"line %d %s\n" % (number, draw(word)) for number in range(count)]

    def made(sides: str) -> bytes:
        chosen = zip(lines, texts, owners, strict=True)
        return b"".join(new if owner in sides else old for old, new, owner in chosen)

    return b"".join(lines), made("m"), made("t"), made("mt")


@given(TEXTS, TEXTS)
def test_the_hunks_between_two_texts_lead_from_one_to_the_other(old: bytes, new: bytes):
    assert patched(old, hunks_between(old, new)) == new


@given(TEXTS, TEXTS)
def test_it_is_theirs_where_i_did_nothing_and_mine_where_they_did_nothing(base: bytes, one: bytes):
    assert merge(base, base, one).text() == one
    assert merge(base, one, base).text() == one
    assert merge(base, base, one).collisions == merge(base, one, base).collisions == ()


@given(TEXTS, TEXTS)
def test_a_change_that_both_made_is_made_once(base: bytes, both: bytes):
    assert merge(base, both, both).text() == both
    assert (merge(base, both, both).collisions, merge(base, both, both).kept) == ((), 0)


@given(edits_apart())
def test_changes_of_other_lines_are_both_kept(texts: tuple[bytes, bytes, bytes, bytes]):
    base, mine, theirs, both = texts
    merged = merge(base, mine, theirs)
    assert merged.collisions == ()
    assert merged.text("mine") == merged.text("theirs") == both


@given(TEXTS, TEXTS, TEXTS)
def test_who_changes_sides_changes_the_winner_only(base: bytes, mine: bytes, theirs: bytes):
    assert merge(base, mine, theirs).text("mine") == merge(base, theirs, mine).text("theirs")


def test_two_words_of_one_line_are_both_kept():
    mine = BASE.replace(b'"-1"', b'"-2"')
    theirs = BASE.replace(b'upper="1"', b'upper="1.5"')
    merged = merge(BASE, mine, theirs)
    assert merged.text() == mine.replace(b'upper="1"', b'upper="1.5"')
    assert (merged.kept, merged.collisions) == (1, ())


def test_two_changes_of_one_number_collide_and_the_winner_is_chosen():
    mine, theirs = BASE.replace(b'"0.1"', b'"0.125"'), BASE.replace(b'"0.1"', b'"0.2"')
    theirs = theirs.replace(b"0.05", b"0.07")
    merged = merge(BASE, mine, theirs)
    (place,) = merged.collisions
    assert (BASE[place.start : place.end], place.mine, place.theirs) == (b"0.1", b"0.125", b"0.2")
    assert merged.text("theirs") == theirs
    assert merged.text("mine") == mine.replace(b"0.05", b"0.07")


def test_a_line_that_they_took_out_collides_with_its_edit():
    mine = BASE.replace(b'"0.1"', b'"0.125"')
    theirs = BASE.replace(b'  <xacro:property name="radius" value="0.1"/>\r\n', b"")
    assert len(merge(BASE, mine, theirs).collisions) == 1


def test_lines_put_in_above_an_edit_leave_it():
    mine = BASE.replace(b'"0.05"', b'"0.06"')
    theirs = BASE.replace(
        b"<robot>\r\n", b"<robot>\r\n  <link name='a'/>\r\n  <link name='b'/>\r\n"
    )
    merged = merge(BASE, mine, theirs)
    assert merged.text() == theirs.replace(b'"0.05"', b'"0.06"')


def test_other_line_ends_all_over_the_file_collide_with_no_edit():
    mine = BASE.replace(b'"0.1"', b'"0.125"')
    merged = merge(BASE, mine, BASE.replace(b"\r\n", b"\n"))
    assert merged.text() == mine.replace(b"\r\n", b"\n")
    assert merged.collisions == ()


def test_a_text_of_very_many_other_lines_is_one_change():
    base, theirs = b"a\n" * 9000, b"b\n" * 9000
    assert len(hunks_between(base, theirs)) == 1
    assert merge(base, base, theirs).text() == theirs

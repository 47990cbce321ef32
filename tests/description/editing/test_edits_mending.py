from __future__ import annotations

import pytest

from studio.description.editing.edits import apart, apply, edits_of
from studio.errors import StaleTextError
from studio.problems import Replacement

TEXT = "<robot>\n  <link nane='größe'/>\n</robot>"
DATA = TEXT.encode()


def replacement(before: str, text: str, data: bytes = DATA) -> Replacement:
    """The first place that says `before` becomes `text`."""
    start = data.index(before.encode())
    return Replacement("a.urdf", start, start + len(before.encode()), before, text)


def mended(*replacements: Replacement, data: bytes = DATA) -> str:
    return apply(data, edits_of(replacements, {"a.urdf": data}.__getitem__)).decode()


def test_several_places_of_a_text_change_at_once():
    first, second = replacement("nane", "name"), replacement("</robot>", "</robot>\n")
    assert mended(first, second) == TEXT.replace("nane", "name") + "\n"
    assert mended(second, first) == mended(first, second)


def test_only_what_changes_is_edited_not_what_marks_the_place():
    (edit,) = edits_of([replacement("/>\n</robot>", "/>\n  <b/>\n</robot>")], lambda _: DATA)
    assert edit.end == edit.start
    assert edit.new.strip() == b"<b/>"


def test_what_is_put_in_at_one_place_comes_in_the_order_of_the_fixes():
    ends = replacement("</robot>", "</robot><!--1-->"), replacement("</robot>", "</robot><!--2-->")
    assert mended(*ends).endswith("</robot><!--1--><!--2-->")


def test_a_place_that_says_something_else_by_now_is_refused():
    with pytest.raises(StaleTextError, match=r"a\.urdf"):
        edits_of([replacement("größe", "mass")], lambda _: DATA.replace(b"<robot>", b"<robot >"))


def test_a_replacement_that_names_no_place_is_refused():
    with pytest.raises(StaleTextError):
        edits_of([Replacement("a.urdf", 3, 3, "", "x")], lambda _: DATA)


def test_two_that_change_the_same_bytes_are_refused_together():
    with pytest.raises(StaleTextError):
        mended(replacement("größe", "mass"), replacement("öß", "os"))


def test_of_fixes_that_collide_the_first_is_kept_whole():
    first, second = replacement("größe", "mass"), replacement("öß", "os")
    third = replacement("nane", "name")
    assert apart([[first], [second, third]]) == [first]
    assert apart([[second, third], [first]]) == [second, third]


def test_fixes_that_only_repeat_the_same_text_beside_them_are_all_kept():
    ends = replacement("</robot>", "</robot>\n"), replacement("</robot>", "<b/></robot>")
    assert apart([[one] for one in ends]) == list(ends)
    assert mended(*ends) == TEXT.replace("</robot>", "<b/></robot>\n")


def test_what_the_encoding_of_a_file_lacks_is_written_as_a_reference():
    data = b'<?xml version="1.0" encoding="latin-1"?><a b="gr\xf6\xdfe"/>'
    start = data.index(b"gr")
    one = Replacement("a.urdf", start, start + 5, "größe", "größe 🤖")
    (edit,) = edits_of([one], lambda _: data)
    assert edit.new == b" &#129302;"

"""The studio's own small files: one list of named items, each fault with its line."""

from __future__ import annotations

from typing import Final

import pytest

from studio.description.syntax.named_list import ListKind, NamedList, lines_of
from studio.errors import PosesFileError

KIND: Final = ListKind("pose", PosesFileError, item_limit=2, entry_limit=3, depth_limit=4)


def look(text: str) -> NamedList:
    return NamedList("/robot/arm.poses.yaml", text.encode(), KIND)


def test_the_items_and_their_lines_are_found():
    listed = look("# mine\nposes:\n  - name: Home\n    at:\n    - 1\n  # of Up\n  - name: Up\n")
    items = listed.items()
    assert [listed.name(item) for item in items] == ["Home", "Up"]
    assert [lines_of(item) for item in items] == [(2, 5), (6, 7)]


@pytest.mark.parametrize("text", ["", "poses:", "version: 1", "# nothing"])
def test_an_empty_file_has_no_items(text: str):
    assert look(text).items() == ()


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("poses: [{name: a}, {name: b}, {name: c}]", "holds more than 2 poses"),
        ("poses: [{name: a, b: 1, c: 2, d: 3}]", "must be keys with values"),
        ("poses: [{name: [[[[]]]]}]", "nested too deeply"),
        ("poses:\n- {}", "line 2 is a pose without a name"),
        ("poses:\n- name: " + "x" * 101, "line 2 is no name of up to 100 letters"),
        ("poses:\n- name: [x]", "line 2 must be one text"),
        ("poses:\n- ? " + "x" * 5000 + "\n  : 1", "is longer than 4,096 characters"),
        ("poses: [{name: a}, {name: ' a'}]", 'has "a" twice'),
        ("poses: [&a {name: a}, *a]", "an anchor, alias or tag, which no pose needs"),
    ],
)
def test_what_is_no_such_list_is_told_with_its_line(text: str, reason: str):
    with pytest.raises(PosesFileError, match=reason):
        look(text).items()

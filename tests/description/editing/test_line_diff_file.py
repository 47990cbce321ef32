"""What saving would change: counted, numbered, and cut where it is too much to read."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from studio.description.editing.line_diff import LINES_SHOWN, DiffLine, file_diff

TEN = "".join(f"line {number}\n" for number in range(1, 11))


def test_a_changed_line_is_shown_with_three_lines_around_it():
    diff = file_diff(TEN.encode(), TEN.replace("line 5", "LINE 5").encode())
    assert (diff.added, diff.removed, diff.left_out) == (1, 1, 0)
    (hunk,) = diff.hunks
    assert [line.before for line in hunk] == [2, 3, 4, 5, None, 6, 7, 8]
    assert hunk[3:5] == (DiffLine("old", 5, None, "line 5"), DiffLine("new", None, 5, "LINE 5"))


def test_changes_far_from_each_other_are_hunks_of_their_own_with_true_numbers():
    before = "".join(f"line {number}\n" for number in range(1, 41))
    after = before.replace("line 3\n", "").replace("line 30\n", "a\nb\n")
    first, second = file_diff(before.encode(), after.encode()).hunks
    assert first[2] == DiffLine("old", 3, None, "line 3")
    assert second[3:6] == (
        DiffLine("old", 30, None, "line 30"),
        DiffLine("new", None, 29, "a"),
        DiffLine("new", None, 30, "b"),
    )


def test_equal_texts_have_no_hunks():
    assert file_diff(b"x\n", b"x\n").hunks == ()


def test_of_a_file_that_is_all_new_only_so_many_lines_are_shown():
    diff = file_diff(b"", b"x\n" * (LINES_SHOWN + 500))
    assert (diff.added, diff.left_out) == (LINES_SHOWN + 500, 500)
    assert sum(map(len, diff.hunks)) == LINES_SHOWN


def test_the_encoding_and_the_line_breaks_of_the_file_are_its_own():
    before = "<!-- é -->\r\n<a/>\r\n"
    diff = file_diff(b"\xef\xbb\xbf" + before.encode(), b"\xef\xbb\xbf" + before.encode() + b"b")
    assert diff.hunks[0][0].text == "<!-- é -->"


LINES = st.lists(st.sampled_from(["a", "b", "c", "d"]), max_size=30)


@given(LINES, LINES)
def test_the_lines_of_the_hunks_lead_from_the_one_text_to_the_other(old: list[str], new: list[str]):
    diff = file_diff("".join(f"{one}\n" for one in old).encode(), "\n".join(new).encode())
    made, at = list[str](), 0
    for line in (line for hunk in diff.hunks for line in hunk):
        if line.before is not None:
            made += old[at : line.before - 1]
            at = line.before
        if line.kind != "old":
            made.append(line.text)
            assert line.after == len(made)
    assert made + old[at:] == new

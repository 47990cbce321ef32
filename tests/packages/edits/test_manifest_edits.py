from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.packages.edits.manifest_edits import added
from studio.packages.sources.package_xml import DEPENDENCY_TAGS, PackageXml
from studio.packages.sources.spans import with_replacements

ROWS = st.lists(
    st.tuples(st.sampled_from(DEPENDENCY_TAGS), st.from_regex(r"[a-z]{2,8}", fullmatch=True)),
    max_size=6,
)
LAYOUTS = st.sampled_from(["  {}\n", "\t{}\n", "{}", "  <!-- ü > -->\n    {}\n"])


@given(ROWS, LAYOUTS, st.sampled_from([*DEPENDENCY_TAGS, "member_of_group"]), st.booleans())
def test_an_element_is_added_once_and_all_else_stays(
    rows: list[tuple[str, str]],
    layout: str,
    tag: str,
    exports: bool,
):
    inner = "".join(layout.format(f"<{kind}>{name}</{kind}>") for kind, name in rows)
    export = (
        "  <export>\n    <build_type>ament_cmake</build_type>\n  </export>\n" if exports else ""
    )
    head = "<?xml version='1.0'?>\n<package format='3'>\n  <name>p</name>\n"
    text = f"{head}{inner}\n{export}</package>\n"
    before = PackageXml("package.xml", text.encode())
    changes = added(before, tag, "new_one")
    made = with_replacements(text.encode(), changes)
    after = PackageXml("package.xml", made)
    assert not after.fault
    left = [(one.tag, one.text) for one in after.elements if one.text != "new_one"]
    # `package` and `export` have no text of their own that would change.
    assert left == [(one.tag, one.text) for one in before.elements]
    assert [one.tag for one in after.elements if one.text == "new_one"] == [tag]
    (one,) = changes
    kept = (
        made.decode().replace(one.text.removeprefix(one.before), "", 1)
        if one.text.startswith(one.before)
        else text
    )
    assert len(kept.encode()) == len(text.encode())
    assert added(after, tag, "new_one") == ()


@pytest.mark.parametrize("text", ["", "<package>", "<package><name>p</name>", "no xml"])
def test_a_broken_file_is_left_alone(text: str):
    with pytest.raises(ValueError, match=r"package\.xml"):
        added(PackageXml("package.xml", text.encode()), "depend", "rclpy")


def test_depend_says_what_exec_depend_would_say():
    text = b"<package><name>p</name><depend>rclpy</depend></package>"
    assert added(PackageXml("package.xml", text), "exec_depend", "rclpy") == ()

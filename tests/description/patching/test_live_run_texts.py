from __future__ import annotations

from typing import TYPE_CHECKING

from studio.description.evaluator.source_store import SourceStore
from studio.description.patching.live_run import TextEdits
from studio.description.sites.file_sites import xml_sites
from studio.description.syntax.source_tree import SourceTree, parse_source
from studio.description.values import Edit
from studio.packages.roots import ServedRoots

if TYPE_CHECKING:
    from pathlib import Path

TEXT = b"""<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="a" value="1"/><!-- of a --><xacro:property name="b" value="2"/>
  <link name="l"><inertial><mass value="3"/></inertial></link>
</robot>
"""


def places(tree: SourceTree) -> list[tuple[str, int, int, int, int, int]]:
    return [
        (one.tag, one.place.line, one.place.column, one.offset, one.inside, one.end)
        for one in tree.elements
    ]


def test_every_element_stands_where_the_edited_text_has_it(tmp_path: Path):
    file = tmp_path / "a.xacro"
    file.write_bytes(TEXT)
    store = SourceStore(ServedRoots([tmp_path]), {})
    tree = store.tree(str(file))
    edits = TextEdits(store, {tree.path: xml_sites(tree)})
    for old, new in ((b'value="1"', b"10.25"), (b'value="3"', b"33"), (b'value="10.25"', b"4")):
        start = tree.data.index(old) + len(b'value="')
        edit = Edit(tree.path, start, start + len(old) - len(b'value=""'), new)
        edits.take(edit, ())
        assert places(tree) == places(parse_source(tree.path, tree.data))
        assert [one.offset for one in tree.comments] == [tree.data.index(b"<!-- of a")]

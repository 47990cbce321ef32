from __future__ import annotations

from urllib.parse import unquote

from hypothesis import given
from hypothesis import strategies as st

from studio.scene.graph import ghost_node, link_node


@given(st.text(st.characters(exclude_categories=["Cs"]), min_size=1))
def test_a_node_is_one_step_below_its_robot_and_names_its_link(link: str):
    for node, root in ((link_node(link), "robot"), (ghost_node(link), "ghost")):
        empty, above, name = node.split("/")
        assert (empty, above, unquote(name)) == ("", root, link)

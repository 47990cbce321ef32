from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from studio.scene.naming import link_node, link_of


@given(st.text(st.characters(exclude_categories=["Cs"]), min_size=1))
def test_the_link_is_found_again_from_its_node_and_from_all_below_it(link: str):
    assert link_of(link_node(link)) == link
    assert link_of(f"{link_node(link)}/visual/0") == link


def test_nodes_of_others_belong_to_no_link():
    assert link_of("/grid") is None
    assert link_of("/robot") is None

"""The comments that come out are those of stock xacro, on cases, generated files and real ones."""

from __future__ import annotations

import tempfile
from pathlib import Path

import pytest
from hypothesis import given, settings

from studio.description.faults import Fault
from tests.support.commented import Commented, commented_run, commented_xml
from tests.support.descriptions import (
    canonical,
    canonical_xml,
    expand,
    policy_for,
    robot,
    stock_text,
    write,
)
from tests.support.generated_xacro import files
from tests.support.stock_command import StockCommand

COMMENTS_AT_LEAST = 1_000
"""Of the 1,661 that stock xacro leaves in the corpus."""
MACRO = '<xacro:macro name="m" params="*b"><!-- in --><u><xacro:insert_block name="b"/></u>'
CASES = {
    "before an element they stay": "<!-- one -->\n<!-- two --><x/>",
    "before a tag of xacro they go": (
        '<!-- a --><!-- b -->\n<xacro:property name="a" value="1"/><x/>'
    ),
    "an empty line keeps them": '<!-- a -->\n\n<xacro:property name="a" value="1"/><x/>',
    "a text keeps them": '<!-- a -->text<xacro:arg name="a" default="1"/><x/>',
    "each run of tags drops its own": (
        '<x/><!-- a --><xacro:arg name="a" default="1"/>\n'
        '<!-- b --><xacro:arg name="b" default=""/>'
    ),
    "what a condition leaves is safe from the next tag": (
        '<xacro:if value="1"><x/><!-- last --></xacro:if><xacro:arg name="a" default="1"/>'
    ),
    "unless a tag inside the condition took the barrier": (
        '<xacro:if value="1"><xacro:arg name="b" default="1"/><x/><!-- last --></xacro:if>'
        '<xacro:arg name="a" default="1"/>'
    ),
    "of a macro's body": f"{MACRO}<!-- end --></xacro:macro><!-- a --><xacro:m><y/></xacro:m><z/>",
    "inside a block": f"{MACRO}</xacro:macro><xacro:m><y><!-- b --><w/></y><!-- c --></xacro:m>",
    "behind a tag inside a block": (
        f'{MACRO}</xacro:macro><xacro:m><y><xacro:arg name="q" default="1"/><!-- b -->'
        '<xacro:arg name="r" default="1"/></y></xacro:m>'
    ),
    "before insert_block they stay": (
        '<xacro:property name="p"><y/><!-- b --></xacro:property><!-- a -->'
        '<xacro:insert_block name="p"/>'
    ),
    "before a cdata section's end": '<!-- a --><![CDATA[ ]]><xacro:arg name="a" default="1"/>',
    "evaluated when asked": (
        '<xacro:property name="a" value="1"/><!-- xacro:eval-comments --><!-- ${a} -->\n'
        "<!-- ${a+1} --><x/><!-- ${a} -->"
    ),
    "evaluated until told otherwise": (
        "<!-- xacro:eval-comments:on --><!-- ${1+1} -->"
        "<!-- xacro:eval-comments:off --><!-- ${2} -->"
    ),
    "a text ends their evaluation": "<!-- xacro:eval-comments --> text <!-- ${1} -->",
    "of a file that is included": '<!-- a --><xacro:include filename="b.xacro"/><!-- b --><x/>',
}


@pytest.mark.parametrize("case", CASES)
def test_comments_come_out_where_xacro_leaves_them(case: str, tmp_path: Path):
    included = robot("<!-- first --><y/><!-- last -->", "")
    file = write(tmp_path, {"a.xacro": robot(CASES[case]), "b.xacro": included})
    text = stock_text(file)
    assert text is not None, "stock xacro cannot expand the case"
    assert commented_run(str(file), policy_for(tmp_path)) == commented_xml(text)


@settings(max_examples=300, deadline=None)
@given(files())
def test_whatever_is_written_expands_as_xacro_expands_it(written: dict[str, str]):
    """With and without comments; and where xacro fails, we do, too."""
    with tempfile.TemporaryDirectory() as folder:
        file = write(Path(folder), written)
        expected = stock_text(file)
        try:
            ours = canonical(expand(file)), commented_run(str(file), policy_for(file.parent))
        except Fault:
            ours = None
    assert ours == (expected and (canonical_xml(expected), commented_xml(expected)))


@pytest.mark.corpus
def test_every_comment_of_the_corpus_comes_out_as_from_stock(
    corpus: Path, tmp_path_factory: pytest.TempPathFactory
):
    policy = policy_for(corpus)
    found = [path for path in sorted(corpus.rglob("*.xacro")) if path.is_file()]
    command = StockCommand(tmp_path_factory.mktemp("stock"), policy.packages)
    texts = command.batch([str(path) for path in found])
    different: list[str] = []
    comments = 0
    for file, text in texts.items():
        if text is None:
            continue
        expected = commented_xml(text)
        comments += _comments_of(expected)
        if commented_run(file, policy) != expected:
            different.append(file)
    assert not different
    assert comments > COMMENTS_AT_LEAST


def _comments_of(tree: Commented) -> int:
    return sum(
        child.startswith("<!--") if isinstance(child, str) else _comments_of(child)
        for child in tree[2]
    )

"""Demo nodes beside the course's listings: where one is whole, only imports and main differ."""

from __future__ import annotations

import ast
import re
import textwrap
from pathlib import Path

import pytest

from studio.course.demos import DEMOS
from tests.support.course_listings import course_folder, seed_lines

REPOSITORY = Path(__file__).resolve().parents[2]
LINES_AT_MOST = 80
LONGER = {"basic_controls.py": 160}
"""One marker of every mode, as the tutorial has them, cannot be shown in less."""

# The page, the class, and the demo that holds it; S3 and S2 keep their indentation.
WHOLE = [
    ("003", "class PublisherNode", "talker"),
    ("003", "class SubscriberNode", "listener"),
    ("003", "class adderClient", "adder_client"),
    ("003", "class adderServer", "adder_server"),
    ("003", "class StatePublisher", "state_publisher"),
    (
        "002",
        "class MyFirstNode(Node):\n    def __init__(self):\n        super().__init__('my_node",
        "my_first_node",
    ),
    (
        "002",
        'class MyFirstNode(Node):\n    def __init__(self):\n        super().__init__("my_tiny',
        "my_tiny_node",
    ),
    ("002", "class FirstPub", "number_publisher"),
    ("002", "class FirstSub", "number_counter"),
]
# S4 lost its indentation: its lines are compared without.
FLAT = [
    ("class BasicNode", "basic_node"),
    (
        "class PublisherNode(Node):\ndef __init__(self):\nsuper().__init__('publisher_node')",
        "publisher_node",
    ),
    (
        "class SubscriberNode(Node):\ndef __init__(self):\nsuper().__init__('subscriber_node')",
        "subscriber_node",
    ),
    (
        "class ServiceServerNode(Node):\n"
        "def __init__(self):\nsuper().__init__('service_server_node')",
        "service_server_node",
    ),
    (
        "class ServiceClientNode(Node):\n"
        "def __init__(self):\nsuper().__init__('service_client_node')",
        "service_client_node",
    ),
    ("class TimerNode", "timer_node"),
]


class Plain(ast.NodeTransformer):
    """Leaves out what a listing may lack: docstrings, annotations, names on a line of their own."""

    def visit_FunctionDef(self, node: ast.FunctionDef) -> ast.AST:
        self.generic_visit(node)
        node.returns = None
        for argument in (*node.args.args, *node.args.kwonlyargs):
            argument.annotation = None
        node.body = [line for line in node.body if not said_only(line)]
        return node

    def visit_ClassDef(self, node: ast.ClassDef) -> ast.AST:
        self.generic_visit(node)
        node.body = [line for line in node.body if not said_only(line)]
        return node

    def visit_AnnAssign(self, node: ast.AnnAssign) -> ast.AST:
        return ast.Assign([node.target], node.value or ast.Constant(None), lineno=node.lineno)

    def visit_Constant(self, node: ast.Constant) -> ast.AST:
        """`0.` is `0.0`; both are the same number."""
        return ast.Constant(node.value)


def said_only(line: ast.stmt) -> bool:
    return isinstance(line, ast.Expr) and isinstance(line.value, ast.Constant | ast.Attribute)


def plain_class(text: str) -> str:
    """The first class of a text, as Python would write it without what may be left out."""
    tree = Plain().visit(ast.parse(text))
    found = next(node for node in tree.body if isinstance(node, ast.ClassDef))
    return ast.unparse(ast.fix_missing_locations(found))


def text_of(page: str) -> str:
    """A page of the course; skips the test where STUDIO_COURSE names no folder of them."""
    if course_folder() is None:
        pytest.skip("STUDIO_COURSE names no folder of the course's texts")
    return "\n".join(seed_lines(page)) + "\n"


def listing(page: str, start: str) -> str:
    """A class of a page, as far as its indentation goes."""
    text = text_of(page)
    lines = text[text.index(start) :].splitlines()
    end = next(
        i for i, line in enumerate(lines[1:], 1) if line and not line.startswith((" ", "\t"))
    )
    return textwrap.dedent("\n".join(lines[:end]))


def source_of(demo: str) -> str:
    return (REPOSITORY / "studio" / "course" / f"{demo}.py").read_text()


@pytest.mark.corpus
@pytest.mark.parametrize(("page", "start", "demo"), WHOLE, ids=[demo for *_, demo in WHOLE])
def test_a_demo_is_the_courses_listing_apart_from_imports_and_main(
    page: str, start: str, demo: str
):
    assert plain_class(source_of(demo)) == plain_class(listing(page, start))


@pytest.mark.corpus
@pytest.mark.parametrize(("start", "demo"), FLAT, ids=[demo for _, demo in FLAT])
def test_a_demo_has_the_lines_of_a_listing_that_lost_its_indentation(start: str, demo: str):
    text = text_of("004")
    printed = text[text.index(start) :].partition("def main(")[0]
    assert flat(plain_class(source_of(demo))) == flat(printed)


def flat(text: str) -> str:
    """Code without blanks, comments, and the style of its quotes."""
    lines = (re.sub(r"#.*", "", line).strip() for line in text.splitlines())
    kept = "".join(line for line in lines if line and not re.fullmatch(r"self\.\w+", line))
    code = re.sub(r"\s", "", kept).replace('"', "'").replace("\\'", "'")
    return code.replace(",)", ")")


@pytest.mark.parametrize("name", [demo.name for demo in DEMOS])
def test_a_demo_is_short_enough_to_stand_beside_its_listing(name: str):
    """Blank lines and docstrings are not counted."""
    folder = REPOSITORY / "studio" / "course"
    paths = (
        [folder / f"{name}.py"]
        if (folder / f"{name}.py").exists()
        else (folder / name).glob("*.py")
    )
    for path in paths:
        if path.name == "room.py":
            continue  # what stands behind a node, not one
        tree = ast.parse(path.read_text())
        text = ast.unparse(Plain().visit(tree))
        most = LONGER.get(path.name, LINES_AT_MOST)
        assert len([line for line in text.splitlines() if line.strip()]) < most, path.name

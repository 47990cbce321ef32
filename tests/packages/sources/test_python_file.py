from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.packages.lint.package_checks import check_packages
from studio.packages.sources.python_file import PythonFile
from studio.packages.sources.setup_py import SetupPy


@pytest.mark.parametrize(
    "text",
    [
        "x = " + "(" * 5000,
        "x = " + "1+" * 20_000 + "1",
        "a" + ".b" * 20_000,
        "\0",
        "x = '\ud800'",
        "def (",
        "-" * 100_000 + "1",
    ],
)
def test_whatever_python_cannot_read_is_a_fault_and_never_raised(text: str):
    data = text.encode("utf-8", "surrogatepass")
    python = PythonFile("a.py", data)
    assert python.tree is None or python.fault == ""
    assert isinstance(python.top_level_names, frozenset)
    assert SetupPy("setup.py", data).scripts == ()
    assert callable(check_packages)


@given(st.text(max_size=80))
def test_any_text_is_read(text: str):
    python = PythonFile("a.py", text.encode("utf-8", "replace"))
    assert (python.tree is None) == bool(python.fault)


def test_bytes_are_those_of_the_file_with_a_mark_and_other_letters():
    data = "\ufeffü = 'ä'; b = 2\n".encode()
    python = PythonFile("a.py", data)
    assert python.tree is not None
    last = python.tree.body[-1]
    start, end = python.span(last)
    assert data[start:end] == b"b = 2"


def test_names_of_a_module_are_those_of_its_blocks_too():
    text = (
        "try:\n    import a\nexcept E as e:\n    b = 1\nif x:\n    def c(): d = 1\n[y for y in z]\n"
    )
    assert PythonFile("a.py", text.encode()).top_level_names == {"a", "b", "c", "e"}

from __future__ import annotations

import time

import pytest

from studio.packages.sources.setup_py import SetupPy

TEXT = """\
import os
from glob import glob
from setuptools import setup
name_of_it = 'p'
setup(
    name=name_of_it,
    packages=[name_of_it, 'scripts'],
    data_files=[
        (os.path.join('share', name_of_it, 'launch'), glob(os.path.join('launch', '*.py'))),
        (f'share/{name_of_it}', ['package.xml', 'a' + '.txt']),
        (made(), every()),
    ],
    entry_points={'console_scripts': ['a = p.a:main', 'b=p.b:run']},
)
"""


def test_what_is_written_out_is_read_and_nothing_is_run():
    setup = SetupPy("setup.py", TEXT.encode())
    assert setup.text("name") == "p"
    assert setup.packages == ("p", "scripts")
    assert [(one.destination, one.sources, one.is_whole) for one in setup.data_files] == [
        ("share/p/launch", ("launch/*.py",), True),
        ("share/p", ("package.xml", "a.txt"), True),
        (None, (), False),
    ]
    assert [(one.name, one.place, one.line) for one in setup.scripts] == [
        *(("a", "p.a:main", 13), ("b", "p.b:run", 13)),
    ]
    assert setup.imports("glob", "glob")
    assert not setup.imports("glob")
    first = setup.scripts[0]
    assert TEXT.encode()[first.start : first.end] == b"'a = p.a:main'"


def test_lists_that_have_a_name_or_are_put_together_are_read():
    text = (
        "scripts = ['a = p.a:main']\n"
        "scripts = ['a = p.a:main', 'b = %s.b:main' % 'p']\n"
        "points = {'console_scripts': scripts + ['c = p.c:main']}\n"
        "files = [['share/p', [*rows(), 'package.xml']]]\n"
        "setup(entry_points=points, packages=['p'] + ['q'], data_files=files,\n"
        "package_dir={'': 's'})"
    )
    setup = SetupPy("setup.py", text.encode())
    assert [one.place for one in setup.scripts] == ["p.a:main", "p.b:main", "p.c:main"]
    assert setup.packages == ("p", "q")
    assert setup.package_dir == {"": "s"}
    assert [(one.sources, one.is_whole) for one in setup.data_files] == [(("package.xml",), False)]
    assert setup.computes_data_files


def test_scripts_of_a_dictionary_that_setup_gets_otherwise_are_read():
    setup = SetupPy("setup.py", b"d = {'console_scripts': ['a = p.a:main']}\nsetup(**given(d))")
    assert [one.name for one in setup.scripts] == ["a"]


@pytest.mark.parametrize(
    "text",
    [
        "x = " + "(" * 5_000,
        "x = " + "-" * 50_000 + "1",
        "x = '" + "\0",
        "setup(data_files=[(1, 2, 3), 'x', ('a', 5)])",
        "import os; os.system('touch ran')\nsetup(packages=os.listdir('/'))",
        "setup(" + "+".join(["'a'"] * 2_000) + ")",
        "a = 'aaaaaaaaaa'\n" + "a = a + a\n" * 60 + "setup(packages=[a])",
        "a = ['x']\na = [*a, *a]\nsetup(packages=a, data_files=a, entry_points=a)",
        "a = ['x']\na = a + a\nsetup(packages=a, data_files=[('a', a)], package_dir=a)",
    ],
)
def test_a_hostile_setup_py_is_read_without_harm(text: str):
    before = time.perf_counter()
    setup = SetupPy("setup.py", text.encode())
    assert (setup.scripts, setup.package_dir) == ((), {})
    assert not any(one.sources for one in setup.data_files if one.is_whole)
    assert not setup.packages or len(setup.packages) < 100_000
    assert time.perf_counter() - before < 10

from __future__ import annotations

import ast

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.packages.edits.setup_edits import data_files_added, script_added
from studio.packages.sources.setup_py import SetupPy
from studio.packages.sources.spans import with_replacements

HEAD = "# über\nfrom setuptools import setup\n\npackage_name = 'p'\n"
LISTS = [
    "[]",
    "[\n    ]",
    "['a = p.a:main']",
    "['a = p.a:main',]",
    "['a = p.a:main', 'b = p.b:main']",
    "[\n            'a = p.a:main',\n        ]",
    "[\n            'a = p.a:main'\n        ]",
    "[\n            'a = p.a:main',  # the first, a comma\n"
    "            # 'b = p.b:main',\n        ]",
    "[\n            'a = p.a:main'  # none behind: ü,\n        ]",
    "[\n            ('a = '\n             'p.a:main')\n        ]",
    "[\n\t'a = p.a:main',\n\t'b = p.b:main']",
]
ENTRIES = [
    *(f"entry_points={{'console_scripts': {one}}}," for one in LISTS),
    "entry_points={\n        'console_scripts': [\n            'a = p.a:main',\n        ],\n    },",
    "entry_points={},",
    "entry_points={\n        'other': ['x = y:z'],\n    },",
    "version='1',",
    "version='1'",
]
NAMES = st.from_regex(r"[a-z][a-z0-9_]{0,12}", fullmatch=True)


def setup_of(text: str) -> SetupPy:
    return SetupPy("setup.py", text.encode())


def scripts(text: str) -> list[str]:
    return [one.text for one in setup_of(text).scripts]


@given(st.sampled_from(ENTRIES), NAMES, st.sampled_from(["\n", "\r\n"]), st.booleans())
def test_an_entry_is_added_and_all_else_stays(rest: str, name: str, eol: str, one_line: bool):
    call = (
        f"setup(name=package_name, {rest})\n"
        if one_line
        else f"setup(\n    name=package_name,\n    {rest}\n)\n"
    )
    text = (HEAD + call).replace("\n", eol)
    before = scripts(text)
    entry = f"{name}_n = p.{name}:main"
    changes = script_added(setup_of(text), f"{name}_n", f"p.{name}:main")
    made = with_replacements(text.encode(), changes)
    after = made.decode()
    ast.parse(after)
    assert scripts(after) == [*before, entry]
    # What was there is there, in its order: nothing is taken away.
    assert is_subsequence(text, after)
    if "none behind" not in rest:
        assert len(changes) == 1
    again = script_added(setup_of(after), f"{name}_n", f"p.{name}:main")
    assert again == ()


def is_subsequence(inner: str, outer: str) -> bool:
    letters = iter(outer)
    return all(letter in letters for letter in inner)


@given(
    st.sampled_from(["[]", "[('share', ['a'])]", "[\n        ('share', ['a']),  # ü\n    ]"]),
    st.sampled_from(["", "from glob import glob\n"]),
    st.sampled_from(["\n", "\r\n"]),
)
def test_files_are_installed_and_all_else_stays(rows: str, imports: str, eol: str):
    text = f"'''Doc.'''\n{imports}{HEAD}setup(\n    name=package_name,\n    data_files={rows},\n)\n"
    text = text.replace("\n", eol)
    changes = data_files_added(setup_of(text), [("launch", "*.launch.py"), ("urdf", "*")])
    after = with_replacements(text.encode(), changes).decode()
    setup = setup_of(after)
    assert setup.imports("glob", "glob")
    assert after.count("from glob import glob") == 1
    added = [(one.destination, one.sources) for one in setup.data_files][-2:]
    assert added == [("share/p/launch", ("launch/*.launch.py",)), ("share/p/urdf", ("urdf/*",))]
    assert is_subsequence(text, after)
    assert data_files_added(setup, [("launch", "*.launch.py")]) == ()


@pytest.mark.parametrize(
    "text",
    [
        "from setuptools import setup\nsetup(\n",
        "print(1)\n",
        "",
        "from setuptools import setup\nsetup(name='p', entry_points=made())\n",
        "from setuptools import setup\nsetup(name='p', entry_points={'console_scripts': made()})\n",
        "from setuptools import setup\nsetup()\n",
    ],
)
def test_what_is_broken_or_computed_is_left_alone(text: str):
    with pytest.raises(ValueError, match=r"setup\.py"):
        script_added(setup_of(text), "a", "p.a:main")


def test_glob_is_called_as_the_file_imports_it():
    text = "import glob\nfrom setuptools import setup\nsetup(name='p', data_files=[])\n"
    made = with_replacements(text.encode(), data_files_added(setup_of(text), [("launch", "*")]))
    assert b"('share/p/launch', glob.glob('launch/*'))" in made
    assert made.count(b"import glob") == 1

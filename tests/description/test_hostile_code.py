"""Files that want to run code or read what is not theirs: refused for good, no fallback tried.

In a real worker process, the next robot after each; and through stock xacro behind our guard.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.description.evaluator import stock_xacro
from studio.description.evaluator.stock_xacro import export_urdf
from studio.description.expressions.bounds import Limits
from studio.description.session import open_session
from studio.description.values import Expansion, Failure, OpenRequest
from studio.errors import ExpansionError
from tests.support.descriptions import policy_for, robot, write
from tests.support.hostile import (
    HostileStudio,
    expression,
    hostile_studio,
    loaded,
    properties,
    stopped,
)

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


SECRET = "the-launch-code"
WALK = (
    "[c for c in ().__class__.__base__.__subclasses__() if c.__name__ == '_wrap_close'][0]"
    ".__init__.__globals__['system']('touch MARKER')"
)
SHOW = '<x v="$(eval ${p})"/>'


def hidden(text: str) -> dict[str, str]:
    """`$(eval)` of a text that a property hides from xacro's lexer."""
    return {"a.xacro": robot(properties(p=text) + SHOW)}


CODE: dict[str, dict[str, str]] = {
    **{
        name: {"a.xacro": expression(text)}
        for name, text in {
            "a walk": WALK,
            "a lambda in a comprehension": f"[(lambda: {WALK})() for i in [1]]",
            "a comprehension in a comprehension": f"[[{WALK} for j in [1]] for i in [1]]",
            "a generator": f"list({WALK} for i in [1])",
            "a walk behind a condition": f"{WALK} if True else 0",
            "a walk as a key": f"sorted([1], key=lambda i: {WALK})",
            "a walk by index": "''['__class__']",
            "the methods of a type": "python.type('').__mro__",
            "the type of types": "python.type(python.type(1))('T', (), dict(a=1))",
            "a class of a name": "python.type(int)('T', (python.list,), dict())",
            "a function's globals": "xacro.load_yaml.__globals__",
            "a function's module": "math.sin.__self__",
            "a module of a namespace": "math.__loader__",
            "names with one underscore": "xacro._global_symbols",
            "a bound method's function": "''.join.im_func",
            "a generator's code": "(i for i in [1]).gi_code",
            "a format that walks": "'{0.__class__.__base__}'.format(1)",
            "a format of an index": "'{0[0].__class__}'.format([1])",
            "a format that holds a format": "'{0:{1}}'.format(1, 9)",
            "format_map": "'{a}'.format_map(dict(a=1))",
            "format by the type": "python.type('').format('{0.__class__}', 1)",
            "a method by map": "list(map(python.type('').format, ['{0.__class__}'], [1]))",
            "getattr": "getattr('', 'join')",
            "exec": "exec('import os')",
            "compile": "compile('1', '', 'eval')",
            "open": "open('OUTSIDE/secret.yaml').read()",
            "import": "__import__('os')",
            "the builtins": "__builtins__",
            "our own helpers": "__made(1)",
            "our own helpers by attribute": "xacro.__attribute",
            "globals": "globals()",
            "vars of a namespace": "python.vars(math)",
            "a starred walk": f"max(*[{WALK}])",
            "a walk by keyword": f"dict(a={WALK})",
            "a walk in a slice": f"[1][0:{WALK}]",
            "yield": "(yield 1)",
            "await": "(await x)",
            "an assignment in a comprehension": "[y := i for i in [1]]",
            "a changed namespace": "math.update(pi=3)",
            "a namespace emptied": "python.clear()",
        }.items()
    },
    **{
        f"$(eval) {name}": hidden(text)
        for name, text in {
            "exec": "exec(&quot;import os; os.system('touch MARKER')&quot;, dict())",
            "an f-string": "f'{open(1)}'",
            "a lambda": "(lambda: 1)()",
            "breakpoint": "breakpoint()",
            "input": "input()",
            "a walk": "().__class__",
            "a generator's frame": "[i for i in [1]].gi_frame",
            "open": "open('OUTSIDE/secret.yaml').read()",
        }.items()
    },
    **{
        f"yaml {name}": loaded(text)
        for name, text in {
            "python/object": "k: !!python/object/apply:os.system ['touch MARKER']\n",
            "python/object/new": "k: !!python/object/new:os.system ['touch MARKER']\n",
            "python/name": "k: !!python/name:os.system\n",
            "python/module": "k: !!python/module:os\n",
            "a tag of a walk": f'k: !radians "{WALK}"\n',
            "a tag of a lambda": f'k: !inches "(lambda: {WALK})()"\n',
            "a tag of a file": "k: !meters \"open('OUTSIDE/secret.yaml').read()\"\n",
            "a tag of load_yaml": "k: !degrees \"xacro.load_yaml('OUTSIDE/secret.yaml')\"\n",
            "a merge of a tag": f'<<: !radians "{WALK}"\n',
        }.items()
    },
    "a property named like a helper": {"a.xacro": robot(properties(__made="1"))},
    "a macro called by a walk": {"a.xacro": robot(f'<xacro:call macro="${{{WALK}}}"/>')},
    "an element named by a walk": {"a.xacro": robot(f'<xacro:element xacro:name="${{{WALK}}}"/>')},
    "a walk as a default": {
        "a.xacro": robot(
            f'<xacro:macro name="m" params="a:=${{{WALK}}}"><x/></xacro:macro><xacro:m/>'
        )
    },
    "a walk in a comment": {"a.xacro": robot(f"<!-- xacro:eval-comments --><!-- ${{{WALK}}} -->")},
    "a walk in a name": {"a.xacro": robot(f'<xacro:property name="${{{WALK}}}" value="1"/>')},
}
READS: dict[str, dict[str, str]] = {
    **{
        f"yaml of {path}": {"a.xacro": expression(f"xacro.load_yaml('{path}')")}
        for path in (
            *("/etc/passwd", "/proc/self/environ", "/proc/self/cmdline", "/dev/stdin"),
            *("OUTSIDE/secret.yaml", "../outside/secret.yaml", "link/secret.yaml"),
            *("folder/../../outside/secret.yaml", "link/../secret.yaml", "file:///etc/passwd"),
            *("file://OUTSIDE/secret.yaml", "~/.ssh/id_rsa", "pipe", "loop", "a\\x00b", "\\ud800"),
        )
    },
    **{
        f"include of {path}": {"a.xacro": robot(f'<xacro:include filename="{path}"/>')}
        for path in (
            *("/etc/passwd", "/proc/self/environ", "/proc/self/fd/0", "/dev/zero", "/dev/random"),
            *("OUTSIDE/secret.xacro", "../outside/secret.xacro", "link/secret.xacro", "pipe"),
            *("OUTSIDE/*.xacro", "../outside/*", "/proc/self/*", "*/../../outside/*.xacro", "/*"),
            *("file://OUTSIDE/secret.xacro", "$(find ../outside)/secret.xacro", "loop"),
            *("${'OUTSIDE/' + 'secret.xacro'}", "$(find p)/../../outside/secret.xacro", "folder"),
        )
    },
    "a lazy read": {
        "a.xacro": robot(
            properties(f="${xacro.load_yaml}", y="${f('OUTSIDE/secret.yaml')}") + '<x v="${y.k}"/>'
        )
    },
    "env": {"a.xacro": robot('<x v="$(env STUDIO_SECRET)"/>')},
    "env in an expression": {"a.xacro": robot("<x v=\"${'$(env STUDIO_SECRET)'}\"/>")},
    "env in $(eval)": hidden("env('STUDIO_SECRET')"),
    "env in a namespace": {"a.xacro": expression("xacro.environ")},
    "dirname": {"a.xacro": robot('<x v="$(dirname)"/>')},
    "an external entity": {
        "a.xacro": '<!DOCTYPE r [<!ENTITY s SYSTEM "file://OUTSIDE/secret.yaml">]>' + robot("&s;")
    },
    "a parameter entity": {
        "a.xacro": '<!DOCTYPE r [<!ENTITY % s SYSTEM "file://OUTSIDE/secret.yaml"> %s;]>'
        + robot("<x/>")
    },
}
CASES = {
    **{f"code: {n}": c for n, c in CODE.items()},
    **{f"read: {n}": c for n, c in READS.items()},
}


@pytest.fixture(scope="module")
def studio() -> Iterator[HostileStudio]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("STUDIO_SECRET", SECRET)
        with hostile_studio() as made:
            yield made


@pytest.fixture
def place(tmp_path: Path) -> Path:
    """A served folder with a pipe, links and a package in it, and secrets beside it."""
    import os

    inside, outside = tmp_path / "inside", tmp_path / "outside"
    write(outside, {"secret.xacro": robot(f"<{SECRET}/>"), "secret.yaml": f"k: {SECRET}\n"})
    write(inside / "p", {"package.xml": "<package><name>p</name></package>"})
    (inside / "folder").mkdir()
    (inside / "link").symlink_to(outside)
    (inside / "loop").symlink_to(inside / "loop")
    os.mkfifo(inside / "pipe")
    return inside


def placed(case: str, place: Path) -> dict[str, str | bytes]:
    marker, outside = str(place / "marker"), str(place.parent / "outside")
    return {
        name: text.replace("MARKER", marker).replace("OUTSIDE", outside)
        for name, text in CASES[case].items()
    }


@pytest.mark.parametrize("case", CASES)
def test_it_runs_nothing_and_reads_nothing_and_the_next_robot_opens(
    case: str, studio: HostileStudio, place: Path
):
    said = stopped(studio, placed(case, place), place)
    assert not (place / "marker").exists()
    assert SECRET not in repr(said)
    assert "root:" not in repr(said)


@pytest.mark.parametrize("case", CASES)
def test_stock_xacro_behind_the_guard_runs_and_reads_nothing(
    case: str, place: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setenv("STUDIO_SECRET", SECRET)
    file = write(place, placed(case, place))
    with pytest.raises(ExpansionError) as stopped:
        export_urdf(str(file), {}, policy_for(place), limits=Limits(seconds=1))
    assert not (place / "marker").exists()
    assert SECRET not in str(stopped.value)


@pytest.mark.parametrize("case", CASES)
def test_a_refusal_is_never_handed_to_stock_xacro(
    case: str, place: Path, monkeypatch: pytest.MonkeyPatch
):
    def never(*_arguments: object) -> str:
        raise AssertionError("the fallback was tried")

    monkeypatch.setattr(stock_xacro, "expand_root", never)
    file = write(place, placed(case, place))
    answer = open_session(OpenRequest(str(file), {}, policy_for(place), {}))[1]
    assert isinstance(answer, Failure)


@pytest.mark.parametrize("text", ["$(optenv STUDIO_SECRET none)", "$(eval optenv('HOME', 'none'))"])
def test_a_variable_that_may_not_be_seen_is_as_if_not_set(
    text: str, studio: HostileStudio, place: Path
):
    hidden_text = properties(p=text[7:-1]) + SHOW if "eval" in text else f'<x v="{text}"/>'
    answer, _ = studio.open(write(place, {"a.xacro": robot(hidden_text)}), policy_for(place))
    assert isinstance(answer, Expansion)
    assert answer.changed_parts[0].xml == '<x v="none"/>'

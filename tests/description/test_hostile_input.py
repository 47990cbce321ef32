"""Descriptions that want to run commands, read secrets or never end: a sentence, nothing else.

Each goes through the session (our evaluator) and through the exporter (stock xacro, guarded).
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import pytest

from studio.description.evaluator.stock_xacro import export_urdf
from studio.description.expressions.bounds import Limits
from studio.description.session import open_session
from studio.description.values import Expansion, Failure, OpenRequest
from studio.errors import ExpansionError, RefusedError
from tests.support.descriptions import XMLNS, policy_for, robot, write
from tests.support.sweep import some_of

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from studio.description.values import ReadPolicy

SECRET = "the-launch-code"
QUICK = Limits(seconds=1.0, macro_depth=50)
RUN = "import os; os.system('touch MARKER')"
WALK = (
    "[c for c in ().__class__.__base__.__subclasses__() if c.__name__ == '_wrap_close'][0]"
    ".__init__.__globals__['system']('touch MARKER')"
)
LAUGHS = "".join(f"<!ENTITY l{n} '{f'&l{n - 1};' * 10 if n else 'ha'}'>" for n in range(10))
YAML_LAUGHS = "a0: &a0 [x]\n" + "".join(
    f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 9)}]\n" for n in range(1, 10)
)
YAML_MERGES = "a0: &a0 {k: 1}\n" + "".join(
    f"a{n}: &a{n} {{<<: [{', '.join([f'*a{n - 1}'] * 9)}]}}\n" for n in range(1, 10)
)


def expression(text: str) -> str:
    return robot(f'<x v="${{{text}}}"/>')


def evaluated(text: str) -> str:
    """`$(eval)` of a text that hides in a property from xacro's own lexer."""
    return robot(f'<xacro:property name="p" value="{text}"/><x v="$(eval ${{p}})"/>')


def loaded(yaml: str) -> dict[str, str]:
    return {"a.xacro": expression("xacro.load_yaml('c.yaml')"), "c.yaml": yaml}


def property_chain(operation: str) -> str:
    """Forty properties, each made of the one before."""
    links = "".join(
        f'<xacro:property name="p{n + 1}" value="{operation.replace("@", f"p{n}")}"/>'
        for n in range(40)
    )
    return robot(f'<xacro:property name="p0" value="abcdefgh"/>{links}<x v="${{p40}}"/>')


COMMANDS: dict[str, dict[str, str]] = {
    "a lambda reaches os.system": {"a.xacro": expression(f"(lambda: {WALK})()")},
    "a comprehension reaches os.system": {"a.xacro": expression(f"[{WALK} for i in [1]]")},
    "exec in $(eval)": {"a.xacro": evaluated(f"exec(&quot;{RUN}&quot;, dict())")},
    "__import__ in $(eval)": {"a.xacro": evaluated("__import__('os').system('touch MARKER')")},
    **{
        f"a yaml tag {tag}": loaded(f'k: {tag} "(lambda: {WALK})()"\n')
        for tag in ("!radians", "!degrees", "!meters", "!millimeters", "!foot", "!inches")
    },
    "a python tag in yaml": loaded("k: !!python/object/apply:os.system ['touch MARKER']\n"),
    "a generator's frame": {"a.xacro": expression("(i for i in [1]).gi_frame.f_builtins['exec']")},
    "a class made on the fly": {"a.xacro": expression("python.type('T', (), dict(a=1))")},
    "getattr by name": {"a.xacro": expression("getattr(1, 'real')")},
    "the builtins by name": {"a.xacro": expression("__builtins__")},
    "a walk by format": {"a.xacro": expression("'%s' % '{0.__class__}'.format(math.sin)")},
    "a walk by str.format": {"a.xacro": expression("str.format('{0.__class__}', math.sin)")},
    "a walk by format_map": {"a.xacro": expression("'{a.real}'.format_map(dict(a=1))")},
    "an assignment": {"a.xacro": expression("[y := 1, y]")},
    "the local names": {"a.xacro": expression("python.vars()")},
}
SECRETS: dict[str, dict[str, str]] = {
    "open in $(eval)": {"a.xacro": evaluated("open('OUTSIDE/secret.yaml').read()")},
    "yaml by absolute path": {"a.xacro": expression("xacro.load_yaml('OUTSIDE/secret.yaml')")},
    "yaml by ..": {"a.xacro": expression("xacro.load_yaml('../outside/secret.yaml')")},
    "yaml by a link": {"a.xacro": expression("xacro.load_yaml('link/secret.yaml')")},
    "include by absolute path": {
        "a.xacro": robot('<xacro:include filename="OUTSIDE/secret.xacro"/>')
    },
    "include by ..": {"a.xacro": robot('<xacro:include filename="../outside/secret.xacro"/>')},
    "include by a link": {"a.xacro": robot('<xacro:include filename="link/secret.xacro"/>')},
    "include by a pattern": {"a.xacro": robot('<xacro:include filename="OUTSIDE/*.xacro"/>')},
    "include by a climbing pattern": {
        "a.xacro": robot('<xacro:include filename="*/../../outside/*.xacro"/>')
    },
    "an external entity": {
        "a.xacro": '<!DOCTYPE r [<!ENTITY s SYSTEM "file://OUTSIDE/secret.yaml">]>'
        f"<robot {XMLNS}>&s;</robot>"
    },
    "the environment": {"a.xacro": robot('<x v="$(env STUDIO_SECRET)"/>')},
    "the environment in $(eval)": {"a.xacro": evaluated("env('STUDIO_SECRET')")},
}
ENDLESS: dict[str, dict[str, str]] = {
    "powers": {"a.xacro": expression("9**9**9")},
    "powers by pow and shift": {"a.xacro": expression("1 &lt;&lt; 10**10")},
    "a long text": {"a.xacro": expression("'a'*10**11")},
    "a long list": {"a.xacro": expression("[0]*10**9")},
    "a long range": {"a.xacro": expression("list(python.range(10**12))")},
    "a wide field": {"a.xacro": expression("'%1000000000d' % 1")},
    "a wide format": {"a.xacro": expression("'{:1000000000}'.format(1)")},
    "a wide pad": {"a.xacro": expression("'a'.ljust(10**10)")},
    "a long factorial": {"a.xacro": expression("math.factorial(10**8)")},
    "a far rounding": {"a.xacro": expression("round(5, -10**9)")},
    "loops inside loops": {
        "a.xacro": expression("[0 for i in range(10**6) for j in range(10**6)]")
    },
    "texts that double": {"a.xacro": property_chain("${@}${@}")},
    "sums that double": {"a.xacro": property_chain("${@+@}")},
    "lists that double": {"a.xacro": property_chain("${[@,@]}")},
    "a macro without end": {
        "a.xacro": robot('<xacro:macro name="m"><xacro:m/></xacro:macro><xacro:m/>')
    },
    "a macro that doubles": {
        "a.xacro": robot(
            '<xacro:macro name="m" params="n"><xacro:if value="${n}"><xacro:m n="${n-1}"/>'
            '<xacro:m n="${n-1}"/></xacro:if></xacro:macro><xacro:m n="30"/>'
        )
    },
    "a file that includes itself": {
        "a.xacro": robot('<xacro:include filename="a.xacro"/>'),
    },
    "a billion laughs": {"a.xacro": f"<!DOCTYPE r [{LAUGHS}]><robot {XMLNS}>&l9;</robot>"},
    "yaml laughs": loaded(YAML_LAUGHS),
    "yaml merges": loaded(YAML_MERGES),
    "yaml in itself": loaded("a: &a [*a]\n"),
    "deep xml": {"a.xacro": f"<robot {XMLNS}>{'<a>' * 5000}{'</a>' * 5000}</robot>"},
    "deep yaml": loaded("[" * 5000 + "]" * 5000),
    "a deep expression": {"a.xacro": expression("-" * 15000 + "1")},
}
DEVICES = ("/dev/zero", "/dev/stdin", "pipe", "folder")


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A served folder with a pipe and a link in it, and secrets beside it."""
    monkeypatch.setenv("STUDIO_SECRET", SECRET)
    inside, outside = tmp_path / "inside", tmp_path / "outside"
    write(outside, {"secret.xacro": robot(f"<{SECRET}/>"), "secret.yaml": f"k: {SECRET}\n"})
    (inside / "folder").mkdir(parents=True)
    (inside / "link").symlink_to(outside)
    os.mkfifo(inside / "pipe")
    return inside


def placed(files: Mapping[str, str], place: Path) -> Path:
    marker, outside = str(place / "marker"), str(place.parent / "outside")
    return write(
        place,
        {n: t.replace("MARKER", marker).replace("OUTSIDE", outside) for n, t in files.items()},
    )


def open_one(file: Path, policy: ReadPolicy) -> Expansion | Failure:
    return open_session(OpenRequest(str(file), {}, policy, {}))[1]


def stopped(file: Path, place: Path) -> str:
    """See both evaluators stop, the last one within its time; what they said."""
    policy = policy_for(place)
    answer = open_one(file, policy)
    assert isinstance(answer, Failure), "it was expanded"
    assert len(answer.problem.sentence) < 500
    with pytest.raises(ExpansionError) as refused:
        export_urdf(str(file), {}, policy, limits=QUICK)
    return f"{answer!r} {refused.value}"


@pytest.mark.parametrize("case", COMMANDS)
def test_no_command_is_run(case: str, place: Path):
    said = stopped(placed(COMMANDS[case], place), place)
    assert not (place / "marker").exists()
    assert "built-in" not in said


@pytest.mark.parametrize("case", SECRETS)
def test_nothing_is_read_outside_the_roots(case: str, place: Path):
    assert SECRET not in stopped(placed(SECRETS[case], place), place)


@pytest.mark.parametrize("case", some_of(ENDLESS))
def test_nothing_goes_on_without_end(case: str, place: Path):
    stopped(placed(ENDLESS[case], place), place)


@pytest.mark.parametrize("device", DEVICES)
def test_only_regular_files_are_included(device: str, place: Path):
    stopped(placed({"a.xacro": robot(f'<xacro:include filename="{device}"/>')}, place), place)


@pytest.mark.parametrize("device", DEVICES)
def test_only_regular_files_are_loaded_as_yaml(device: str, place: Path):
    stopped(placed({"a.xacro": expression(f"xacro.load_yaml('{device}')")}, place), place)


def test_a_variable_that_may_not_be_seen_is_as_if_not_set(place: Path):
    files = {"a.xacro": robot('<x v="$(optenv STUDIO_SECRET none)"/>')}
    file = placed(files, place)
    answer = open_one(file, policy_for(place))
    assert isinstance(answer, Expansion)
    assert answer.changed_parts[0].xml == '<x v="none"/>'
    assert 'v="none"' in export_urdf(str(file), {}, policy_for(place))


def test_a_variable_that_is_shown_is_seen(place: Path):
    file = placed({"a.xacro": robot('<x v="$(env SHOWN)"/>')}, place)
    policy = policy_for(place, {"SHOWN": "yes"})
    answer = open_one(file, policy)
    assert isinstance(answer, Expansion)
    assert answer.changed_parts[0].xml == '<x v="yes"/>'
    assert 'v="yes"' in export_urdf(str(file), {}, policy)


def test_an_optional_include_outside_the_roots_is_left_out_with_a_warning(place: Path):
    body = '<xacro:include filename="OUTSIDE/secret.xacro" optional="true"/><x/>'
    file = placed({"a.xacro": robot(body)}, place)
    answer = open_one(file, policy_for(place))
    assert isinstance(answer, Expansion)
    assert [part.xml for part in answer.changed_parts] == ["<x/>"]
    assert [warning.code for warning in answer.warnings] == ["outside-roots"]


def test_one_run_cannot_change_mathematics_for_the_next(place: Path):
    stopped(placed({"a.xacro": expression("math.update(pi=3)")}, place), place)
    file = placed({"b.xacro": expression("math.pi")}, place)
    answer = open_one(file, policy_for(place))
    assert isinstance(answer, Expansion)
    assert "3.14159" in answer.changed_parts[0].xml
    assert "3.14159" in export_urdf(str(file), {}, policy_for(place))


def test_a_refusal_is_final_and_never_handed_to_stock_xacro(place: Path):
    file = placed({"a.xacro": expression("().__class__")}, place)
    with pytest.raises(RefusedError, match="__class__"):
        export_urdf(str(file), {}, policy_for(place))
    answer = open_one(file, policy_for(place))
    assert isinstance(answer, Failure)
    assert answer.problem.code == "expression-refused"


BAD_FILES: dict[str, tuple[bytes, str]] = {
    "empty": (b"", "file-empty"),
    "blank": (b"  \n", "file-empty"),
    "binary": (bytes(range(256)), "file-binary"),
    "UTF-16": (robot("").encode("utf-16"), "file-utf16"),
    "text": (b"just text", "xml-malformed"),
    "cut off": (robot("<x>").encode()[:-9], "xml-malformed"),
    "text before the declaration": (b"\n<?xml version='1.0'?><robot/>", "xml-not-first"),
    "undeclared prefix": (b"<robot><xacro:x/></robot>", "xml-unbound-prefix"),
    "another root": (f"<launch {XMLNS}/>".encode(), "root-not-robot"),
    "not its encoding": (b"<?xml version='1.0'?><robot a='\xe4'/>", "file-encoding"),
}


@pytest.mark.parametrize("case", BAD_FILES)
def test_a_file_that_is_no_description_is_named_in_one_sentence(case: str, tmp_path: Path):
    data, code = BAD_FILES[case]
    file = write(tmp_path, {"a.xacro": data})
    answer = open_one(file, policy_for(tmp_path))
    assert isinstance(answer, Failure)
    assert answer.problem.code == code
    assert answer.problem.place is not None
    assert answer.problem.place.file == str(file)


def test_a_urdf_that_is_xacro_is_expanded(tmp_path: Path):
    file = write(tmp_path, {"a.urdf": robot('<link name="${1+1}"/>')})
    answer = open_one(file, policy_for(tmp_path))
    assert isinstance(answer, Expansion)
    assert answer.part_order == ("link:2",)


def test_a_robot_without_a_name_opens(tmp_path: Path):
    file = write(tmp_path, {"a.urdf": '<robot><link name="a"/></robot>'})
    answer = open_one(file, policy_for(tmp_path))
    assert isinstance(answer, Expansion)
    assert answer.robot_name == ""

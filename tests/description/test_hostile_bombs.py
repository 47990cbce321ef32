"""Files that would go on or grow without end: each is stopped in time, the studio goes on.

In a real worker process, the next robot after each; and through stock xacro behind our guard.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.description.evaluator.stock_xacro import export_urdf
from studio.description.expressions.bounds import Limits
from studio.errors import ExpansionError
from tests.support.descriptions import policy_for, robot, write
from tests.support.hostile import (
    HostileStudio,
    chain,
    expression,
    loaded,
    properties,
    stopped,
)
from tests.support.sweep import some_of

if TYPE_CHECKING:
    from pathlib import Path


QUICK = Limits(seconds=1.0)
LISTS = chain("p", "${[1]}", "${[@, @]}")
"""p40 is a list of 40 levels that prints as a trillion ones."""
OTHER_LISTS = chain("q", "${[2]}", "${[@, @]}")
TUPLES = chain("t", "${(1,)}", "${(@, @)}")
NEARLY = "'a'*250000 + 'b' + 'a'*250000"
NESTED_LOOPS = "".join(f"[[{name}, {name}] for {name} in " for name in "abcdefghijklmnopqrstuvwxyz")
NEEDLE = "['a'*400000 + 'b' + 'a'*50000]"
SAME_HASH = "[i * (2**61 - 1) for i in range(60000)]"


def shown(text: str) -> str:
    return f'<x v="${{{text}}}"/>'


BIG_VALUES = {
    "printed": LISTS + shown("len(str(p40))"),
    "printed by repr": LISTS + shown("len(python.repr(p40))"),
    "printed by percent": LISTS + shown("len('%s' % (p40,))"),
    "printed by format": LISTS + shown("len('{}'.format(p40))"),
    "printed by map": LISTS + shown("list(map(str, [p40]))"),
    "printed from a view": LISTS + shown("dict(a=p40).items()"),
    "compared": LISTS + OTHER_LISTS + shown("p40 == q40"),
    "looked for": LISTS + OTHER_LISTS + shown("p40 in [q40]"),
    "counted": LISTS + OTHER_LISTS + shown("[q40].count(p40)"),
    "sorted": LISTS + OTHER_LISTS + shown("sorted([p40, q40])"),
    "the larger one": LISTS + OTHER_LISTS + shown("max(p40, q40)"),
    "hashed": TUPLES + shown("python.hash(t40)"),
    "a key": TUPLES + shown("dict([(t40, 1)])"),
    "in a set": TUPLES + shown("python.set([t40])"),
    "a kind of kinds": TUPLES + shown("python.isinstance(1, t40)"),
    "in one expression": shown(f"len(str({NESTED_LOOPS}[1]{']' * 26}))"),
    "in each other": properties(a="${[1]}", b="${[2]}") + shown("[a.append(b), b.append(a)]"),
    "in itself": properties(a="${[1]}") + shown("a.append(a)"),
    "appended to itself": (
        properties(a="${[1]}") + shown("[a.append(list(a)) for i in range(60)]")
    ),
    "extended by itself": properties(a="${[1]}") + shown("[a.extend(a) for i in range(40)]"),
    "appended by the type": (
        properties(a="${[1]}") + shown("[python.type(a).append(a, list(a)) for i in range(60)]")
    ),
    "numbers": chain("p", "${3}", "${@*@}") + shown("p40"),
    "texts": chain("p", "abcdefgh", "${@}${@}") + shown("p40"),
    "args": (
        '<xacro:arg name="a0" default="xxxxxxxx"/>'
        + "".join(
            f'<xacro:arg name="a{n + 1}" default="$(arg a{n})$(arg a{n})"/>' for n in range(40)
        )
        + '<x v="$(arg a40)"/>'
    ),
    "a megabyte in each of many": shown("'a'*1000000") * 600,
    "one text in very many": properties(a="${'a'*1000000}") + shown("a") * 30000,
    "a literal in very many": (
        f'<xacro:macro name="m"><x v="{"a" * 100000}"/></xacro:macro>' + "<xacro:m/>" * 3000
    ),
    "tuples side by side": shown("list(python.zip(*[range(100000)]*50))"),
    "a range of a range": shown("range(10**12, 10**30, 2**61 - 1)"),
}
LONG_WORK = {
    "replace": "('a'*10**6).replace('a', 'b'*10**6)",
    "replace by the type": "python.type('').replace('a'*10**6, 'a', 'b'*10**6)",
    "join": "('x'*10**6).join(['y'*10]*10**4)",
    "a search backwards": f"('a'*10**6).rfind({NEARLY})",
    "a split backwards": f"('a'*10**6).rsplit({NEARLY})",
    "a strip": "('a'*10**6).strip('bcd'*300000 + 'a')",
    "many beginnings": "('a'*10**6).startswith(python.tuple(['a'*999999 + 'b']*9000))",
    "texts that are nearly equal": "(['a'*10**6 + 'b']*100000).count('a'*10**6 + 'c')",
    "a product": "math.prod([2**2000]*9000)",
    "a common multiple": "math.lcm(*[x**700 for x in range(2, 5000)])",
    "factorials": "list(map(math.factorial, range(900000)))",
    "combinations": "[math.comb(5000, 2500) for i in range(90000)]",
    "digits": "list(map(str, [2**8000]*900000))",
    "digits of another base": "int('f'*1000000, 16) // int('e'*500000, 16)",
    "a sum of lists": "python.sum([[1]]*9000, [0]*9000)",
    "a pattern as separators": "xacro.tokenize('a'*40 + 'c', sep='x]|(?:a|a)*b|[y')",
    "a slow key": "sorted([1]*9000, key='a'*10**6)",
    "a slow key of a list": "([1]*9000).sort(key=math.factorial)",
    "a function for each": "list(map(('a'*10**6).rfind, ['a'*90 + 'b']*9000))",
    "numbers of one hash": f"python.set({SAME_HASH})",
    "keys of one hash": f"dict([(k, 1) for k in {SAME_HASH}])",
    "a table of one hash": f"dict.fromkeys({SAME_HASH})",
    "a wide percent": "'%9999999999d' % 1",
    "a percent as wide as asked": "'%*d' % (10**9, 1)",
    "a precise percent": "'%.1000000000f' % 1",
    "a named percent": "'%(a)999999999s' % dict(a=1)",
    "many wide percents": "('%9999d'*1800) % python.tuple([1]*1800)",
    "many tabs": "('\\t'*10**6).expandtabs(10000)",
    "a wide padding": "'a'.center(10**9, 'b')",
    "many lines": "('\\n'*10**6).splitlines()",
    "the type of a range": "python.sum(python.type(python.range(1))(10**12))",
    "the type of a map": (
        "list(python.type(map(len, []))(('a'*10**6).rfind, ['a'*90 + 'b']*9000))"
    ),
    "a list that grows as it is numbered": "[l.extend(python.enumerate(l)) for l in [[1]]]",
    "a list that grows as it is zipped": "[l.extend(python.zip(l)) for l in [[1]]]",
    "a list that grows as it is numbered, by its type": (
        "[python.type(l).extend(l, python.enumerate(l)) for l in [[1]]]"
    ),
    "a zip of very many": "python.all(python.zip(*[range(100000)]*9999))",
    "a search in a zip of very many": "1 in python.zip(*[range(100000)]*9999)",
    "one of many mapped digits": (
        "[x // y for x in map(int, ['f'*10**6], [16]) for y in map(int, ['e'*500000], [16])]"
    ),
    "many texts in capitals": f"len(('é'*900000){'.title()' * 2000})",
    "many texts backwards": f"len(('é'*900000){'[::-1]' * 3000})",
    "many searches of a text": f"[[{'b in a, ' * 2000}] for a in ['a'*900000] for b in {NEEDLE}]",
    "many searches of a range": f"[[{'.5 in r, ' * 2000}] for r in [range(100000)]]",
    "the largest of many": f"[[{'max(r), ' * 2000}] for r in [range(100000)]]",
    "many formats": f"[[{'len(str(l)), ' * 1200}] for l in [[x * 1.1 for x in range(9000)]]]",
    "many percents": f"[[{'len(t%l), ' * 1200}] for t in ['%s'] for l in [[[.1] * 9000]]]",
    "many sets of one hash": f"[{'python.set(h), ' * 40}]".join(
        ("[", " for h in [[i * (2**61 - 1) for i in range(9000)]]]")
    ),
    "sets of one hash compared": (
        "[[python.set(h) == python.set(h)]*9 for h in [[i * (2**61 - 1) for i in range(9000)]]]"
    ),
    "a map over a range": "len(list(map(xacro.message, range(10**6))))",
}
DOUBLING = '<xacro:macro name="m" params="*b"><a>{0}{0}</a></xacro:macro>'.format(
    '<xacro:insert_block name="b"/>'
)
TREES: dict[str, dict[str, str]] = {
    "files that include two each": {
        "a.xacro": robot('<xacro:include filename="f0.xacro"/>'),
        **{
            f"f{n}.xacro": robot(f'<xacro:include filename="f{n + 1}.xacro"/>' * 2)
            for n in range(40)
        },
        "f40.xacro": robot("<x/>"),
    },
    "two files that include each other": {
        "a.xacro": robot('<xacro:include filename="b.xacro"/>'),
        "b.xacro": robot('<xacro:include filename="./a.xacro"/>'),
    },
    "blocks that double": {
        "a.xacro": robot(DOUBLING + "<xacro:m>" * 30 + "<x/>" + "</xacro:m>" * 30)
    },
    "a pattern of many folders": {
        "a.xacro": robot(f'<xacro:include filename="{"*/" * 30}*.xacro"/>')
    },
    "properties behind each other": {
        "a.xacro": robot(chain("p", "1", "${@}", 20_000) + shown("p20000"))
    },
    "params of a book": {
        "a.xacro": robot(f'<xacro:macro name="m" params="{"a:=" * 30000}"/><xacro:m/>')
    },
    "params that nearly fit": {
        "a.xacro": robot(f'<xacro:macro name="m" params="a:={"x" * 9000}&quot; b"/><xacro:m/>')
    },
    "a text of many pieces": {"a.xacro": robot(f"<t>{'a ${1} ' * 300_000}</t>")},
    "openings without ends": {"a.xacro": robot(f'<x v="{"$(" * 100_000}"/>')},
    "yaml of many values": loaded(f"[{'1,' * 3_000_000}1]"),
    "yaml of many keys": loaded("".join(f"k{n}: {n}\n" for n in range(300_000))),
    "yaml of many levels": loaded("{a: " * 20_000 + "1" + "}" * 20_000),
    "yaml of many dashes": loaded("- " * 20_000 + "1"),
    "a yaml number of many digits": loaded(f"k: {'9' * 1_000_000}\n"),
    "a yaml number of many parts": loaded(f"k: 1{':59' * 200_000}\n"),
    "yaml that merges with itself": loaded(
        "a0: &a0 {k: 1}\n"
        + "".join(f"a{n}: &a{n} {{<<: [*a{n - 1}, *a{n - 1}]}}\n" for n in range(1, 30))
    ),
    "a yaml tag that loops": loaded(
        'k: !degrees "len([0 for i in [0]*999 for j in [0]*999 for k in [0]*999])"\n', ".k"
    ),
    "a yaml tag that grows": loaded("k: !degrees \"len('a'*10**11)\"\n", ".k"),
}
CASES: dict[str, dict[str, str]] = {
    **{f"big: {name}": {"a.xacro": robot(body)} for name, body in BIG_VALUES.items()},
    **{f"long: {name}": {"a.xacro": expression(text)} for name, text in LONG_WORK.items()},
    **TREES,
}


@pytest.mark.parametrize("case", some_of(CASES))
def test_it_is_stopped_in_time_and_the_next_robot_opens(
    case: str, studio: HostileStudio, tmp_path: Path
):
    stopped(studio, CASES[case], tmp_path)


@pytest.mark.parametrize("case", some_of(CASES, 8))
def test_stock_xacro_behind_the_guard_is_stopped_too(case: str, tmp_path: Path):
    file = write(tmp_path, CASES[case])
    with pytest.raises((ExpansionError, MemoryError)):
        export_urdf(str(file), {}, policy_for(tmp_path), limits=QUICK)


def test_a_folder_that_links_to_itself_is_not_walked_without_end(
    studio: HostileStudio, tmp_path: Path
):
    for name in "abcdefgh":
        (tmp_path / name).symlink_to(tmp_path)
    files = {"a.xacro": robot('<xacro:include filename="*/*/*/*/*/*/*/*/*/no.xacro"/>')}
    assert stopped(studio, files, tmp_path).problem.code == "too-many-wildcards"

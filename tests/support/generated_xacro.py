"""Random small xacro files for comparison with stock: every construct inside every other."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hypothesis import strategies as st

from tests.support.descriptions import robot

if TYPE_CHECKING:
    from hypothesis.strategies import SearchStrategy

NAMES = st.sampled_from(["a", "b", "c"])
SPACE = "n"
"""The namespace that some files are included in."""
MACROS = ("m0", "m1", "m2")
"""A macro calls only those before it, so that nothing recurses without end."""
YAML = """\
k: 2
n: 0.5
t: text
angle: !degrees 90
size: !inches "4/2"
l: [1, [2, 3], {x: 7}]
m: {x: 5, y: {z: [8, 9]}, a: -1}
"""

literals = st.sampled_from(
    ["1", "0.10", "010", "-2", "true", "False", "1e3", "x y", "'07'", "1_0", "", "0", "left"]
)
yaml_reads = st.sampled_from(
    [
        *("y.k", "y['n'] * 2", "y.t", "y.l[1][0]", "y.l[2].x", "y.m.y.z[-1]", "y.m.get('no', 3)"),
        *("'x' in y.m", "len(y.l)", "[i for i in y.m.y.z]", "y.angle", "y.size", "y.none", "y.m"),
        *("sorted(y.m.keys())", "y.m.y.z.pop(0)", "dict(y.m)['a']", "y.l[0] + y.k", "y.l"),
        *("y.m.get('y').z", "y.m.get('y')['z']", "[v for v in y.l + []][1]", "y.m.values()"),
        *(
            "[v.z for k, v in y.m.items() if k == 'y']",
            "y.l.pop().x",
            "y.m.pop('x', 4)",
            "y.m.keys()",
        ),
        *("xacro.load_yaml('c.yaml').k", "[k for k in y.m]", "y.m.items()", "y.l[1] * 2"),
    ]
)
expressions = st.one_of(
    NAMES,
    st.builds("{} + {}".format, NAMES, NAMES),
    st.builds("{} * 2".format, NAMES),
    st.builds("-{} / 4".format, NAMES),
    st.builds("{} == {}".format, NAMES, NAMES),
    st.builds("str({}) + 'q'".format, NAMES),
    st.builds("[{}, 1][0]".format, NAMES),
    st.builds("{} if {} else 3".format, NAMES, NAMES),
    st.builds("[i for i in [{}, 2]]".format, NAMES),
    st.builds("max({}, 1.5)".format, NAMES),
    st.builds("{}.{}".format, st.just(SPACE), NAMES),
    st.builds("'{}' in {}".format, NAMES, st.just(SPACE)),
    st.builds("xacro.arg('{}')".format, NAMES),
    yaml_reads,
    st.just("pi"),
)
texts = st.one_of(
    literals,
    expressions.map("${{{}}}".format),
    st.builds("p${{{}}}_$(arg {})".format, expressions, NAMES),
    NAMES.map("$(arg {})".format),
    NAMES.map("$${{{}}}$$$$(z)".format),
    NAMES.map("${{$(arg {}) + 1}}".format),
    NAMES.map("$(optenv STUDIO_NOT_SET {} d)".format),
    NAMES.map("$(eval {} * 2)".format),
)
attributes = st.one_of(
    texts.map('v="{}"'.format),
    texts.map('xacro:hint="{}"'.format),
    st.sampled_from(['xmlns:g="http://g" g:v="${b}"', 'xmlns:g="http://h"', 'xmlns="http://d"']),
)
blanks = st.sampled_from(["", "\n", "\n  ", "\n\n", " "])
comments = st.one_of(
    texts.map("<!-- {} -->".format),
    st.sampled_from(["<!-- xacro:eval-comments -->", "<!-- xacro:eval-comments:off -->"]),
)
scopes = st.sampled_from(
    ["", ' scope="global"', ' scope="parent"', ' lazy_eval="0"', ' lazy_eval="${a}"']
)
leaves = st.one_of(
    st.builds('<xacro:property name="{}" value="{}"/>'.format, NAMES, texts),
    st.builds('<xacro:property name="{}" value="{}"{}/>'.format, NAMES, texts, scopes),
    st.builds('<xacro:property name="{}" default="{}"{}/>'.format, NAMES, texts, scopes),
    st.builds('<xacro:property name="{}" remove="{}"/>'.format, NAMES, literals),
    st.builds('<xacro:property name="${{str({})}}" value="1"/>'.format, NAMES),
    st.builds('<xacro:arg name="{}" default="{}"/>'.format, NAMES, texts),
    st.builds('<xacro:attribute name="w" value="s{}"/>'.format, texts),
    st.builds('<xacro:attribute name="${{{}}}" value="{}"/>'.format, expressions, literals),
    NAMES.map('<xacro:insert_block name="{}"/>'.format),
    st.sampled_from(
        [
            '<xacro:include filename="b.xacro"/>',
            f'<xacro:include filename="b.xacro" ns="{SPACE}"/>',
            '<xacro:include filename="b*.xacro" ns="${str(a)}"/>',
            '<xacro:include filename="no.xacro" optional="true"/>',
        ]
    ),
    texts.map("<t>{}</t>".format),
    st.sampled_from(["<![CDATA[${a} <b>]]>", " solid ${b} "]),
    comments,
    blanks,
)
parameters = st.one_of(
    NAMES,
    NAMES.map("*{}".format),
    NAMES.map("**{}".format),
    st.builds(
        "{}{}{}".format,
        NAMES,
        st.sampled_from([":=", "="]),
        st.sampled_from(
            ["1", "'x y'", "^", "^|2", "^|'u v'", "${b}", "${c+1}", "$(arg c)", "^|${a}"]
        ),
    ),
)


def content(macros: int, depth: int) -> SearchStrategy[str]:
    """A few constructs; those inside them are one less deep and call macros below `macros`."""
    if depth == 0:
        return st.lists(leaves, max_size=2).map("".join)
    inner = content(macros, depth - 1)
    options = [
        leaves,
        comments,
        blanks,
        st.builds("<x {}>{}</x>".format, attributes, inner),
        st.builds('<xacro:if value="{}">{}</xacro:if>'.format, texts, inner),
        st.builds('<xacro:unless value="{}">{}</xacro:unless>'.format, texts, inner),
        st.builds(
            '<xacro:property name="{}"><y {}/>{}</xacro:property>'.format, NAMES, attributes, inner
        ),
        st.builds(
            '<xacro:element xacro:name="{}" {}>{}</xacro:element>'.format,
            st.sampled_from(["ea", "e${b}", "${c}", "xacro:if", "xacro:m0"]),
            attributes,
            inner,
        ),
    ]
    for index in range(macros):
        options.append(_definition(index, depth))
        options.append(_call(index, inner))
    return st.lists(st.one_of(options), max_size=5).map("".join)


def _definition(index: int, depth: int) -> SearchStrategy[str]:
    written = st.lists(parameters, max_size=3, unique_by=lambda text: text.strip("*")[0])
    return st.builds(
        f'<xacro:macro name="{MACROS[index]}" params="{{}}"{{}}>{{}}</xacro:macro>'.format,
        written.map(" ".join),
        st.sampled_from(["", "", ' xmlns:g="http://g"']),
        content(index, depth - 1),
    )


def _call(index: int, inner: SearchStrategy[str]) -> SearchStrategy[str]:
    given = st.dictionaries(NAMES, texts, max_size=2).map(
        lambda pairs: " ".join(f'{name}="{text}"' for name, text in pairs.items())
    )
    name = MACROS[index]
    spelled = st.sampled_from(
        [
            *[f"<xacro:{name} {{}}>{{}}</xacro:{name}>"] * 2,
            f"<xacro:{SPACE}.{name} {{}}>{{}}</xacro:{SPACE}.{name}>",
            f"<xacro:call macro=\"${{{{'{name}'}}}}\" {{}}>{{}}</xacro:call>",
        ]
    )
    return st.builds(str.format, spelled, given, inner)


_MACROS_DEFINED = "".join(
    f'<xacro:macro name="{macro}" params="a:=1 *b"><u v="${{a}}"><xacro:insert_block '
    f'name="b"/></u></xacro:macro>'
    for macro in MACROS
)
DEFINED = (
    "".join(f'<xacro:arg name="{name}" default="{n}"/>' for n, name in enumerate("abc", 1))
    + "".join(f'<xacro:property name="{name}" value="{n}"/>' for n, name in enumerate("abc", 4))
    + '<xacro:property name="a"><z v="${b}"/></xacro:property>'
    + _MACROS_DEFINED
    + '<xacro:property name="y" value="${xacro.load_yaml(\'c.yaml\')}"/>'
    + f'<xacro:include filename="d.xacro" ns="{SPACE}"/>'
)
"""Put in front, so that most bodies mean something."""
SPACE_DEFINED = (
    '<xacro:property name="a" value="-7"/><xacro:property name="b" value="${a + c}"/>'
    + _MACROS_DEFINED
)
bodies = content(len(MACROS), 3)


@st.composite
def files(draw: st.DrawFn) -> dict[str, str]:
    """A file that includes others and reads YAML; the first is the one to open."""
    return {
        "a.xacro": robot(DEFINED + draw(bodies)),
        "b.xacro": robot(draw(content(1, 1)), draw(attributes)),
        "c.yaml": YAML,
        "d.xacro": robot(SPACE_DEFINED, ""),
    }

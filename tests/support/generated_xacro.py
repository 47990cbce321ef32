"""Random small xacro bodies for comparison with stock: every construct inside every other."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hypothesis import strategies as st

if TYPE_CHECKING:
    from hypothesis.strategies import SearchStrategy

NAMES = st.sampled_from(["a", "b", "c"])
MACROS = ("m0", "m1", "m2")
"""A macro calls only those before it, so that nothing recurses without end."""

literals = st.sampled_from(
    ["1", "0.10", "010", "-2", "true", "False", "1e3", "x y", "'07'", "1_0", "", "0", "left"]
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
)
attributes = texts.map('v="{}"'.format)
properties = st.one_of(
    st.builds('<xacro:property name="{}" value="{}"/>'.format, NAMES, texts),
    st.builds('<xacro:property name="{}" default="{}"/>'.format, NAMES, texts),
    st.builds('<xacro:property name="{}" remove="true"/>'.format, NAMES),
    st.builds('<xacro:property name="{}" value="{}" lazy_eval="0"/>'.format, NAMES, texts),
    st.builds('<xacro:property name="{}" value="{}" scope="global"/>'.format, NAMES, texts),
    st.builds('<xacro:arg name="{}" default="{}"/>'.format, NAMES, texts),
    st.builds('<xacro:attribute name="w" value="s{}"/>'.format, texts),
    NAMES.map('<xacro:insert_block name="{}"/>'.format),
    texts.map("<t>{}</t>".format),
)
parameters = st.one_of(
    NAMES,
    NAMES.map("*{}".format),
    NAMES.map("**{}".format),
    st.builds(
        "{}:={}".format, NAMES, st.sampled_from(["1", "'x y'", "^", "^|2", "${b}", "${c+1}"])
    ),
)


def content(macros: int, depth: int) -> SearchStrategy[str]:
    """A few constructs; those inside them are one less deep and call macros below `macros`."""
    if depth == 0:
        return st.lists(properties, max_size=2).map("".join)
    inner = content(macros, depth - 1)
    options = [
        properties,
        st.builds("<x {}>{}</x>".format, attributes, inner),
        st.builds('<xacro:if value="{}">{}</xacro:if>'.format, texts, inner),
        st.builds('<xacro:unless value="{}">{}</xacro:unless>'.format, texts, inner),
        st.builds(
            '<xacro:property name="{}"><y {}/>{}</xacro:property>'.format, NAMES, attributes, inner
        ),
        st.builds(
            '<xacro:element xacro:name="e{}" {}>{}</xacro:element>'.format, NAMES, attributes, inner
        ),
    ]
    for index in range(macros):
        options.append(_definition(index, depth))
        options.append(_call(index, inner))
    return st.lists(st.one_of(options), max_size=4).map("".join)


def _definition(index: int, depth: int) -> SearchStrategy[str]:
    written = st.lists(parameters, max_size=3, unique_by=lambda text: text.strip("*")[0])
    return st.builds(
        f'<xacro:macro name="{MACROS[index]}" params="{{}}">{{}}</xacro:macro>'.format,
        written.map(" ".join),
        content(index, depth - 1),
    )


def _call(index: int, inner: SearchStrategy[str]) -> SearchStrategy[str]:
    given = st.dictionaries(NAMES, texts, max_size=2).map(
        lambda pairs: " ".join(f'{name}="{text}"' for name, text in pairs.items())
    )
    return st.builds(
        f"<xacro:{MACROS[index]} {{}}>{{}}</xacro:{MACROS[index]}>".format, given, inner
    )


DEFINED = (
    "".join(f'<xacro:arg name="{name}" default="{n}"/>' for n, name in enumerate("abc", 1))
    + "".join(f'<xacro:property name="{name}" value="{n}"/>' for n, name in enumerate("abc", 4))
    + '<xacro:property name="a"><z v="${b}"/></xacro:property>'
    + "".join(
        f'<xacro:macro name="{macro}" params="a:=1 *b"><u v="${{a}}"><xacro:insert_block '
        f'name="b"/></u></xacro:macro>'
        for macro in MACROS
    )
)
"""Put in front, so that most bodies mean something."""
bodies = content(len(MACROS), 3)

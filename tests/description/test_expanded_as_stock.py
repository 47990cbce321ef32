"""What xacro's users and its own test data rely on, with and without arguments, against stock."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.description.faults import Fault
from tests.support.commented import commented_run, commented_xml
from tests.support.descriptions import policy_for, robot, stock_text, write
from tests.support.launches import launches
from tests.support.stock_command import StockCommand
from tests.support.sweep import some_of

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from tests.support.commented import Commented

LAUNCHED_AT_LEAST = 83
"""Expansions with arguments that stock manages, in each share; there are 629 of 1,109 in all."""
_SHARES = 6
LIBRARY = robot(
    '<xacro:property name="p" value="in"/><xacro:property name="q" value="${p}"/>'
    '<xacro:macro name="set" params="to"><xacro:property name="p" value="${to}" scope="parent"/>'
    '</xacro:macro><xacro:macro name="show"><s p="${p}" q="${q}"/></xacro:macro>',
    "",
)
INCLUDED: dict[str, str] = {
    "lib.xacro": LIBRARY,
    "outer.xacro": robot('<xacro:include filename="lib.xacro" ns="deep"/><xacro:deep.show/>', ""),
    "part1.xml": robot("<one/>", ""),
    "part2.xml": robot("<two/>", ""),
    "space.xml": robot("<in_space/>", 'xmlns:g="http://g" xmlns:h="http://h"'),
    "sub/part.xacro": robot('<deep/><xacro:include filename="../part1.xml"/>', ""),
    "list.yaml": "- [A, B]\n- {x: {y: [2, 3]}}\n",
    "arms.yaml": "left: {file: part1.xml, macro: m1}\nright: {file: part2.xml, macro: m2}\n",
    "units.yaml": "k: 42\nangles: [!radians pi, !degrees 2*90]\nsizes: [!foot 1/0.3048]\n",
    "bad.yaml": "k: !radians os.getcwd()\n",
}
TWO_MACROS = '<xacro:macro name="m1"><a/></xacro:macro><xacro:macro name="m2"><b/></xacro:macro>'

EXPANDED = {
    "a namespace sets and shows its own": (
        '<xacro:property name="p" value="out"/><xacro:include filename="lib.xacro" ns="n"/>'
        '<xacro:n.show/><xacro:n.set to="new"/><xacro:n.show/><x p="${p}" n="${n.p}"/>'
    ),
    "namespaces inside namespaces": (
        '<xacro:include filename="outer.xacro" ns="o"/><x v="${o.deep.p}"/>'
        '<xacro:o.deep.set to="7"/><xacro:o.deep.show/>'
    ),
    "a name that is only inside": (
        '<xacro:include filename="lib.xacro" ns="n"/>'
        """<x v="${'p' in n}" w="${'z' in n}" z="${n.q * 2}"/>"""
    ),
    "patterns": (
        '<xacro:include filename="part*.xml"/><xacro:include filename="part?.xml"/>'
        '<xacro:include filename="part[1-2].xml"/><xacro:include filename="none*.xml"/>'
    ),
    "an include that includes": '<xacro:include filename="sub/part.xacro"/>',
    "an include by a variable and from a macro": (
        '<xacro:macro name="get" params="f:=part1.xml"><xacro:include filename="${f}"/>'
        "</xacro:macro><xacro:get/><xacro:get f=\"${xacro.abs_filename('part2.xml')}\"/>"
    ),
    "an include in a branch not taken": (
        '<xacro:if value="false"><xacro:include filename="$(find nowhere)/x"/></xacro:if><x/>'
    ),
    "prefixes are lifted to where an include stands": (
        '<x><xacro:include filename="space.xml"/></x><y xmlns:g="http://other">'
        '<xacro:include filename="space.xml"/></y>'
    ),
    "prefixes are lifted to where a macro is called": (
        '<xacro:macro name="m" xmlns:g="http://g"><g:in a="1"/></xacro:macro>'
        "<x><y><xacro:m/></y></x><xacro:m/>"
    ),
    "prefixes of a condition are lost": (
        '<xacro:macro name="m" xmlns:g="http://g"><z/></xacro:macro>'
        '<x><xacro:if value="1" xmlns:k="http://k"><xacro:m/></xacro:if></x>'
    ),
    "xacro's own prefix goes wherever it is declared": (
        '<x xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:if value="1"><y/></xacro:if></x>'
    ),
    "a target namespace is for the root only": '<b xacro:targetNamespace="http://t"/>',
    "tags without the prefix are the robot's": (
        '<include filename="nada"><tag/></include><arg name="a" value="1"/><macro name="m"/>'
    ),
    "yaml of lists and mappings": (
        """<xacro:property name="l" value="${xacro.load_yaml('list.yaml')}"/>"""
        '<x a="${l[0][1]}" b="${l[1].x.y[0]}" c="${l[1]}" d="${l[-1].x}" e="${l[0] + [1]}"/>'
    ),
    "yaml names files and macros": (
        f"{TWO_MACROS}"
        """<xacro:property name="arms" value="${xacro.load_yaml('arms.yaml')}"/>"""
        '<xacro:include filename="${arms.left.file}"/>'
        """<xacro:call macro="${arms['right']['macro']}"/>"""
        '<xacro:call macro="${arms.left.macro}"/>'
    ),
    "yaml units": (
        """<xacro:property name="u" value="${xacro.load_yaml('units.yaml')}"/>"""
        '<x k="${u.k}" a="${u.angles[0]}" b="${u.angles[1]}" c="${u.sizes[0]}"/>'
    ),
    "the deprecated names still work": (
        """<x a="${load_yaml('units.yaml').k}" b="${sorted([2, 1])}" c="${list(range(2))}"/>"""
        """<y v="${dotify(dict(a=1)).a}" w="${abs_filename('/x')}"/>"""
    ),
    "python's names in a namespace": (
        '<x a="${python.sum([1, 2])}" b="${list(python.zip([1], [2]))}" c="${python.len([1])}"'
        ' d="${python.any([0, 1])}" e="${python.isinstance(1, int)}" f="${math.floor(2.5)}"/>'
    ),
    "none is none": '<x a="${None}" b="${None == 0}"/>',
    "an attribute of no name that is lost": (
        '<x><xacro:if value="1"><xacro:attribute name="3" value="1"/></xacro:if></x>'
    ),
    "letters of any alphabet": (
        '<xacro:property name="größe" value="ß"/><x v="${größe * 2}">🍔 ${größe}</x>'
    ),
    "numbers that only look like it": (
        '<xacro:property name="a" value="1_000"/><xacro:property name="b" value="0x10"/>'
        '<xacro:property name="c" value=".5"/><xacro:property name="d" value=" 42 "/>'
        '<x v="${a} ${b} ${c + 1} ${d * 2}"/>'
    ),
    "lists written as texts stay texts": (
        '<xacro:property name="l" value="[0, 1+1]"/><x v="${l}" w="${l[0]}"/>'
    ),
    "a removed name is as never defined": (
        '<xacro:property name="a" value="1"/><xacro:property name="a" remove="${1 == 1}"/>'
        '<xacro:property name="a" default="3"/><xacro:property name="b" remove="false" value="2"/>'
        '<x v="${a} ${b}"/>'
    ),
    "quoted defaults with blanks": (
        """<xacro:macro name="m" params="a='1 -2' b=&quot;x y&quot;   c:=3
        d:=${[1, 2]} e:=$(arg z)"><x v="${a}|${b}|${c}|${d}|${e}"/></xacro:macro>
        <xacro:arg name="z" default="zz"/><xacro:m/>"""
    ),
    "defaults are read where the call stands, in order": (
        '<xacro:macro name="m" params="v:=${2*w}"><xacro:property name="w" value="-"/>'
        '<x v="${v}"/></xacro:macro><xacro:property name="w" value="21"/><xacro:m/>'
        '<xacro:property name="w" value="*"/><xacro:m/>'
    ),
    "a value is not evaluated twice": (
        '<xacro:macro name="m" params="a b:=${a} c:=$${a}"><x v="${a} ${b} ${c}"/></xacro:macro>'
        '<xacro:property name="a" value="1"/><xacro:property name="d" value="$${a}"/>'
        '<x v="${d}"/><xacro:m a="2"/>'
    ),
    "blocks by number": (
        '<xacro:macro name="m" params="*one *two"><xacro:insert_block name="two"/>'
        '<xacro:insert_block name="one"/><xacro:insert_block name="one"/></xacro:macro>'
        "<xacro:m><a/> text <!-- c --><b/></xacro:m>"
    ),
    "substitutions inside expressions and the reverse": (
        '<xacro:arg name="var" default="xacro"/>'
        """<x a="${2*'$(arg var)'}" b="$(arg ${'v'+'ar'})" c="$(eval 'a' + var)"/>"""
    ),
    "an empty arg": '<xacro:arg name="e" default=""/><x v="$(arg e)">$(arg e)</x>',
    "a name inside a condition of names": (
        '<xacro:property name="t" value="${True}"/><xacro:property name="f" value="${3*0.0}"/>'
        '<xacro:if value="${t}"><a/></xacro:if><xacro:unless value="${f}"><b/></xacro:unless>'
    ),
    "a value of an arg may be a condition": (
        '<xacro:arg name="on" default="True"/><xacro:if value="$(arg on)"><a/></xacro:if>'
    ),
    "messages come to nothing": "<x v=\"${xacro.message('m')}|${xacro.print_location()}\"/>",
}
REFUSED = {
    "a name with a dot": '<xacro:property name="a.b" value="1"/>',
    "a keyword": '<xacro:property name="pass" value="1"/>',
    "a name with blanks": '<xacro:property name=" a" value="1"/>',
    "two underscores": '<xacro:property name="__a" value="1"/>',
    "a value and a default": '<xacro:property name="a" value="1" default="2"/>',
    "a macro called call": '<xacro:macro name="call"><x/></xacro:macro>',
    "a macro with a dot": '<xacro:macro name="a.b"><x/></xacro:macro>',
    "a macro that nobody defined": "<xacro:nope><x/></xacro:nope>",
    "a macro by a name that nobody defined": '<xacro:call macro="nope"/>',
    "a call of nothing": '<xacro:call macro=""/>',
    "a namespace that nobody made": "<xacro:n.show/>",
    "a condition that is none": '<xacro:if value="nonsense"><x/></xacro:if>',
    "a condition of a number as text": '<xacro:if value="1.5"><x/></xacro:if>',
    "a missing file": '<xacro:include filename="none.xml"/>',
    "an include without a file": "<xacro:include/>",
    "an expression that is not closed": "<x>a${</x>",
    "a substitution that is not closed": "<x>$(b</x>",
    "braces inside an expression": "<x>${{}}</x>",
    "an empty expression": '<x v="${}"/>',
    "a division by nothing": '<x v="${1/0}"/>',
    "a circle": '<xacro:property name="a" value="${b}"/><xacro:property name="b" value="${2*a}"/>'
    '<x v="${a}"/>',
    "an arg that nobody gives": '<x v="$(arg foo)"/>',
    "a substitution that nobody knows": '<x v="$(pwd)"/>',
    "a missing parameter": '<xacro:macro name="m" params="a"><x/></xacro:macro><xacro:m/>',
    "a forwarded name that is missing": (
        '<xacro:macro name="m" params="a:=^"><x/></xacro:macro><xacro:m/>'
    ),
    "too many blocks": '<xacro:macro name="m"><x/></xacro:macro><xacro:m><y/></xacro:m>',
    "too few blocks": '<xacro:macro name="m" params="*b"><x/></xacro:macro><xacro:m/>',
    "a block that nobody gave": '<xacro:insert_block name="b"/>',
    "a parent of the outermost scope": '<xacro:property name="a" value="1" scope="parent"/>',
    "an attribute that is a number": '<x><xacro:attribute name="a" value="${1+1}"/></x>',
    "an element that is a number": '<xacro:element xacro:name="${1+1}"/>',
    "an attribute named by nothing": '<x><xacro:attribute name="" value="1"/></x>',
    "a missing key": "<x v=\"${xacro.load_yaml('units.yaml').none}\"/>",
    "dots behind get": "<x v=\"${xacro.load_yaml('arms.yaml').get('left').file}\"/>",
    "a call inside a yaml tag": "<x v=\"${xacro.load_yaml('bad.yaml').k}\"/>",
    "the file calls a halt": "<x v=\"${xacro.fatal('Stop.')}\"/>",
    "an undeclared prefix": "<g:x/>",
}


@pytest.mark.parametrize("case", EXPANDED)
def test_it_expands_as_xacro_expands_it(case: str, tmp_path: Path):
    file = write(tmp_path, {"a.xacro": robot(EXPANDED[case]), **INCLUDED})
    text = stock_text(file)
    assert text is not None, "stock xacro cannot expand the case"
    assert commented_run(str(file), policy_for(tmp_path)) == commented_xml(text)


@pytest.mark.parametrize("case", REFUSED)
def test_what_xacro_refuses_gets_a_sentence_and_a_place(case: str, tmp_path: Path):
    file = write(tmp_path, {"a.xacro": robot(REFUSED[case]), **INCLUDED})
    assert stock_text(file) is None, "stock xacro expands the case"
    with pytest.raises(Fault, match=r"^.+\.$|\?$") as fault:
        commented_run(str(file), policy_for(tmp_path))
    assert fault.value.place is not None


@pytest.mark.corpus
@pytest.mark.timeout(300)
@pytest.mark.parametrize("share", some_of(range(_SHARES), every=_SHARES))
def test_real_files_with_arguments_expand_as_xacro_expands_them(
    share: int, corpus: Path, tmp_path: Path
):
    """Each switch on and off, each choice, and mixtures: grippers, other types, other includes."""
    policy = policy_for(corpus)
    files = [str(path) for path in sorted(corpus.rglob("*.xacro")) if path.is_file()]
    given = [(file, arguments) for file in files for arguments in launches(file, policy)]
    given = given[share::_SHARES]  # of each file some
    texts = StockCommand(tmp_path, policy.packages).batch_with(given)

    def ours(file: str, arguments: Mapping[str, str]) -> Commented | Fault:
        try:
            return commented_run(file, policy, arguments)
        except Fault as fault:
            return fault

    different: list[tuple[str, Mapping[str, str], str]] = []
    for (file, arguments), text in zip(given, texts, strict=True):
        own = ours(file, arguments)
        refused = isinstance(own, Fault)
        if refused != (text is None) or (text and own != commented_xml(text)):
            different.append((file, arguments, str(own) if refused else "is another text"))
    assert not different
    assert sum(text is not None for text in texts) > LAUNCHED_AT_LEAST

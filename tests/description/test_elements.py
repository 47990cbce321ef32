from __future__ import annotations

from xml.etree import ElementTree

import msgspec

from studio.description.elements import Element

LINK = Element(
    "link",
    {"name": "a"},
    (
        Element("visual", {}, (Element("origin", {"xyz": "0 0 1"}),)),
        Element("visual", {"name": '<&">\n'}, ("1 < 2",)),
    ),
)


def test_an_element_is_written_on_one_line():
    assert LINK.xml == (
        '<link name="a"><visual><origin xyz="0 0 1"/></visual>'
        '<visual name="&lt;&amp;&quot;&gt;&#10;">1 &lt; 2</visual></link>'
    )


def test_its_text_reads_back_as_it_is():
    read = ElementTree.fromstring(LINK.xml)
    assert [one.get("name") for one in read] == [None, '<&">\n']
    assert read[1].text == "1 < 2"


def test_children_are_found_by_their_tag():
    first = LINK.find("visual")
    assert first is not None
    assert [one.tag for one in first.elements()] == ["origin"]
    assert len(list(LINK.elements("visual"))) == 2
    assert LINK.find("collision") is None
    assert (LINK.get("name"), LINK.get("type"), LINK.get("type", "x")) == ("a", None, "x")


def test_an_element_crosses_a_pipe_as_it_is():
    packed = msgspec.msgpack.encode(LINK)
    assert msgspec.msgpack.decode(packed, type=Element) == LINK

"""What the top level of a file tells."""

from __future__ import annotations

import pytest

from studio.packages.robot_files import read_outline

XACRO = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'


@pytest.mark.parametrize(
    "declaration",
    [
        XACRO,
        'xmlns:xacro="http://ros.org/wiki/xacro"',
        'xmlns:xacro="http://wiki.ros.org/xacro"',
        'xmlns:x="http://www.ros.org/wiki/xacro"',
    ],
)
def test_xacro_is_told_by_its_declaration(declaration: str):
    assert read_outline(f"<robot {declaration}/>".encode()).is_xacro
    assert not read_outline(b"<robot name='a'><link name='b'/></robot>").is_xacro


@pytest.mark.parametrize(
    ("inside", "content"),
    [
        ("<link name='a'/>", True),
        ("<xacro:wheel/>", True),
        ("<xacro:call macro='wheel'/>", True),
        ("<xacro:if value='1'><link name='a'/></xacro:if>", True),
        (
            "<xacro:unless value='1'><xacro:if value='1'><xacro:arm/></xacro:if></xacro:unless>",
            True,
        ),
        ("<xacro:macro name='m'><link name='a'/><xacro:wheel/></xacro:macro>", False),
        ("<xacro:property name='p'><link name='a'/></xacro:property>", False),
        ("<xacro:property name='p' value='1'/><xacro:arg name='a' default=''/>", False),
        ("<xacro:include filename='a.xacro'/>", False),
        ("<joint name='j'><link name='a'/></joint>", False),
        ("<gazebo/>", False),
        ("", False),
    ],
)
def test_content_is_a_link_or_a_macro_call_at_the_top_outside_macros(inside: str, content: bool):
    outline = read_outline(f"<robot {XACRO}>{inside}</robot>".encode())
    assert outline.has_content is content
    assert outline.error == ""


def test_name_and_includes_are_as_written():
    text = f"""<robot name="$(arg n)" {XACRO}>
      <xacro:if value="1"><xacro:include filename="$(find a)/b.xacro"/></xacro:if>
      <xacro:macro name="m"><xacro:include filename="inner.xacro"/></xacro:macro>
    </robot>"""
    outline = read_outline(text.encode())
    assert outline.name == "$(arg n)"
    assert outline.includes == ["$(find a)/b.xacro"]
    assert outline.defines_macros


def test_a_file_that_is_no_robot_is_known_by_its_first_element():
    assert read_outline(b"<launch><robot/> broken").root == "launch"


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b"", "empty"),
        (b"\xef\xbb\xbf \n", "empty"),
        (b"\x7fELF\0\0", "binary or UTF-16"),
        ("<robot/>".encode("utf-16"), "binary or UTF-16"),
        (b"<robot>", "not well-formed XML"),
        (b"\n<!-- -->\n<?xml version='1.0'?><robot/>", "not well-formed XML"),
        (b"<?xml version='1.0' encoding='no-such'?><robot/>", ""),
        (b"<robot name='\xff'/>", "not well-formed XML"),
        (b"<!DOCTYPE r [<!ENTITY a 'aaa'>]><robot>&a;</robot>", "declares entities"),
        (b"<!DOCTYPE r [<!ENTITY a SYSTEM '/etc/passwd'>]><robot>&a;</robot>", "declares entities"),
    ],
)
def test_what_cannot_be_read_says_why(data: bytes, said: str):
    error = read_outline(data).error
    assert error
    assert said in error


def test_a_latin_1_file_that_says_so_is_read():
    data = "<?xml version='1.0' encoding='iso-8859-1'?><robot name='\xe9'/>".encode("latin-1")
    assert read_outline(data).name == "\xe9"

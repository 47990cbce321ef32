from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from studio.packages.sources.package_xml import PackageXml


def test_elements_have_their_bytes():
    head = "<?xml version='1.0'?>\n<package>\n"
    text = f"{head}  <name> ü </name><a b='>'/><export><c/></export>\n</package>"
    data = text.encode()
    found = PackageXml("package.xml", data)
    assert [data[one.start : one.end].decode() for one in found.elements[1:]] == [
        *("<name> ü </name>", "<a b='>'/>", "<export><c/></export>", "<c/>"),
    ]
    assert (found.elements[1].text, found.elements[1].line) == ("ü", 3)
    assert found.closing == text.encode().index(b"</package>")


@given(st.text("<>/ab='\"&!- \n", max_size=120))
def test_any_text_is_read_as_far_as_it_goes(text: str):
    data = text.encode()
    for one in PackageXml("package.xml", data).elements:
        assert data[one.start : one.start + 1] == b"<"
        assert one.start < one.inner_start <= one.inner_end <= one.end


def test_a_deep_or_wide_file_is_refused():
    deep = PackageXml("package.xml", b"<a>" * 1000)
    wide = PackageXml("package.xml", b"<package>" + b"<a/>" * 100_000 + b"</package>")
    assert "more elements" in deep.fault
    assert "more elements" in wide.fault

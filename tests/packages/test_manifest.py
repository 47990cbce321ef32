"""Names out of manifests."""

from __future__ import annotations

import pytest

from studio.packages.manifest import SIZE_LIMIT_BYTES, package_name


@pytest.mark.parametrize(
    "manifest",
    [
        b"<package><name>rover_2-x.y</name></package>",
        b'<?xml version="1.0"?>\n<package format="3">\n<a>1</a><name> rover_2-x.y\n</name>',
        b"\xef\xbb\xbf<package><!-- <name>no</name> --><name a='b'>rover_2-x.y</name ></package>",
        b"<package><export><name>no</name></export><name>rover_2-x.y</name><broken",
        "<package><name>rover_2-x.y</name></package>".encode("utf-16"),
    ],
)
def test_the_name_is_found(manifest: bytes):
    assert package_name(manifest) == "rover_2-x.y"


@pytest.mark.parametrize(
    "manifest",
    [
        b"",
        b"<package/>",
        b"no xml at all",
        b"<package><name></name></package>",
        b"<package><name>a b</name></package>",
        b"<package><!-- <name>hidden</name> --></package>",
        b"<other><name>rover</name></other>",
        b"<package><name>" + b"x" * 300 + b"</name></package>",
        b"<package><name>../../etc</name></package>",
        b"<package><name>&lt;b&gt;</name></package>",
        "<package><name>r\xf6ver</name></package>".encode(),
        b"<!DOCTYPE p [<!ENTITY a 'rover'>]><package><name>&a;</name></package>",
        b"<package><export><name>rover</name></export></package>",
    ],
)
def test_a_manifest_without_a_proper_name_has_none(manifest: bytes):
    assert package_name(manifest) is None


@pytest.mark.parametrize(
    "piece", [b"<!--", b"<package ", b"<name>", b"<package><name", b"<package>", b"<package><name>"]
)
def test_a_manifest_made_to_be_slow_is_not(piece: bytes):
    assert package_name(piece * (SIZE_LIMIT_BYTES // len(piece))) is None

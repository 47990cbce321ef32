from __future__ import annotations

import pytest

from studio.ros.wire.versions import version_number


@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("v1.8.0-2687c51 built with rustc 1.95.0", "1.8.0"),
        ("v1.8.0 built with rustc-1.95.0", "1.8.0"),
        ("v1.10.0-modified", "1.10.0"),
        ("1.2.1", "1.2.1"),
        ("", ""),
        ("v", ""),
        ("v<b>", ""),
        ("v\u0661", ""),
        ("v" * 99, ""),
    ],
)
def test_a_version_is_its_number(text: str, number: str):
    assert version_number(text) == number

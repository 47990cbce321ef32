"""The name of a package, from the bytes of its package.xml."""

from __future__ import annotations

import re
from typing import Final

FILE_NAME: Final = "package.xml"
SIZE_LIMIT_BYTES: Final = 1 << 20

_COMMENT: Final = re.compile(rb"<!--.*?-->", re.DOTALL)
_NAME: Final = re.compile(
    rb"<package\b[^>]*>.*?<name\b[^>]*>\s*([\w.-]{1,200})\s*</name\s*>", re.DOTALL
)


def package_name(manifest: bytes) -> str | None:
    """Find the name; None when there is none of letters, digits, `_`, `-` and `.`.

    No XML parser: a manifest is hostile until shown otherwise, and there are hundreds of them.
    """
    found = _NAME.search(_COMMENT.sub(b"", manifest))
    return found[1].decode("ascii", "replace") if found else None

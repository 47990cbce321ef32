"""Git LFS pointers: small texts that stand where a large file has not been fetched."""

from __future__ import annotations

from typing import Final

LFS_REASON: Final = (
    'is a Git LFS pointer: its content was not fetched, run "git lfs pull" in the repository.'
)
_BEGINNING: Final = b"version https://git-lfs.github.com/spec/"
_LENGTH_LIMIT: Final = 1024
"""Source: the specification of Git LFS, docs/spec.md."""


def is_lfs_pointer(data: bytes) -> bool:
    """Whether a file's whole content is a pointer."""
    return len(data) < _LENGTH_LIMIT and data.startswith(_BEGINNING)

"""Texts of message, service and action types that ROS 2 systems use, to be had by full name."""

from __future__ import annotations

from pathlib import Path

_FOLDER = Path(__file__).resolve().parent
KINDS = ("msg", "srv", "action")


def carried_texts() -> dict[str, str]:
    """Read every text that the studio carries, by the full name of its type."""
    return {
        f"{path.parts[-3]}/{path.parts[-2]}/{path.stem}": path.read_text(encoding="utf-8")
        for kind in KINDS
        for path in sorted(_FOLDER.glob(f"*/{kind}/*.{kind}"))
    }

"""Xacro text in, URDF parts with their origins out; the only room that imports xacro.

The names below are the library's face; each module is imported when one of its names is first
used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from studio.description.client import DescriptionWorker
    from studio.description.elements import Element
    from studio.description.evaluator.stock_xacro import export_urdf
    from studio.description.session import Session, open_session
    from studio.description.urdf import urdf_text
    from studio.description.values import (
        ArgumentsRequest,
        Edit,
        EditRequest,
        Expansion,
        Failure,
        OpenRequest,
        Part,
        ReadPolicy,
        ReloadRequest,
        Site,
        SiteKind,
        Span,
        VerifyRequest,
        Widget,
        WidgetKind,
    )
    from studio.description.xacro_file import XacroFile

_NAMES = {
    "client": ("DescriptionWorker",),
    "elements": ("Element",),
    "evaluator.stock_xacro": ("export_urdf",),
    "session": ("Session", "open_session"),
    "urdf": ("urdf_text",),
    "values": (
        "ArgumentsRequest", "Edit", "EditRequest", "Expansion", "Failure", "OpenRequest", "Part",
        "ReadPolicy", "ReloadRequest", "Site", "SiteKind", "Span", "VerifyRequest", "Widget",
        "WidgetKind",
    ),
    "xacro_file": ("XacroFile",),
}  # fmt: skip
_MODULE_OF = {name: module for module, names in _NAMES.items() for name in names}

__all__ = [
    "ArgumentsRequest", "DescriptionWorker", "Edit", "EditRequest", "Element", "Expansion",
    "Failure", "OpenRequest", "Part", "ReadPolicy", "ReloadRequest", "Session", "Site", "SiteKind",
    "Span", "VerifyRequest", "Widget", "WidgetKind", "XacroFile", "export_urdf", "open_session",
    "urdf_text",
]  # fmt: skip


def __getattr__(name: str) -> Any:  # noqa: ANN401
    module = _MODULE_OF.get(name)
    if module is None:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    found = getattr(import_module(f"{__name__}.{module}"), name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return sorted(__all__)

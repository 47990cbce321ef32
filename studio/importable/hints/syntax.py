"""A file that is no Python: what its author sees to, beside what Python says of the line."""

from __future__ import annotations

from studio.importable.hints.said import place_of


def syntax_hint(error: SyntaxError) -> str | None:
    """Return a sentence about a file that cannot be read as Python; None: it names no file.

    Args:
        error: What ended the program.
    """
    if not error.filename or error.lineno is None or error.filename.startswith("<"):
        return None
    at = place_of(error.filename, error.lineno)
    if isinstance(error, TabError):
        return f"{at}: indent every line with spaces, four a level, and none with tabs."
    if isinstance(error, IndentationError):
        return (
            f"{at}: the indentation of the lines is not as Python needs it, as after copying from "
            "a slide or a PDF: indent what belongs to a class, def, if or loop by four spaces."
        )
    return f"{at} is no Python, so nothing of the file was run: mend that line or the one above it."

"""The tree of errors, as the file's head shows it to a reader."""

from __future__ import annotations

import inspect

from studio import errors


def shown_parents() -> dict[str, str]:
    """Return by name the parent that the tree at the head of the file shows."""
    found: dict[str, str] = {}
    above: list[tuple[int, str]] = []
    for line in (inspect.getdoc(errors) or "").splitlines():
        name = line.strip()
        if not hasattr(errors, name) or not name:
            continue
        indent = len(line) - len(line.lstrip())
        above = [row for row in above if row[0] < indent]
        found[name] = above[-1][1] if above else "Exception"
        above.append((indent, name))
    return found


def test_the_tree_at_the_head_shows_every_error_below_its_parent():
    kinds = [
        one
        for one in vars(errors).values()
        if inspect.isclass(one) and issubclass(one, Exception) and one.__module__ == errors.__name__
    ]
    assert shown_parents() == {one.__name__: one.__bases__[0].__name__ for one in kinds}

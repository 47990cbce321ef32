"""`studio pkg check`: say what would fail when packages are built or run; exit code 1: errors."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from studio.cli.commands.pkg.inspect import found_packages, what_is_known
from studio.cli.terminal import harmless
from studio.problems import Severity

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterator, Sequence

    from studio.cli.verbs import Verbs
    from studio.packages.roots import ServedRoots
    from studio.problems import Problem

_ROUNDS_MAX = 20


def add(verbs: Verbs) -> None:
    """Add the verb and its options."""
    parser = verbs.add(
        "check",
        _check,
        "say what would fail when packages are built or run",
        "\nNothing is built or run. Robots are checked by studio check.\n",
    )
    parser.add_argument(
        "folder", metavar="DIR", nargs="?", type=Path, help="the workspace, or a package"
    )
    parser.add_argument("--json", action="store_true", help="print a JSON list of the findings")
    parser.add_argument("--why", action="store_true", help="say of each why it matters")
    parser.add_argument("--fix", action="store_true", help="make the safe changes first")


def _check(options: argparse.Namespace) -> int:
    from studio.packages.lint.package_checks import check_packages

    known = what_is_known()
    found = found_packages(options.folder)
    problems = check_packages(found, known)
    mended = 0
    while options.fix and mended < _ROUNDS_MAX and _mend(problems, found.roots):
        mended += 1
        found = found_packages(options.folder)
        problems = check_packages(found, known)
    if options.json:
        import msgspec

        print(msgspec.json.format(msgspec.json.encode(problems)).decode())
    else:
        print(*map(harmless, _lines(problems, why=options.why)), sep="\n")
    return int(any(one.severity is Severity.ERROR for one in problems))


def _mend(problems: Sequence[Problem], roots: ServedRoots) -> bool:
    """Make the first change for each file, and return whether there was one.

    One of a file at a time: what is left is found anew, at its new place.
    """
    from studio.packages.edits.package_edit import PackageEdit
    from studio.packages.edits.writing import write_edit

    taken: set[str] = set()
    for one in problems:
        fix = one.fix
        files = (
            {edit.file for edit in fix.edits} | {new.file for new in fix.new_files} if fix else None
        )
        if fix is None or not files or files & taken:
            continue
        taken |= files
        write_edit(PackageEdit(fix.label, "", fix.new_files, fix.edits), roots)
        print(harmless(f"{_shown(one)}: {fix.label}"))
    return bool(taken)


def _shown(one: Problem) -> str:
    if one.place is None:
        return ""
    file = os.path.relpath(one.place.file) if Path(one.place.file).is_absolute() else one.place.file
    line = f":{one.place.line}" if one.place.line else ""
    return f"{file}{line}"


def _lines(problems: Sequence[Problem], *, why: bool) -> Iterator[str]:
    if why:
        from studio.packages import lint
        from studio.problems import whys

        reasons = whys(lint)
    else:
        reasons = {}
    for one in problems:
        mend = f" [{one.fix.label}]" if one.fix else ""
        yield f"{_shown(one)}: {one.severity}: {one.sentence}{mend}"
        if one.code in reasons:
            yield f"    {reasons[one.code]['en']}"
    counts = {kind: sum(one.severity is kind for one in problems) for kind in Severity}
    said = [f"{n} {kind}{'s' * (n > 1)}" for kind, n in counts.items() if n]
    yield ", ".join(said) if said else "Nothing is wrong."

"""`studio doctor`: look for what keeps nodes apart."""

from __future__ import annotations

import argparse
import json
import math
import platform
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Final

import studio
from studio.cli.graph import settle
from studio.cli.terminal import harmless
from studio.cli.wire import add_wire_options, opened_wire
from studio.errors import NoRouterError, SettingsError
from studio.ros.names import is_hidden

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.live.doctor.examination import Examination
    from studio.live.doctor.seen import Ends, Seen, System
    from studio.protocol.doctor import Finding
    from studio.ros.graph.endpoints import GraphNode


_Section = tuple[str, list[tuple[str, object]]]
_KINDS: Final = {"qos": "QoS", "foreign-hash": "hash"}
"""Findings that are called otherwise than by their code."""
_BELOW: Final = ""
"""Name of a row that goes on with the one above it."""
_NOBODY: Final = frozenset({"no-nodes", "other-domain", "bridge-empty", "bridge-domain"})
"""That nobody is there is no fault."""
_NOT_JOINED: Final = 2
"""As of every verb that joins no router."""
_LISTENS_S: Final = 2.0
_LISTENS_MAX_S: Final = 3_600.0
_LOOK_EVERY_S: Final = 1.0


def add(parser: argparse.ArgumentParser) -> None:
    """Add the options of `doctor` to the parser."""
    parser.description = "Look for what keeps nodes apart; exit code 1 when something does."
    parser.add_argument("-r", "--report", action="store_true", help="print all, also what is well")
    parser.add_argument(
        "-rf", "--report-failed", action="store_true", help="print only what is not well"
    )
    parser.add_argument(
        "-iw", "--include-warnings", action="store_true", help="as is: warnings are shown"
    )
    parser.add_argument("verb", nargs="?", choices=["hello"], help="as is: whether all can be met")
    parser.add_argument(
        "--listen", type=_seconds, default=_LISTENS_S, metavar="SECONDS",
        help=f"listen to topics for so long (default: {_LISTENS_S:g}); 0: look at the graph only",
    )  # fmt: skip
    parser.add_argument(
        "--html", type=Path, metavar="FILE", help="write the report as one HTML file, to be sent"
    )
    parser.add_argument("--json", action="store_true", help="print all findings as JSON")
    add_wire_options(parser)
    parser.set_defaults(run=_run)


def _seconds(text: str) -> float:
    seconds = float(text)
    if not 0 <= seconds <= _LISTENS_MAX_S or math.isnan(seconds):
        raise argparse.ArgumentTypeError(f"{text} is no time from 0 to {_LISTENS_MAX_S:g} s")
    return seconds


def _run(options: argparse.Namespace) -> int:
    from studio.live.doctor.examination import examine

    try:
        seen = _seen(options)
    except NoRouterError:
        if options.html is None and not options.json:
            raise
        seen = _seen_without_router(options)
    found = examine(seen)
    if options.html is not None:
        _write_html(options.html, seen, found)
    if options.json:
        print(json.dumps(_as_json(seen, found), indent=2))
    elif options.report:
        _print_sections([*_sections(seen), *_finding_sections(found, notes=True)])
    elif options.report_failed:
        _print_sections(_finding_sections(found, notes=False))
    else:
        _print_verdict(seen, found)
    if seen.system is None:
        return _NOT_JOINED
    return 1 if any(map(_is_fault, found.findings)) else 0


def _seen(options: argparse.Namespace) -> Seen:
    """Join, look, ask and listen.

    Raises:
        NoRouterError: None answers.
    """
    from studio.live.doctor.asking import ask, look, look_here
    from studio.live.doctor.seen import Seen
    from studio.live.doctor.watching import Watching
    from studio.ros.graph.diagnosis import DistroHashes
    from studio.ros.node.context import Context

    with opened_wire(options) as wire:
        context = Context.over(wire)
        try:
            settle(context.graph, options)
            own, hashes = frozenset({wire.zid}), DistroHashes(wire.types)

            def looked() -> System:
                return look(wire, context.graph, wire.types, hashes, own=own)

            watching = Watching(context, wire.types) if options.listen else None
            heard = watching.heard(looked()) if watching is not None else None
            answers = ask(wire, looked())
            has_sound = heard is not None and any(one.pace for one in heard.topics.values())
            end_s = time.monotonic() + (options.listen if has_sound else 0)
            while watching is not None and (left_s := end_s - time.monotonic()) > 0:
                time.sleep(min(left_s, _LOOK_EVERY_S))
                watching.heard(looked())
            system = looked()
            heard = watching.heard(system) if watching is not None else None
        finally:
            context.shutdown()
    return Seen(here=look_here(), system=system, heard=heard, answers=answers)


def _seen_without_router(options: argparse.Namespace) -> Seen:
    """Look at the place where a router should be."""
    from studio.live.connection.report import examine
    from studio.live.doctor.asking import look_here
    from studio.live.doctor.seen import Seen
    from studio.settings import WireChoice

    choice = WireChoice("off", tuple(options.connect), options.domain, options.distro or "")
    return Seen(here=look_here(), place=examine(choice, ()))


def _is_fault(finding: Finding) -> bool:
    return finding.level != "note" and finding.code not in _NOBODY


def _kind(finding: Finding) -> str:
    return _KINDS.get(finding.code, finding.code.replace("-", " "))


def _why_and_how(finding: Finding) -> tuple[str, ...]:
    """Return what it is concluded from, and the line for a terminal that mends it or shows more."""
    return (*finding.evidence, f"$ {finding.line}") if finding.line else finding.evidence


def _print_verdict(seen: Seen, found: Examination) -> None:
    faults = [one for one in found.findings if one.level != "note"]
    for one in faults:
        sentence = harmless(one.sentence)
        print(sentence if one.code in _NOBODY else f"{_kind(one)}: {sentence}")
        for line in _why_and_how(one):
            print(f"    {harmless(line)}")
    if not faults and seen.system is not None:
        system = seen.system
        topics = [name for name in system.topics if not is_hidden(name)]
        print(f"All is well: {len(system.nodes)} nodes, {len(topics)} topics.")


def _finding_sections(found: Examination, *, notes: bool) -> list[_Section]:
    rows: list[tuple[str, object]] = []
    for one in found.findings:
        if notes or one.level != "note":
            rows.append((_kind(one), one.sentence))
            rows += [(_BELOW, line) for line in _why_and_how(one)]
    if found.more:
        rows.append(("more", f"{found.more} findings like these"))
    is_well = all(one.level == "note" for one in found.findings)
    well: list[tuple[str, object]] = [("none", "all is well")] if is_well else []
    return [("FINDINGS", [*well, *rows])]


def _sections(seen: Seen) -> list[_Section]:
    system = seen.system
    if system is None:
        return []
    answers = seen.answers
    versions = sorted(set(answers.routers.values())) if answers else []
    bridges = [("BRIDGES TO DDS", [*_bridges(system)])] if system.bridges else []
    return [
        (
            "PLATFORM INFORMATION",
            [
                ("system", platform.platform()),
                ("python", sys.version.split()[0]),
                ("studio", studio.__version__),
            ],
        ),
        ("NETWORK CONFIGURATION", [*_interfaces(seen)]),
        (
            "RMW MIDDLEWARE",
            [
                ("middleware name", "rmw_zenoh's wire, spoken by the studio"),
                ("distribution", system.profile.distro),
                ("router", system.endpoint or "of the configuration"),
                ("router's Zenoh", ", ".join(versions) or "unknown"),
                ("domain", system.domain),
                ("session", next(iter(system.own))),
            ],
        ),
        *bridges,
        ("NODE LIST", [(node.path, _place(node)) for node in system.nodes]),
        ("TOPIC LIST", [(name, _topic(ends)) for name, ends in system.topics.items()]),
        (
            "SERVICE LIST",
            [
                (name, f"{_types(ends)}, servers {len(ends.senders)}")
                for name, ends in system.services.items()
                if ends.senders
            ],
        ),
        ("LISTENED TO", [*_listened(seen)]),
    ]


def _interfaces(seen: Seen) -> list[tuple[str, object]]:
    def said(known: bool | None, yes: str, no: str) -> str:  # noqa: FBT001 - as it is known
        return "unknown" if known is None else yes if known else no

    return [
        (one.name, f"{said(one.is_up, 'up', 'down')}, "
         f"{said(one.has_multicast, 'multicast', 'no multicast')} (DDS needs it, rmw_zenoh not)")
        for one in seen.here.interfaces
    ]  # fmt: skip


def _bridges(system: System) -> Iterator[tuple[str, object]]:
    """Say of each bridge what it tells of itself, a line each."""
    for one in system.bridges:
        settings, nodes = one.settings, f"nodes {len(one.nodes)}"
        version = f"version {one.version or 'unknown'}"
        domain = f"domain {settings.domain}" if settings else "domain unknown"
        yield one.name, f"{version}, {domain}, {nodes}, session {one.zid}"
        if settings is not None and settings.localhost_only:
            yield _BELOW, "it meets only nodes of its own machine"
        if one.rules is not None:
            word = "allow" if one.rules.allows else "deny"
            yield from ((_BELOW, f"{word} {text}") for text in one.rules.texts())
        for topic, rate in settings.slowed if settings else ():
            yield _BELOW, f"at most {rate:g} a second of {topic}"


def _place(node: GraphNode) -> str:
    return f"behind {node.bridge}" if node.bridge else f"session {node.zid}"


def _listened(seen: Seen) -> list[tuple[str, object]]:
    if seen.heard is None:
        return []
    return [
        (name, f"{one.samples} samples" + (f", {one.pace.usual_hz:.1f} Hz" if one.pace else ""))
        for name, one in seen.heard.topics.items()
    ]


def _types(ends: Ends) -> str:
    return ", ".join(sorted({one.type_name for one in (*ends.senders, *ends.receivers)}))


def _topic(ends: Ends) -> str:
    return f"{_types(ends)}, publishers {len(ends.senders)}, subscribers {len(ends.receivers)}"


def _print_sections(sections: list[_Section]) -> None:
    """Print as `ros2 doctor --report` does: a title in capitals, names in one column."""
    for title, rows in sections:
        print(f"\n   {title}")
        width = max((len(name) for name, _ in rows), default=0)
        for name, value in rows:
            sign = "     " if name == _BELOW else " : "
            print(f"{harmless(name):<{width}}{sign}{harmless(str(value))}")


def _as_json(seen: Seen, found: Examination) -> dict[str, object]:
    from studio.live.doctor.report import facts_of

    return {
        "facts": dict(facts_of(seen)),
        "findings": [one.model_dump(exclude={"mend"}) for one in found.findings],
        "more": found.more,
        "subjects": [one.model_dump() for one in found.subjects],
    }


def _write_html(file: Path, seen: Seen, found: Examination) -> None:
    from studio.files import write_whole
    from studio.live.doctor.report import report_of

    try:
        write_whole(file, report_of(seen, found, "en").encode())
    except OSError as error:
        raise SettingsError(f"{file} cannot be written: {error.strerror}.") from error
    print(f"Report: {file}", file=sys.stderr)

"""The ROS domain: nodes of another one are not seen, though they are at the same router."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.live.doctor.seen import Looked
from studio.live.doctor.subjects.router import CONNECTION
from studio.protocol.displays import Mend
from studio.protocol.doctor import Finding
from studio.ros.graph.diagnosis import why_nobody

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from studio.live.doctor.seen import Seen, System
    from studio.protocol.doctor import SubjectName

SUBJECT: Final[SubjectName] = "domain"


def looked_at(seen: Seen) -> Looked | None:
    """The domains that have nodes."""
    counts = _counts(seen)
    if counts is None:
        return None
    return Looked(len(counts), ", ".join(_of_domain(*one) for one in list(counts.items())[:8]))


def findings(seen: Seen) -> Iterator[Finding]:
    """Find nodes of other domains, and why no node is in this one."""
    counts = _counts(seen)
    if counts is None or (seen.answers and seen.answers.unseen):
        return
    endpoint, domain = _place(seen)
    others = {one: many for one, many in counts.items() if one != domain}
    there = tuple(_of_domain(*one) for one in list(counts.items())[:8])
    evidence = there or (f"no node in any domain at {endpoint or 'the configured address'}",)
    if sentence := _why_nobody(seen.system, endpoint, domain, counts):
        target = min(others) if others else None
        yield Finding(
            code="other-domain" if others else "no-nodes",
            level="warn",
            subject=SUBJECT,
            sentence=sentence,
            evidence=evidence,
            mend=_join(target),
            line="" if target is None else f"export ROS_DOMAIN_ID={target}",
            about=(CONNECTION,),
        )
    elif others:
        yield Finding(
            code="more-domains",
            level="note",
            subject=SUBJECT,
            sentence=(
                f"Other domains have nodes, too, which domain {domain} does not see: "
                f"{', '.join(_of_domain(*one) for one in list(others.items())[:6])}."
            ),
            evidence=evidence,
            about=(CONNECTION,),
        )
    named = seen.here.variables.get("ROS_DOMAIN_ID", "")
    if named.isdigit() and int(named) != domain:
        yield Finding(
            code="other-domain-here",
            level="note",
            subject=SUBJECT,
            sentence=(
                f"ROS_DOMAIN_ID is {named[:12]} where the studio was started, and it looks at "
                f"domain {domain}: nodes that are started there are in domain {named[:12]}."
            ),
            evidence=(f"ROS_DOMAIN_ID={named[:12]}", f"the studio is in domain {domain}"),
            line=f"export ROS_DOMAIN_ID={domain}",
            about=(CONNECTION,),
        )


def _why_nobody(
    system: System | None, endpoint: str, domain: int, counts: Mapping[int, int]
) -> str | None:
    if system is not None and (system.others or not system.is_connected):
        return None
    others = any(count for one, count in counts.items() if one != domain)
    if system is not None and not others and any(one.is_used for one in system.bridges):
        return None  # why no node is behind it, its own subject says
    return why_nobody(endpoint or "the configured address", domain, counts)


def _join(domain: int | None) -> Mend | None:
    if domain is None:
        return None
    command: dict[str, bool | int | float | str] = {"type": "connect_wire", "domain": domain}
    return Mend(label=f"Join domain {domain}", command=command)


def _counts(seen: Seen) -> Mapping[int, int] | None:
    if seen.answers is not None and seen.system is not None:
        return seen.answers.nodes_by_domain
    if seen.place is None or seen.place.verdict in {"no_router", "foreign", "not_admitted"}:
        return None
    return {one.domain: one.nodes for one in seen.place.domains}


def _place(seen: Seen) -> tuple[str, int]:
    if seen.system is not None:
        return seen.system.endpoint, seen.system.domain
    return (seen.place.endpoint, seen.place.domain) if seen.place else ("", 0)


def _of_domain(domain: int, nodes: int) -> str:
    return f"domain {domain}: {nodes} {'node' if nodes == 1 else 'nodes'}"

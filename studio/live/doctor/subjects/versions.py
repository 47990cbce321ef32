"""Versions: of the studio, of the routers' Zenoh, and of rmw_zenoh by what its samples carry."""

from __future__ import annotations

import platform
from typing import TYPE_CHECKING, Final

import studio
from studio.live.doctor.seen import Looked, listed, short
from studio.live.doctor.subjects.router import CONNECTION, routers_alone
from studio.protocol.doctor import Concern, Finding

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from studio.live.doctor.seen import Answers, Seen
    from studio.protocol.doctor import SubjectName

SUBJECT: Final[SubjectName] = "versions"


def looked_at(seen: Seen) -> Looked:
    """All versions that are known."""
    known = [f"studio {studio.__version__}", f"Python {platform.python_version()}"]
    if seen.answers:
        known += [f"router's Zenoh {one}" for one in sorted(set(routers_alone(seen).values()))]
        known += [f"nodes' Zenoh {one}" for one in sorted(set(seen.answers.sessions.values()))]
    bridges = seen.system.bridges if seen.system else ()
    known += sorted({f"bridge to DDS {one.version}" for one in bridges if one.version})
    return Looked(len(known), ", ".join(known))


def findings(seen: Seen) -> Iterator[Finding]:
    """Find versions that do not go together."""
    if seen.answers is not None:
        yield from _of_zenoh(seen.answers, routers_alone(seen))
    for one in seen.heard.topics.values() if seen.heard else ():
        if one.not_understood:
            yield Finding(
                code="old-rmw",
                level="error",
                subject=SUBJECT,
                sentence=(
                    f"Samples on {short(one.topic)} ({one.not_understood} so far) have no "
                    "attachment of rmw_zenoh as it is now: bring rmw_zenoh_cpp of their sender up "
                    "to date (0.1.2 for Humble, 0.2.4 for Jazzy), for nobody else hears it either."
                ),
                evidence=(
                    f"{one.not_understood} of {one.samples + one.not_understood} samples in "
                    f"{one.listened_s:.0f} s have an attachment of another form",
                ),
                about=(Concern(kind="topic", name=one.topic),),
            )


def _of_zenoh(answers: Answers, alone: Mapping[str, str]) -> Iterator[Finding]:
    routers = sorted(set(answers.routers.values()))
    sessions = sorted(set(answers.sessions.values()))
    majors = {one.partition(".")[0] for one in (*routers, *sessions)}
    if len(majors) > 1:
        yield Finding(
            code="zenoh-versions",
            level="error",
            subject=SUBJECT,
            sentence=(
                f"Routers have Zenoh {listed(routers)} and nodes {listed(sessions)}, which do not "
                "understand each other: use the rmw_zenoh of one distribution everywhere."
            ),
            evidence=(
                *(f"router {zid}: Zenoh {one}" for zid, one in list(answers.routers.items())[:4]),
                *(f"process {zid}: Zenoh {one}" for zid, one in list(answers.sessions.items())[:6]),
            ),
            about=(CONNECTION,),
        )
    elif len(set(alone.values())) > 1:
        yield Finding(
            code="router-versions",
            level="note",
            subject=SUBJECT,
            sentence=(
                "The routers have different versions of Zenoh: "
                f"{listed(sorted(set(alone.values())))}."
            ),
            evidence=tuple(f"{zid}: {version}" for zid, version in list(alone.items())[:8]),
            about=(CONNECTION,),
        )

"""The distribution of ROS 2: whoever has types in another form is not heard."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.live.doctor.seen import Looked, short
from studio.live.doctor.subjects.router import CONNECTION
from studio.protocol.displays import Mend
from studio.protocol.doctor import Concern, Finding
from studio.ros.graph.diagnosis import foreign_hashes, why_not_received

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.live.doctor.seen import Seen, System
    from studio.protocol.doctor import SubjectName
    from studio.ros.graph.diagnosis import ForeignHashes
    from studio.ros.graph.endpoints import GraphEndpoint

SUBJECT: Final[SubjectName] = "distribution"
_FORMS_MAX: Final = 400
"""So many forms of types are compared with every distribution: it is slow."""
_ENDS_MAX: Final = 8


def looked_at(seen: Seen) -> Looked | None:
    """The forms of types, and the distribution that is spoken."""
    if seen.system is None or not seen.system.others:
        return None
    return Looked(len(_forms(seen.system)), seen.system.profile.distro)


def findings(seen: Seen) -> Iterator[Finding]:
    """Find types that others have as of another distribution, or in no form that is known."""
    if seen.system is None:
        return
    system, forms = seen.system, _forms(seen.system)
    for found in foreign_hashes(forms.values(), system.profile, system.hash_of):
        ends = [one for form, one in forms.items() if form[0] in found.types]
        yield Finding(
            code="foreign-hash",
            level="error",
            subject=SUBJECT,
            sentence=why_not_received(found, system.profile),
            evidence=tuple(
                f"{short(one.node.path)}: {short(one.type_name)} {one.type_hash[:15]}, here "
                f"{(system.hash_of(system.profile.distro, one.type_name) or '')[:15]}"
                for one in ends[:_ENDS_MAX]
            ),
            mend=_speak(found),
            about=(CONNECTION, *(Concern(kind="topic", name=one.name) for one in ends[:3])),
        )


def _speak(found: ForeignHashes) -> Mend | None:
    if not found.distros:
        return None
    distro = found.distros[0]
    command: dict[str, bool | int | float | str] = {"type": "connect_wire", "distro": distro}
    return Mend(label=f"Speak {distro}", command=command)


def _forms(system: System) -> dict[tuple[str, str], GraphEndpoint]:
    """Return one endpoint for each form of a type, of others and first those of topics."""
    forms: dict[tuple[str, str], GraphEndpoint] = {}
    for ends in (*system.topics.values(), *system.services.values()):
        for one in (*ends.senders, *ends.receivers):
            if len(forms) >= _FORMS_MAX:
                return forms
            if not _is_as_here(one, system):
                forms.setdefault((one.type_name, one.type_hash), one)
    return forms


def _is_as_here(end: GraphEndpoint, system: System) -> bool:
    """Whether a node on DDS tells no form of a type, or the one that is known here.

    Where keys hold no form, as of Humble, what comes from DDS is read all the same.
    """
    if not end.node.bridge:
        return False
    return end.type_hash in {"", system.form_of(system.profile.distro, end.type_name)}

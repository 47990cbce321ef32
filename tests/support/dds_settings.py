"""Settings of Cyclone DDS for all who meet on a loopback interface, which has no multicast."""

from __future__ import annotations

from typing import Final

LEASE_S: Final = 10.0
"""After this, who was killed is missed; it is what Cyclone DDS takes by itself."""
_SETTINGS: Final = (
    "<CycloneDDS><Domain><General>"
    '<Interfaces><NetworkInterface name="lo"/></Interfaces>'
    "<AllowMulticast>false</AllowMulticast></General>"
    "<Discovery><ParticipantIndex>auto</ParticipantIndex>"
    "<MaxAutoParticipantIndex>24</MaxAutoParticipantIndex>"
    "<LeaseDuration>{lease_ms:.0f} ms</LeaseDuration>"
    '<Peers><Peer address="127.0.0.1"/></Peers></Discovery>'
    "</Domain></CycloneDDS>"
)


def loopback(lease_s: float = LEASE_S) -> str:
    """The value of CYCLONEDDS_URI."""
    return _SETTINGS.format(lease_ms=lease_s * 1000)

"""Encode once, keep the last per key, a byte gate per client; pure: bytes and a Transport."""

from studio.hub.hub import Hub
from studio.hub.outlet import GATE_BYTES, QUEUE_BYTES, Outlet, Transport

__all__ = ["GATE_BYTES", "QUEUE_BYTES", "Hub", "Outlet", "Transport"]

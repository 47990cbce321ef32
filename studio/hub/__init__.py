"""Encode once, keep the last per key, a byte gate per client; pure: bytes and a Transport."""

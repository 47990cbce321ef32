"""Relays: a studio's room on more than one machine, carried by Zenoh.

The studio that owns the room, the origin, dials out to each relay (`origin.py`, an `Uplink` each). A
relay serves browsers with the routes and lanes of `studio.server`, and a `Room` in the engine's place.
Between them goes one sealed stream of numbered messages each way (`messages.py`, `line.py`).
"""

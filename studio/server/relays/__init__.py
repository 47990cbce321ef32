"""Relays: a studio's room on more than one machine, carried by Zenoh.

The studio that owns the room, the origin, dials out to each relay (`origin.py`, by an `Uplink`).
A relay serves browsers with the routes and lanes of `studio.server`, and has a `Room` in the place
of the engine. Between them goes one sealed stream of numbered messages each way (`line.py`,
`messages.py`).
"""

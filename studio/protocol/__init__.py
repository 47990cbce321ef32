"""The messages between page and studio: commands, events and the data lane, a file per subject.

One set of models serves the websockets' parser, OpenAPI and `types/wire.d.ts`. A command carries
`request`, which its `done` or `refused` repeats, and `document`, the id of the open document it
is for.
"""

from studio.protocol.message import Command, Event, Message

__all__ = ["Command", "Event", "Message"]

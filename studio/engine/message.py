"""The base of every message between page and studio: frozen, and nothing unknown in it."""

from pydantic import BaseModel, ConfigDict


class Message(BaseModel):
    """One message; unknown fields are refused."""

    model_config = ConfigDict(frozen=True, extra="forbid")

"""What is kept of students' own nodes, within the record of the class."""

from __future__ import annotations

from pydantic import BaseModel, ConfigDict, Field


class NodesRecord(BaseModel):
    """What the pool is made from, and who has which domain; without a secret, access is off."""

    model_config = ConfigDict(frozen=True, extra="ignore")

    secret: str = Field(default="", pattern=r"^([0-9a-f]{64})?$")
    domains: tuple[int, ...] = ()
    port: int = 0
    given: dict[str, int] = Field(default_factory=dict)
    """The domains, by person."""
    revoked: tuple[int, ...] = ()
    """Domains of those who were sent out."""

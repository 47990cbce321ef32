"""What the robot worker is asked and answers."""

from __future__ import annotations

from dataclasses import dataclass

from studio.problems import Problem  # noqa: TC001 - msgspec reads it
from studio.workers import Codec


@dataclass(frozen=True, slots=True)
class MeshRequest:
    """Read a mesh and put it into the cache."""

    path: str
    roots: tuple[str, ...]
    cache_folder: str
    shape: str = ""
    """For an image: the primitive that it is put on; empty for a mesh file."""


@dataclass(frozen=True, slots=True)
class MeshAnswer:
    """The mesh as `mesh_blob` packs it; empty when it lies in the cache under `name`."""

    name: str
    blob: bytes


@dataclass(frozen=True, slots=True)
class MeshFault:
    """Why a mesh cannot be shown; `kind` is the class name of the error."""

    kind: str
    subject: str
    reason: str


@dataclass(frozen=True, slots=True)
class CheckRequest:
    """Parse and validate an expanded URDF."""

    urdf: str


@dataclass(frozen=True, slots=True)
class CheckAnswer:
    """What yourdfpy makes of a URDF; the names are empty when it cannot read it at all."""

    links: tuple[str, ...]
    actuated_joints: tuple[str, ...]
    base_link: str
    problems: tuple[Problem, ...]


def robot_codec() -> Codec:
    """The codec of both ends of the robot worker's pipe."""
    return Codec(MeshRequest, MeshAnswer, MeshFault, CheckRequest, CheckAnswer)

"""What a page shows of the robot's mechanics: frames of joints, masses of links."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Final

from studio.errors import PackageError, RobotError, WorkerError
from studio.protocol.commands import Commands, Scope
from studio.protocol.robot import Frames, GetFrames, GetMasses, LinkMassView, Masses, VolumeView
from studio.robot.masses import link_mass
from studio.robot.measures import mesh_volume, shapes_volume
from studio.robot.values import Mesh

if TYPE_CHECKING:
    from collections.abc import Iterable

    from studio.documents.model import Model
    from studio.documents.workspace import Workspace
    from studio.robot.masses import LinkMass
    from studio.robot.measures import MeshVolumes, Volume
    from studio.robot.meshes.library import MeshLibrary
    from studio.robot.values import Link, Robot


_KEPT: Final = 2_000
"""Volumes of meshes."""


class Inspection:
    """Answers from the robot; meshes are loaded only for their volume."""

    def __init__(self, model: Model, workspace: Workspace, meshes: MeshLibrary) -> None:
        self._model, self._workspace, self._meshes = model, workspace, meshes
        self._volumes: dict[str, Volume] = {}
        """By digest of the mesh."""

    def frames(self, command: GetFrames) -> Frames:
        """Return the frames of the joints."""
        model = self._model
        return Frames.model_construct(
            request=command.request,
            revision=model.revision,
            origins={
                name: (*joint.origin.xyz, *joint.origin.rpy)
                for name, joint in model.robot.joints.items()
            },
        )

    async def masses(self, command: GetMasses) -> Masses:
        """Return the masses of the links."""
        robot = self._model.robot
        weighed = [link for link in robot.links.values() if link.inertial]
        volumes = await self._volumes_of(_mesh_uris(weighed))
        # a large robot takes a while, and other work should not wait for it
        return await asyncio.to_thread(masses_event, command.request, robot, volumes.get)

    async def _volumes_of(self, uris: Iterable[str]) -> dict[str, Volume]:
        """Return the volumes by URI, without meshes that cannot be read, which are problems."""
        asked = list(uris)
        found = await asyncio.gather(*map(self._volume, asked))
        return {uri: one for uri, one in zip(asked, found, strict=True) if one is not None}

    async def _volume(self, uri: str) -> Volume | None:
        try:
            path = self._workspace.resolve_uri(uri)
            mesh = await self._meshes.load(path, self._workspace.served.all)
        except (PackageError, RobotError, WorkerError):
            return None
        known = self._volumes.get(mesh.digest)
        if known is None:
            known = await asyncio.to_thread(mesh_volume, mesh)
            if len(self._volumes) >= _KEPT:
                self._volumes.clear()
            self._volumes[mesh.digest] = known
        return known


COMMANDS: Final = Commands[Inspection](Scope.DOCUMENT)
COMMANDS.viewer(GetFrames, lambda inspection, c, _: inspection.frames(c))
COMMANDS.viewer(GetMasses, lambda inspection, c, _: inspection.masses(c))


def masses_event(request: int, robot: Robot, of_mesh: MeshVolumes) -> Masses:
    """Return the links with an inertial; `of_mesh` as for `shapes_volume`."""
    found = ((link, link_mass(link)) for link in robot.links.values())
    views = (_view(link, mass, of_mesh) for link, mass in found if mass)
    return Masses.model_construct(request=request, links=tuple(views))


def _view(link: Link, mass: LinkMass, of_mesh: MeshVolumes) -> LinkMassView:
    return LinkMassView.model_construct(
        link=link.name,
        mass_kg=mass.mass_kg,
        centre_m=mass.centre_m,
        moments_kg_m2=mass.moments_kg_m2,
        inertia_kg_m2=mass.inertia_kg_m2,
        visual=_volume_view(shapes_volume(link.visuals, of_mesh)),
        collision=_volume_view(shapes_volume(link.collisions, of_mesh)),
    )


def _volume_view(found: Volume | None) -> VolumeView | None:
    if found is None:
        return None
    return VolumeView.model_construct(volume_m3=found.volume_m3, is_exact=found.is_exact)


def _mesh_uris(links: Iterable[Link]) -> dict[str, None]:
    """Return each mesh of these links once."""
    shapes = (shape for link in links for shape in (*link.visuals, *link.collisions))
    return {one.geometry.uri: None for one in shapes if isinstance(one.geometry, Mesh)}

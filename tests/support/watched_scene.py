"""A scene that shows the rover, and a peer that has seen it."""

from __future__ import annotations

import asyncio
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from studio.robot.kinematics import Kinematics
from studio.robot.meshes.loaded_mesh import LoadedMesh
from studio.robot.values import Collision, Link, Material, Mesh, Origin, Robot, Visual
from studio.scene import DocumentScene
from tests.support.robots import rover
from tests.support.viser_frames import Peer, Sent, joined

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable

URI = "package://parts/wheel.stl"


def watched(scenario: Callable[[DocumentScene, Peer], Awaitable[None]]) -> None:
    """Run a scenario on a scene that shows the rover, and a peer that has seen it."""

    async def run() -> None:
        scene = DocumentScene(asyncio.get_running_loop())
        scene.show(rover(), None)
        scene.set_poses(*poses_of(rover()))
        scene.flush()
        peer, _ = await joined(scene)
        await scenario(scene, peer)
        scene.close()
        await asyncio.sleep(0)

    asyncio.run(run())


def poses_of(robot: Robot) -> tuple[tuple[str, ...], np.ndarray[Any, Any]]:
    kinematics = Kinematics(robot)
    return kinematics.link_names, kinematics.wxyz_xyz(kinematics.zero_positions())


def sent_by(scene: DocumentScene, peer: Peer) -> list[Sent]:
    scene.flush()
    return peer.read()


def with_link(robot: Robot, link: Link) -> Robot:
    return replace(robot, links={**robot.links, link.name: link})


def triangle(digest: str = "one", *, glb: bytes = b"") -> LoadedMesh:
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], dtype=np.float32)
    faces = np.array([[0, 1, 2]], dtype=np.uint32)
    return LoadedMesh(digest, vertices, faces, glb, ((0, 0, 0), (1, 1, 0)))


def robot_with_mesh(scale: float = 1.0, *, collision: bool = False) -> Robot:
    mesh = Mesh(URI, (scale, scale, scale))
    link = Link(
        "base",
        (Visual(Origin(), mesh, Material("", (1, 0, 0, 1))),),
        (Collision(Origin(), Mesh("package://parts/hull.stl")),) if collision else (),
    )
    return Robot("one", {"base": link})

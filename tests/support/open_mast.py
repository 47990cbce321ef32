"""An open mast with variants, asked as a page asks."""

from __future__ import annotations

from contextlib import asynccontextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from studio.protocol.edits import EditSite
from studio.protocol.variants import ApplyVariant, CompareVariants, Side
from tests.support.open_documents import Ear, engine, opened, until
from tests.support.packages import write_package

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator

    from studio.documents.document import Document
    from studio.documents.engine import Engine
    from studio.protocol import Command

MAST = """<robot name="mast" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="gripper" default="false"/>
  <xacro:arg name="side" default="left"/>
  <xacro:property name="reach" value="0.4"/>
  <xacro:property name="limits" value="${xacro.load_yaml('limits.yaml')}"/>
  <link name="base"/>
  <link name="tip"><inertial><mass value="2"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="turn" type="revolute">
    <parent link="base"/><child link="tip"/><origin xyz="0 0 ${reach}"/>
    <limit lower="-1" upper="${limits['upper']}" effort="1" velocity="1"/>
  </joint>
  <xacro:if value="$(arg gripper)"><xacro:include filename="gripper.xacro"/></xacro:if>
</robot>
"""
GRIPPER = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="jaw" value="0.05"/>
  <link name="gripper"><visual><geometry><sphere radius="${jaw}"/></geometry></visual></link>
  <joint name="grip" type="fixed"><parent link="tip"/><child link="gripper"/></joint>
</robot>
"""


def write_mast(folder: Path) -> Path:
    """A package with a mast, whose gripper is an argument and whose limit lies in YAML."""
    files = {
        "urdf/mast.urdf.xacro": MAST,
        "urdf/gripper.xacro": GRIPPER,
        "urdf/limits.yaml": "upper: 1.5  # rad\n",
    }
    return write_package(folder / "mast_description", files=files) / "urdf/mast.urdf.xacro"


class OpenMast:
    """One open document, asked as a page asks."""

    def __init__(self, made: Engine, document: Document, ear: Ear) -> None:
        self.made, self.document, self.ear = made, document, ear

    async def ask(self, command: Command) -> None:
        """Carry out one command of the document."""
        with_id = command.model_copy(update={"document": self.document.id})
        await self.made.execute(with_id, self.ear)

    async def edit(self, name: str, text: str) -> None:
        """Write at the site whose name ends so."""
        await self.ask(EditSite(site=self.ear.site(name)["id"], text=text))

    async def apply(self, name: str) -> list[str]:
        """Switch to a variant; what found no place."""
        await self.ask(ApplyVariant(name=name))
        return self.ear.last("variant_applied")["left_out"]

    async def is_told(self, active: str, *, modified: bool = False) -> None:
        """Wait until this is said to be active."""

        def told() -> bool:
            state = self.ear.last("variants")
            return (state["active"], state["modified"]) == (active, modified)

        await until(told)

    async def compared(self, *sides: Side) -> dict[str, Any]:
        """Compare two states; what is told when both are worked out."""
        one, other = sides
        before = len(self.ear.events)
        await self.ask(CompareVariants(sides=(one, other)))
        wanted = [side.model_dump() for side in sides]

        def told() -> bool:
            state = self.ear.last("comparison")
            is_new = state in self.ear.events[before:]
            return is_new and state["sides"] == wanted and not state["busy"]

        await until(told)
        return self.ear.last("comparison")

    @property
    def tip_m(self) -> float:
        """Height of the mast's tip."""
        return self.document.model.robot.joints["turn"].origin.xyz[2]

    @property
    def file(self) -> Path:
        """Where the variants are kept."""
        return Path(self.ear.last("variants")["path"])


@asynccontextmanager
async def open_mast(entry: Path, data: Path, **arguments: str) -> AsyncGenerator[OpenMast]:
    """Open a file in an engine of its own."""
    async with engine(data) as made:
        document, ear = await opened(made, entry, **arguments)
        yield OpenMast(made, document, ear)

"""Who moves the joints: whoever asks, unless something leads them; then nobody else."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from studio.errors import CommandError
from tests.support.open_documents import engine, opened

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from studio.documents.motion import Motion

ROBOT = """<robot name="r"><link name="a"/><link name="b"/>
  <joint name="j" type="revolute"><parent link="a"/><child link="b"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>"""
WAYS: tuple[Callable[[Motion], None], ...] = (
    lambda motion: motion.set({"j": 0.5}),
    lambda motion: motion.glide({"j": 0.5}, 0.0),
    lambda motion: motion.zero(),
    lambda motion: motion.randomize(),
    lambda motion: motion.animate(running=True),
)


def test_while_something_leads_the_joints_every_other_way_is_refused(tmp_path: Path):
    async def run() -> None:
        (tmp_path / "r.urdf").write_text(ROBOT)
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, tmp_path / "r.urdf")
            motion = document.motion
            motion.animate(running=True)
            motion.lead("/joint_states")
            assert (motion.swinging, ear.last("joints")["animating"]) == (False, False)
            motion.follow({"j": 1.5})
            for way in WAYS:
                with pytest.raises(CommandError, match="The joints follow /joint_states"):
                    way(motion)
            motion.animate(running=False)  # to stop is always allowed
            assert document.model.joints.by_name() == {"j": 1.5}
            motion.lead("")
            motion.set({"j": 1.5})
            assert document.model.joints.by_name() == {"j": 1.0}

    asyncio.run(run())

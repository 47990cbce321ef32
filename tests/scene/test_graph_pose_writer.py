from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from studio.scene.graph import STEP
from tests.support.watched_scene import sent_by, watched

if TYPE_CHECKING:
    from studio.scene import DocumentScene
    from tests.support.viser_frames import Peer

COUNT = 40


def test_turns_too_small_to_be_sent_are_not_lost_while_the_link_moves_on():
    """A link that drives fast and turns slowly is turned as far as it is after a while."""

    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        last = [0.0] * 4
        pose = np.array([[1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]])
        for count in range(1, COUNT + 1):
            pose[0, 3], pose[0, 4] = 0.9 * STEP * count, 0.01 * count
            scene.set_poses(("mast",), pose)
            for said in sent_by(scene, peer):
                if said["type"] == "SetOrientationMessage":
                    last = said["wxyz"]
        assert last[3] == pytest.approx(0.9 * STEP * COUNT, abs=STEP)

    watched(scenario)

"""What displays say of themselves."""

from __future__ import annotations

from studio.live.doctor.examination import examine
from studio.live.doctor.seen import (
    Heard,
    HeardFrames,
    HeardParameters,
    Seen,
    SeenDisplay,
    SeenDocument,
)
from studio.protocol.displays import DisplayState, Mend, Remark


def shown(*remarks: Remark) -> SeenDisplay:
    """A display with remarks."""
    state = DisplayState(id="1", rate_hz=0.0, age_s=None, received=0, lost=0, remarks=remarks)
    return SeenDisplay("1", "Laser", state)


def test_a_remark_is_a_finding_with_its_mend():
    mend = Mend(
        label="Listen to /scan",
        command={"type": "set_display_topic", "display": "1", "topic": "/scan"},
    )
    display = shown(
        Remark(level="error", reason="no_publisher", sentence="Nobody publishes /x.", mend=mend)
    )
    (found,) = examine(Seen(document=SeenDocument("d", "r", displays=(display,)))).findings
    assert (found.code, found.level, found.mend) == ("display", "error", mend)
    assert found.sentence == "Laser: Nobody publishes /x."
    assert [(one.kind, one.name) for one in found.about] == [("display", "1")]


def test_a_display_that_is_well_or_was_not_drawn_yet_is_no_finding():
    well = shown(Remark(level="ok", reason="", sentence="Shown."))
    document = SeenDocument("d", "r", displays=(well, SeenDisplay("2", "Map", None)))
    found = examine(Seen(document=document))
    assert found.findings == ()
    (looked,) = (one for one in found.subjects if one.subject == "displays")
    assert (looked.state, looked.count) == ("well", 2)


def test_a_fixed_frame_that_is_not_known_is_an_error():
    document = SeenDocument(
        "d", "r", root="base", fixed_frame="map", fixed_trouble='The frame "map" is not known.'
    )
    (found,) = examine(Seen(document=document)).findings
    assert (found.code, found.level) == ("fixed-frame", "error")
    assert found.evidence == (
        "the fixed frame is map",
        "the robot's root link is base",
        "no frame came on /tf",
    )
    assert found.mend == Mend(
        label="Draw everything in base", command={"type": "set_fixed_frame", "frame": ""}
    )


def test_where_the_robots_frame_is_the_fixed_one_the_root_of_tf_is_offered():
    frames = HeardFrames((), ("base", "odom"), (), 0)
    heard = Heard(3.0, {}, 0, None, frames, HeardParameters(), ())
    document = SeenDocument("d", "r", root="base", fixed_frame="base", fixed_trouble="It is not.")
    found = {one.code: one for one in examine(Seen(heard=heard, document=document)).findings}
    mend = found["fixed-frame"].mend
    assert mend is not None
    assert mend.command == {"type": "set_fixed_frame", "frame": "odom"}
    nowhere = SeenDocument("d", "r", fixed_frame="map", fixed_trouble="It is not.")
    (alone,) = examine(Seen(document=nowhere)).findings
    assert (alone.mend, alone.evidence[1]) == (None, "the robot has no link")

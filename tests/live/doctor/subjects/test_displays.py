"""What displays say of themselves."""

from __future__ import annotations

from studio.live.doctor.examination import examine
from studio.live.doctor.seen import Seen, SeenDisplay, SeenDocument
from studio.protocol.displays import DisplayState, Mend, Remark


def shown(*remarks: Remark) -> SeenDisplay:
    """A display with remarks."""
    state = DisplayState(id="1", rate_hz=0.0, age_s=None, received=0, lost=0, remarks=remarks)
    return SeenDisplay("1", "Laser", state)


def test_a_remark_is_a_finding_with_its_mend():
    mend = Mend(label="Listen to /scan", command={"type": "set_display_topic", "topic": "/scan"})
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
    document = SeenDocument("d", "r", fixed_trouble='The frame "map" is in no transform.')
    (found,) = examine(Seen(document=document)).findings
    assert (found.code, found.level) == ("fixed-frame", "error")

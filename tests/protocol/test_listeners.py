from studio.protocol.displays import LiveDisplays
from studio.protocol.listeners import Audience, LastSent
from tests.support.open_documents import Ear


def settings_in(frame: str) -> LiveDisplays:
    return LiveDisplays(displays=(), groups_off=(), fixed_frame=frame, paused=False)


def test_an_audience_hears_only_what_is_news():
    audience, ear = Audience(), Ear()
    audience.add(ear)
    settings = LastSent[LiveDisplays](audience)
    assert settings.event is None
    for frame in ("map", "map", "odom", "map"):
        settings.send(settings_in(frame))
    assert [said["fixed_frame"] for said in ear.events] == ["map", "odom", "map"]
    assert settings.event == settings_in("map")

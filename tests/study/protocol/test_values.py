"""A value that no study could mean is refused with what would do."""

from typing import get_args

import pytest

from stimuli.scene import PRESETS
from stimuli.spec import Camera
from study.protocol import ProtocolError


def test_a_camera_is_one_of_the_scenes(load, written):
    written["video"]["camera"] = "fullbody"
    with pytest.raises(
        ProtocolError, match=r"video\.camera: 'fullbody' will not do; did you mean full_body\?"
    ):
        load(written)
    assert get_args(Camera) == ("auto", *PRESETS)


@pytest.mark.parametrize(
    ("where", "value", "message"),
    [
        ("analysis.H1.correction", "Holm-Bonferroni", "will not do; did you mean holm?"),
        ("analysis.H2.1.compare", ["high", "low", "medium"], "must have no more than 2"),
        ("analysis.H2.1.outcome", 7, 'must be text; put it into "quotes"'),
        ("parts.recognition.order", "randomised", "will not do; did you mean shuffled?"),
        ("parts.recognition.ask.0", {"likert": {}}, "is no kind of question; did you mean rate?"),
        ("parts.intensity.ask.0.choose.options", ["one"], "needs at least 2"),
        ("parts.intensity.ask.0.choose.options", ["one", "one"], "names one twice"),
        ("analysis.H2.1.compare", ["high", "high"], "compares high with itself"),
        ("authors", "Ada", "must be a list, such as [Ada]"),
        ("video.size", "1280×720", "must be width and height in pixels, such as 1280x720"),
        ("video.size", "10x720", "must be at least 16x16 and at most 7680x4320"),
        ("video.size", "1280x4322", "must be at least 16x16 and at most 7680x4320"),
        ("video.lead_in", "2 min", "must be at most 60 s"),
        ("video.hold", "61 s", "must be at most 60 s"),
        ("study", "My study", "must begin with a letter from a to z, with letters, digits, - and _ after it"),
        ("seed", -1, "must be at least 0"),
        ("participants.exclude", {"faster_than": "3 d"}, "at most 60 s: who answers faster is left out"),
        ("participants.exclude", {"faster_than": "0 s"}, "at most 60 s: who answers faster is left out"),
        *(
            ("modulations.joy", {name: 1}, f"is no principle; did you mean {kind}?")
            for kind, name in {
                "ant": "anticipation",
                "exa": "exaggeration",
                "follow": "follow_through",
                "goal": "interactive_goal",
                "rand": "randomization",
                "sec": "secondary",
                "slow": "slow_in_out",
                "time": "timing",
            }.items()
        ),
    ],
)
def test_a_value_that_will_not_do_is_told_what_would(load, written, where, value, message):
    *way, last = where.replace("H2.1", "H2!1").split(".")
    place = written
    for step in way:
        place = place[int(step)] if isinstance(place, list) else place[step.replace("!", ".")]
    place[int(last) if isinstance(place, list) else last] = value
    with pytest.raises(ProtocolError) as refused:
        load(written)
    assert refused.value.problems[0].message.endswith(message)


def test_a_name_that_is_none_is_refused_at_the_name(load, written):
    written["levels"] |= {"very calm": [1, 2, 3]}
    written["parts"] |= {"one more": {}}
    with pytest.raises(ProtocolError) as refused:
        load(written)
    assert "parts.one more" in {p.field for p in refused.value.problems}

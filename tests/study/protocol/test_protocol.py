"""The paper's protocol is read whole; what is wrong is said at its place, all of it at once."""

import json
from pathlib import Path

import pytest
import yaml

from stimuli.principles import Modulation
from study.protocol import ProtocolError, load_protocol

PAPER = Path(__file__).parents[3] / "protocols" / "hielscher2025"
EMOTIONS = ["joy", "sadness", "anger", "fear", "shame", "hurry"]
PRINCIPLES = ["arc", "ant", "time", "exa", "sec", "follow"]


def messages(refused) -> list[str]:
    return [f"{p.line}:{p.column} {p.field}: {p.message}" for p in refused.value.problems]


def test_the_papers_protocol_names_its_stimuli_as_agreed():
    protocol = load_protocol(PAPER)
    levels = [f"{kind}_{level}" for kind in PRINCIPLES for level in ("low", "medium", "high")]
    assert list(protocol.stimuli) == [*EMOTIONS, *levels, "practice"]
    assert protocol.stimuli["practice"].modulation == Modulation()
    assert protocol.stimuli["joy"].modulation["time"].intensity < 1
    assert protocol.languages == ("en", "de")


def test_the_papers_protocol_is_short():
    assert len((PAPER / "protocol.yaml").read_text().splitlines()) < 150


def test_high_and_low_are_judged_after_medium():
    part = load_protocol(PAPER).parts["intensity"]
    assert part.stimuli == tuple(f"{kind}_{level}" for kind in PRINCIPLES for level in ("low", "high"))
    assert part.reference_of("exa_high") == "exa_medium"


def test_every_error_is_said_at_once_and_at_its_place(load):
    with pytest.raises(ProtocolError) as refused:
        load(
            "study: pilot\n"
            "titel: Pilot\n"
            "contact: a@example.org\n"
            "robot: pepper\n"
            "seed: many\n"
            "gestures: {wave: wave.yaml}\n"
            "modulations: {joy: {tme: 0.8, exa: high}}\n"
            "parts:\n"
            "  one:\n"
            "    title: One\n"
            "    stimuli: {gesture: wave, modulations: [joy]}\n"
            "    order: wiliams\n"
            "    ask:\n"
            "      - rat: {}\n"
            "      - rate: {text: How, items: [joy], points: 99, ends: [low, high]}\n"
            "participants: {planned: 0}\n"
        )
    assert messages(refused) == [
        "1:1 title: is missing",
        "2:1 titel: is no field here; did you mean title?",
        "5:7 seed: 'many' must be a whole number",
        "7:21 modulations.joy.tme: is no principle; did you mean time?",
        "7:36 modulations.joy.exa: 'high' must be a number",
        "12:12 parts.one.order: 'wiliams' will not do; did you mean williams?",
        "14:9 parts.one.ask[0].rat: is no kind of question; did you mean rate?",
        "15:49 parts.one.ask[1].rate.points: '99' must be at most 11",
        "16:25 participants.planned: '0' must be at least 1",
    ]


def test_names_that_lead_nowhere_are_said_with_the_nearest_that_would(load, written):
    written["parts"]["recognition"]["stimuli"]["gesture"] = "explian"
    written["parts"]["intensity"]["stimuli"]["levels"][1] = "antt"
    written["practice"]["ask"] = "recogniton"
    with pytest.raises(ProtocolError) as refused:
        load(written)
    assert [(p.field, p.message) for p in refused.value.problems] == [
        ("practice.ask", "'recogniton' is no part; did you mean recognition?"),
        ("parts.recognition.stimuli.gesture", "'explian' is no gesture; did you mean explain?"),
        ("parts.intensity.stimuli.levels[1]", "'antt' is no principle with levels; did you mean ant?"),
    ]


@pytest.mark.parametrize(
    ("field", "value", "message"),
    [
        ("part", "intensty", "'intensty' is no part; did you mean intensity?"),
        ("compare", ["hi", "low"], "'hi' is no level or modulation in intensity; did you mean high?"),
        ("outcome", "hihger", "'hihger' is no answer in intensity; did you mean higher?"),
        ("mirrors", "H3.2", "'H3.2' is no other hypothesis; did you mean H2.2?"),
        ("item", "strength", "'strength' is no item of intensity; known: intensity"),
    ],
)
def test_hypotheses_speak_of_what_is_there(load, written, field, value, message):
    written["analysis"]["H2.1"][field] = value
    with pytest.raises(ProtocolError) as refused:
        load(written)
    assert refused.value.problems[0].message == message
    assert refused.value.problems[0].field.startswith(f"analysis.H2.1.{field}")


RATED = {"text": "How", "items": ["joy", "fear"], "ends": ["low", "high"]}


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ("analysis.H1.against: 9", "'9' is not on the scale, which goes from 1 to 5"),
        ("analysis.H1.part: intensity", "needs items of intensity that bear the names of its modulations"),
        (
            "parts.intensity.ask.1: {rate: RATED}",
            "does not say of which item; add item: with one of intensity, joy, fear",
        ),
        ("parts.intensity.ask.1: {attention: CHECK}", "'13' is no trial of intensity, which has 12"),
        ("participants.exclude: {failed_attention: 1}", "'1' is more than the attention checks: 0"),
        ("participants.recruitment: {}", "is empty; write service: prolific, sona or mturk, or leave it out"),
        ("participants.recruitment: {completion_ulr: x}", "is no field here; did you mean completion_url?"),
        ("gestures.wave: null", "must be a file, such as gestures/wave.yaml"),
        ("modulations.joy.4: null", "is no principle; write decimals with a point, as in 1.4"),
    ],
)
def test_what_a_new_user_may_slip_on_is_said(load, written, change, message):
    check = {"text": "Choose b", "options": ["a", "b"], "expected": "b", "at": [2, 13]}
    words = change.replace("RATED", json.dumps(RATED)).replace("CHECK", json.dumps(check))
    place, _, value = words.partition(": ")
    *path, last = place.split(".")
    holder = written
    for key in path:
        holder = holder[int(key) if isinstance(holder, list) else key]
    if isinstance(holder, list):
        holder[int(last) :] = [yaml.safe_load(value)]
    else:
        holder[last] = yaml.safe_load(value)
    with pytest.raises(ProtocolError) as refused:
        load(written)
    assert any(message in problem.message for problem in refused.value.problems), str(refused.value)


def test_modulations_extend_each_other(load, written):
    written["modulations"] |= {
        "glee": {"extends": "joy", "plus": {"exa": 0.25}, "times": {"arc": 2}, "sec": 0.2},
        "calm": {"extends": "sadness", "grid": {"time": [1.2, 1.4], "exa": [0.8, 0.9, 1.0]}},
    }
    written["parts"]["recognition"]["stimuli"]["modulations"] += ["glee", "calm", "neutral"]
    protocol = load(written)
    joy, glee = protocol.modulations["joy"], protocol.modulations["glee"]
    assert glee["time"] == joy["time"]
    assert glee["exa"].intensity == pytest.approx(joy["exa"].intensity + 0.25)
    assert glee["arc"].intensity == 2 * joy["arc"].intensity
    assert glee["sec"].intensity == 0.2
    calm = [protocol.stimuli[f"calm_{n}"].modulation for n in range(1, 7)]
    assert [(m["time"].intensity, m["exa"].intensity) for m in calm] == [
        (1.2, 0.8), (1.2, 0.9), (1.2, 1.0), (1.4, 0.8), (1.4, 0.9), (1.4, 1.0),
    ]  # fmt: skip
    assert all(m["arc"] == protocol.modulations["sadness"]["arc"] for m in calm)
    assert protocol.stimuli["neutral"].modulation == Modulation()


def test_modulations_that_extend_in_a_circle_are_refused(load, written):
    written["modulations"] |= {"a": {"extends": "b"}, "b": {"extends": "c"}, "c": {"extends": "a"}}
    with pytest.raises(ProtocolError, match=r"modulations\.a\.extends: 'b' goes in a circle: a → b → c → a"):
        load(written)


def test_levels_may_have_names_of_their_own(load, written):
    written["levels"]["arc"] = {"low": 1, "medium": 2, "high": 5, "extreme": 9}
    protocol = load(written)
    assert "arc_extreme" in protocol.parts["intensity"].stimuli
    assert protocol.stimuli["arc_extreme"].level == "extreme"


def test_the_hash_follows_the_content_and_the_files_not_the_comments(load, written, tmp_path):
    text = (PAPER / "protocol.yaml").read_text(encoding="utf-8")
    before = load(text).sha256
    assert load("# a remark\n" + text.replace("seed: 2025", "seed:    2025   # ours")).sha256 == before
    assert load(text.replace("seed: 2025", "seed: 2026")).sha256 != before
    (tmp_path / "gestures").mkdir()
    (tmp_path / "gestures" / "wave.yaml").write_text("gesture: wave\n")
    with_gesture = load(text).sha256
    assert with_gesture != before
    (tmp_path / "gestures" / "wave.yaml").write_text("gesture: waves\n")
    assert load(text).sha256 != with_gesture


def test_texts_are_shipped_in_english_and_german_and_filled_in():
    protocol = load_protocol(PAPER)
    for _, text in protocol.texts:
        assert set(text.root) == {"en", "de"}
        assert "{" not in text.in_("en") + text.in_("de")
    assert protocol.title.in_("de") in protocol.texts.consent.in_("de")
    assert protocol.parts["intensity"].intro == protocol.texts.comparison


def test_a_text_may_be_a_file_of_its_own(load, written, tmp_path):
    (tmp_path / "consent.md").write_text("Ask {contact}.", encoding="utf-8")
    written["texts"] = {"consent": "consent.md", "debrief": {"en": "Thanks", "de": "Danke"}}
    protocol = load(written)
    assert protocol.texts.consent.in_("de") == "Ask hri-lab@example.org."
    assert protocol.texts.debrief.in_("de") == "Danke"
    before = protocol.sha256
    (tmp_path / "consent.md").write_text("Write to {contact}.", encoding="utf-8")
    assert load(written).sha256 != before
    written["texts"]["practice"] = {"en": "Try", "de": "nowhere.md"}
    with pytest.raises(ProtocolError, match=r"texts\.practice\.de: 'nowhere\.md' cannot be read"):
        load(written)


def test_two_parts_with_the_same_stimulus_need_a_prefix(load, written):
    again = written["parts"]["recognition"] | {
        "stimuli": {"gesture": "wave", "modulations": ["joy", "fear"]},
    }
    written["parts"]["again"] = again
    with pytest.raises(ProtocolError, match="gives a stimulus the id joy, which part recognition has too"):
        load(written)
    again["stimuli"]["prefix"] = "wave_"
    assert load(written).parts["again"].stimuli == ("wave_joy", "wave_fear")


def test_the_shipped_consent_says_that_the_recruitment_service_tells_who_somebody_is(load, written):
    assert "Your id" not in load(written).texts.consent.in_("en")
    recruited = written | {"participants": {"planned": 12, "recruitment": {"service": "sona"}}}
    told = load(recruited).texts.consent
    assert "**Your id at SONA.** SONA tells us your id there." in told.in_("en")
    assert "**Ihre Kennung bei SONA.** SONA nennt uns" in told.in_("de")


def test_the_shipped_consent_names_who_is_responsible_and_the_approval_where_they_are_given(load, written):
    told = load(written | {"authors": ["Ada Example", "Ben Example"], "ethics": "2026-017"}).texts.consent
    open_ = load({name: value for name, value in written.items() if name != "authors"}).texts.consent
    for language, responsible, approval in (
        ("en", "Who is responsible", "Ethics approval"),
        ("de", "Verantwortlich", "Ethikvotum"),
    ):
        assert f"**{responsible}.** Ada Example, Ben Example" in told.in_(language)
        assert f"**{approval}.** 2026-017" in told.in_(language)
        assert responsible not in open_.in_(language) and approval not in open_.in_(language)
        assert "hri-lab@example.org" in open_.in_(language)

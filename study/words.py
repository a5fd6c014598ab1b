"""A protocol in English words, as they stand in its check, its preregistration and its methods section."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from study.power import family_size
from study.protocol import Exclusions, Hypothesis, Order, Part, Participants, Protocol
from study.protocol.parts import BETWEEN, could_be_meant, series_of
from study.protocol.plan import TEST_NAMES
from study.protocol.video import Video
from study.questions import Question
from study.questions.scale import Scale

NUMBERS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")
ORDERS = {
    "williams": "a Williams design, which balances positions and first-order carry-over",
    "latin square": "a cyclic Latin square, which balances positions",
    "shuffled": "a random order of its own for each participant",
    "fixed": "the order given here, for everybody",
    BETWEEN: "one of them per participant, evenly assigned",
}
SIDES = {"greater": "one-sided, greater", "less": "one-sided, less", "two-sided": "two-sided"}


def count(n: int, one: str, many: str | None = None) -> str:
    """A number of things: one video, eleven would be 11 videos."""
    return f"{NUMBERS[n] if n < len(NUMBERS) else n} {one if n == 1 else many or one + 's'}"


def listed(words: Iterable[str], last: str = "and") -> str:
    """`a, b and c`."""
    *others, end = words
    return f"{', '.join(others)} {last} {end}" if others else end


def ordered(order: Order) -> str:
    """An order in words."""
    if order.blocks:
        alike, method = order.blocks
        within = (
            "their levels in orders that are evenly spread within each participant"
            if order.levels
            else f"the stimuli within each by {ORDERS[order.stimuli or 'fixed']}"
        )
        return f"in blocks of one {alike}; the blocks by {ORDERS[method]}; {within}"
    limits = " and ".join(f"at most {n} of the same {alike} in a row" for alike, n in order.max_run.items())
    return ORDERS[order.stimuli or "fixed"] + (f", with {limits}" if limits else "")


def in_brief(order: Order) -> str:
    """An order as the protocol has it."""
    written = order.model_dump(exclude_defaults=True)
    limits = (f"at most {n} of one {alike} in a row" for alike, n in written.pop("max_run", {}).items())
    named = (value if name == "stimuli" else f"{name} {value}" for name, value in written.items())
    return ", ".join([*named, *limits])


def shown_if(part: Part) -> str:
    """Who is shown a part, where that is not everybody."""
    return " and ".join(f"{item} is {listed(answers, 'or')}" for item, answers in part.only_if.items())


def asked(question: Question) -> str:
    """A question in words: what is asked, of which items, and how it is answered."""
    items = [f"“{text.in_('en')}”" for text in question.items.values() if text != question.text]
    of = f", for {listed(items)}" if items else ""
    shuffled = ", in an order shuffled once per participant" if question.shuffles_items else ""
    scored = series_of((question,))
    score = f"; their mean is the score *{listed(scored)}*" if len(scored) == 1 else ""
    score = f"; the means of series are the scores {listed(scored)}" if len(scored) > 1 else score
    balanced = ", the places of the options balanced" if len(question.option_orders) > 1 else ""
    optional = ", if one likes" if question.optional else ""
    answered = f"answered {question.answering}{balanced}{optional}"
    return f"“{question.text.in_('en')}”{of}{shuffled}, {answered}{score}"


def parameters(values: Mapping[str, Any]) -> str:
    """Parameters as `name = value`, numbers to four digits; what is empty is left out."""
    words = []
    for name, value in values.items():
        if isinstance(value, Mapping):
            words += [
                f"{inner}: ({parameters(of)})" if isinstance(of, Mapping) else parameters({inner: of})
                for inner, of in value.items()
            ]
        elif value not in ([], None):
            words.append(f"{name} = {value:.4g}" if isinstance(value, float) else f"{name} = {value}")
    return ", ".join(words)


def replays(video: Video, may: str = "may") -> str:
    """How often a clip that was seen to its end may be watched again."""
    if video.replays is None:
        return f"{may} then be watched again as often as one likes"
    if video.replays == 0:
        return f"{may} not be watched again"
    return f"{may} then be watched again {'once' if video.replays == 1 else f'{video.replays} times'}"


def stop_rule(rules: Participants) -> str:
    """Until when data are gathered."""
    until = f"until {count(rules.planned, 'participant')} have completed the study"
    if rules.stop == "by hand":
        return f"{until}; the experimenter then closes it"
    return f"{until}; it then closes itself: nobody else may begin, and who has begun may finish and counts"


def beside_the_test(protocol: Protocol, hypothesis: Hypothesis) -> str:
    """What is added where a test of independent samples is used on answers by the same participants."""
    order = protocol.written_parts[hypothesis.part].order
    if hypothesis.test != "independent t" or BETWEEN in {order.stimuli, order.modulations}:
        return ""
    fitting = (
        "the paired t-test and McNemar's exact test are" if hypothesis.outcome else "the paired t-test is"
    )
    return f"The same participants give both answers; {fitting} reported beside it"


def exclusions(rules: Exclusions) -> str:
    """Who is left out, as one clause; empty where nobody is."""
    who = [*_left_out(rules)]
    return f"participants with {listed(who, 'or')}" if who else ""


def _left_out(rules: Exclusions) -> Iterator[str]:
    if rules.incomplete:
        yield "an unfinished session"
    if rules.faster_than is not None:
        yield f"a median time per answer below {rules.faster_than:g} s"
    if rules.failed_attention is not None:
        least = rules.failed_attention
        yield "a failed attention check" if least == 1 else f"{least} or more failed attention checks"
    if rules.straight_lining:
        yield "the same answer to every item of a part"


# Hypotheses


def chance_of(protocol: Protocol, hypothesis: Hypothesis) -> str:
    """The level that target ratings are tested against, with its number where it has one."""
    against = hypothesis.against if hypothesis.against is not None else "midpoint"
    if not isinstance(against, str):
        return f"{against:g}"
    scale = _scale_of(protocol, hypothesis)
    lowest, highest = scale.scale if scale else (1, 1)
    items = len(scale.items) if scale else 1
    return {
        "midpoint": f"{(lowest + highest) / 2:g}, the middle of the scale from {lowest} to {highest}",
        "grand mean": "the mean of all ratings",
        "other stimuli": "the mean rating of the same item for the other stimuli",
        "other items": "the mean rating of the other items for the same stimulus",
        "equal share": f"1/{items}, an equal share of the points given to the stimulus",
        "equal share above lowest": f"1/{items}, an equal share of the points above the lowest",
        "best item": f"1/{items}, the chance that an item is rated highest alone",
        "double difference": "what stimulus and item alone explain",
    }[against]


def _scale_of(protocol: Protocol, hypothesis: Hypothesis) -> Scale | None:
    questions = protocol.written_parts[hypothesis.part].ask
    return next((question for question in questions if isinstance(question, Scale)), None)


def stated(protocol: Protocol, hypothesis: Hypothesis) -> str:
    """The hypothesis in words, where the protocol gives none: exactly what its test says."""
    part = f"In part *{hypothesis.part}*, "
    if hypothesis.compare is None:
        direction = {"greater": "above", "less": "below"}.get(hypothesis.alternative, "different from")
        chance = f"{direction} chance ({chance_of(protocol, hypothesis)})"
        if hypothesis.against == "best item":
            return f"{part}each stimulus's meant item is rated highest, alone, by a share of people {chance}."
        return f"{part}each stimulus is rated {chance} on the item it is meant to express."
    first, second = (f"*{condition}*" for condition in hypothesis.compare)
    if protocol.written_parts[hypothesis.part].pairs is not None:
        often = {"greater": "more", "less": "less"}.get(hypothesis.alternative, "more or less")
        return f"{part}{first} is preferred to {second} by {often} than half of the participants."
    of = " of the same principle" if protocol.written_parts[hypothesis.part].stimuli.levels else ""
    if hypothesis.outcome:
        often = {"greater": "more", "less": "less"}.get(hypothesis.alternative, "more or less")
        return f"{part}“{hypothesis.outcome}” is chosen {often} often for {first} than for {second}{of}."
    higher = {"greater": "higher", "less": "lower"}.get(hypothesis.alternative, "higher or lower")
    return (
        f"{part}the ratings of {_item(protocol, hypothesis)} are {higher} for {first} than for {second}{of}."
    )


def tested(protocol: Protocol, hypothesis: Hypothesis) -> str:
    """The test that decides, exactly: of what, against what, which side, which correction."""
    test = f"{TEST_NAMES[hypothesis.test]} ({SIDES[hypothesis.alternative]})"
    if hypothesis.compare is None:
        of = f"of the ratings on the target item{_targets(protocol, hypothesis)} against "
        of += chance_of(protocol, hypothesis)
    elif protocol.written_parts[hypothesis.part].pairs is not None:
        of = f"of the share that prefers {hypothesis.compare[0]} to {hypothesis.compare[1]} against 1/2"
    else:
        counted = f"the answer “{hypothesis.outcome}” (1, else 0)" if hypothesis.outcome else ""
        of = f"of {counted or _item(protocol, hypothesis)}, {' against '.join(hypothesis.compare)}"
    return f"{test} {of}; {corrected(protocol, hypothesis)}"


def _targets(protocol: Protocol, hypothesis: Hypothesis) -> str:
    """The stimuli that are tested, where some of the part are not meant to express an item."""
    items = could_be_meant(protocol.written_parts[hypothesis.part].ask)
    stimuli = protocol.stimuli_of(hypothesis.part)
    targets = [stimulus.id for stimulus in stimuli if stimulus.name in items]
    return "" if len(targets) == len(stimuli) else f", of {listed(targets)} alone,"


def corrected(protocol: Protocol, hypothesis: Hypothesis) -> str:
    """How p is corrected; a mirrored hypothesis takes the correction of what it mirrors."""
    tests = family_size(protocol, hypothesis)
    counted = protocol.analysis.hypotheses[hypothesis.mirrors] if hypothesis.mirrors else hypothesis
    if counted.correction == "none":
        return "p not corrected" + (f" for its {tests} tests" if tests > 1 else "")
    return f"{counted.correction.title()} correction over {count(tests, 'test')}"


def _item(protocol: Protocol, hypothesis: Hypothesis) -> str:
    """What is rated: an item, or the mean of a series of them."""
    part = protocol.written_parts[hypothesis.part]
    asked_for = hypothesis.item or could_be_meant(part.ask)[0]
    items = series_of(part.ask).get(asked_for)
    return f"*{asked_for}* (the mean of {count(len(items), 'item')})" if items else f"*{asked_for}*"

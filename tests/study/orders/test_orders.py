"""Orders are balanced, reproducible, and fill up evenly."""

import copy
import csv
import errno
import io
import random
from collections import Counter
from dataclasses import replace
from functools import cache
from itertools import groupby, pairwise
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stimuli.errors import InputError
from study.balance import balance, balance_table, write_orders
from study.chance import Stream
from study.designs import latin_square, williams
from study.orders import assign_slot, cycle, draw_plan
from study.protocol import Protocol, load_protocol

PAPER = load_protocol(Path(__file__).parents[3] / "protocols" / "hielscher2025")
PLANS = [draw_plan(PAPER, slot) for slot in range(36)]


def shown(plan, part):
    return [trial.stimulus for trial in plan.trials if trial.part == part and not trial.practice]


@given(st.integers(1, 15))
def test_in_a_latin_square_each_condition_stands_once_in_each_position(n):
    square = latin_square(n)
    assert all(sorted(column) == list(range(n)) for column in zip(*square, strict=True))
    assert all(sorted(row) == list(range(n)) for row in square)


@given(st.integers(2, 15))
def test_in_a_williams_design_each_condition_follows_each_other_equally_often(n):
    rows = williams(n)
    times = 1 if n % 2 == 0 else 2
    assert len(rows) == times * n
    assert all(sorted(row) == list(range(n)) for row in rows)
    for column in zip(*rows, strict=True):
        assert set(Counter(column).values()) == {times}
    follows = Counter(pair for row in rows for pair in pairwise(row))
    assert len(follows) == n * (n - 1)
    assert set(follows.values()) == {times}


@given(st.integers(0, 10_000), st.integers(1, 30))
def test_a_shuffle_keeps_everything_and_repeats_itself(seed, n):
    shuffled = Stream(seed).shuffled(range(n))
    assert sorted(shuffled) == list(range(n))
    assert shuffled == Stream(seed).shuffled(range(n))


def test_all_shuffles_are_equally_likely():
    counts = Counter(Stream("fair", n).shuffled("abc") for n in range(6000))
    assert len(counts) == 6
    assert max(counts.values()) - min(counts.values()) < 160  # 5 standard deviations of a count


def test_streams_are_the_same_for_ever():
    # printf %s golden/1 | sha256sum
    assert Stream("golden", 1).key == "3fa9239e821bf1ba8154c34444a10e128942658803b58aba06efdfe42cc61068"
    stream = Stream("golden", 1)
    assert [stream.below(1000) for _ in range(6)] == [517, 441, 798, 198, 954, 464]
    assert "".join(Stream("golden", 2).shuffled("abcdefgh")) == "ahbefcdg"


def test_a_plan_is_the_same_for_ever():
    assert PLANS[0].algorithm == "orders/1"
    assert PLANS[0].seed == "58cb662c6ae7702097833b8646c39ed237199389d98cfc88c3fa85be7c268930"
    assert shown(PLANS[0], "recognition") == ["shame", "hurry", "fear", "joy", "anger", "sadness"]
    assert " ".join(shown(PLANS[7], "intensity")) == (
        "arc_low arc_high ant_high ant_low follow_high follow_low "
        "time_high time_low sec_low sec_high exa_low exa_high"
    )


def test_36_participants_fill_the_papers_design_evenly():
    assert 36 % cycle(PAPER) == 0
    for part in balance(PAPER, PLANS):
        assert part.position_range == (6, 6)
        assert part.follows_range == (6, 6)


def test_34_participants_fill_it_nearly():
    for part in balance(PAPER, PLANS[:34]):
        low, high = part.position_range
        assert high - low <= 2


def test_each_participant_begins_three_principles_with_the_high_level():
    for plan in PLANS:
        firsts = shown(plan, "intensity")[::2]
        assert sum(stimulus.endswith("_high") for stimulus in firsts) == 3


def test_each_principle_begins_as_often_with_high_as_with_low():
    first = balance(PAPER, PLANS)[1].first
    assert set(first.values()) == {18}


def test_no_more_than_two_of_the_same_level_run():
    for plan in PLANS:
        levels = [stimulus.split("_")[1] for stimulus in shown(plan, "intensity")]
        assert max(len(list(run)) for _, run in groupby(levels)) <= 2


def test_sides_are_fixed_within_and_balanced_between_participants():
    sides = Counter()
    for plan in PLANS:
        (own,) = {trial.options for trial in plan.trials if trial.part == "intensity"}
        sides[own] += 1
    assert sides == {(("lower", "higher"),): 18, (("higher", "lower"),): 18}


def test_orders_of_the_two_parts_are_not_tied_to_each_other():
    together = {(shown(p, "recognition")[0], shown(p, "intensity")[0].split("_")[0]) for p in PLANS}
    assert len(together) > 12


def test_a_plan_depends_on_seed_and_slot_alone():
    assert draw_plan(PAPER, 5) == PLANS[5]
    assert len({tuple(t.stimulus for t in plan.trials) for plan in PLANS}) > 30
    assert len({plan.seed for plan in PLANS}) == 36


def arrivals_with_dropout(rng, slots_for, n_complete=36, dropout=0.2, at_once=4):
    """Participants come one by one, stay while some others come, and one in five never finishes."""
    counts: Counter[int] = Counter()
    active: list[tuple[int, bool]] = []
    completed = 0
    while completed < n_complete:
        slot = slots_for(counts)
        counts[slot] += 1
        active.append((slot, rng.random() < dropout))
        while len(active) > at_once or (active and completed + len(active) >= n_complete):
            left, gave_up = active.pop(rng.randrange(len(active)))
            if gave_up:
                counts[left] -= 1
            else:
                completed += 1
    return counts


def test_with_20_percent_dropout_rows_are_filled_within_the_spread_aimed_at():
    rng = random.Random(1)
    spreads = []
    for _ in range(300):
        counts = arrivals_with_dropout(rng, assign_slot)
        rows = Counter(dict.fromkeys(PAPER.parts["recognition"].stimuli, 0))
        for slot, times in counts.items():
            rows[row(slot)] += times
        spreads.append(max(rows.values()) - min(rows.values()))
    assert max(spreads) <= 3
    assert sum(spreads) / len(spreads) <= 1.6


@cache
def row(slot):
    """The row of the Williams square, which its first condition tells."""
    return shown(draw_plan(PAPER, slot), "recognition")[0]


def test_a_freed_slot_is_given_to_the_next():
    assert assign_slot({}) == 0
    assert assign_slot({0: 1, 1: 0, 2: 1}) == 1
    assert assign_slot({0: 1, 1: 2}) == 2


def bent(order, stimuli=None, part="recognition", n=24):
    """What participants see of a part of the paper's study if it had this order."""
    raw = PAPER.source.value
    written = raw["parts"][part] | {"order": order} | ({"stimuli": stimuli} if stimuli else {})
    value = raw | {"parts": raw["parts"] | {part: written}}
    protocol = Protocol.model_validate(value)
    protocol._source = replace(PAPER.source, value=value)
    return protocol, [shown(draw_plan(protocol, slot), part) for slot in range(n)]


TWO_GESTURES = {"gesture": ["explain", "wave"], "modulations": ["joy", "anger", "fear"]}


def test_between_participants_each_sees_one_and_all_are_seen_equally_often():
    protocol, orders = bent("between participants")
    assert Counter(len(order) for order in orders) == {1: 24}
    assert set(Counter(order[0] for order in orders).values()) == {4}
    assert protocol.length[0] == 1 + 1 + 24  # practice, one of the first part, all of the second


def test_between_participants_blocks_give_each_a_group_of_their_own():
    _, orders = bent({"gestures": "between participants", "stimuli": "williams"}, TWO_GESTURES)
    assert all(len({name.split("_")[0] for name in order}) == 1 and len(order) == 3 for order in orders)
    assert set(Counter(order[0] for order in orders).values()) == {4}


def test_blocks_stay_together():
    _, orders = bent({"gestures": "shuffled", "stimuli": "shuffled"}, TWO_GESTURES)
    for order in orders:
        gestures = [name.split("_")[0] for name in order]
        assert len(list(groupby(gestures))) == 2
    assert len(set(map(tuple, orders))) > 12


def test_no_more_than_so_many_in_a_row_are_alike():
    _, orders = bent({"stimuli": "shuffled", "max_run": {"gesture": 1}}, TWO_GESTURES)
    assert all(a.split("_")[0] != b.split("_")[0] for order in orders for a, b in pairwise(order))
    assert len(set(map(tuple, orders))) > 12


def test_a_run_that_cannot_be_avoided_is_refused():
    with pytest.raises(InputError, match="none of 20000 shuffles keeps to"):
        bent({"stimuli": "shuffled", "max_run": {"gesture": 1}}, n=1)


def test_fixed_is_as_written_and_latin_balances_positions():
    _, orders = bent("fixed")
    assert set(map(tuple, orders)) == {PAPER.parts["recognition"].stimuli}
    _, orders = bent("latin square")
    for column in zip(*orders, strict=True):
        assert set(Counter(column).values()) == {4}
    _, orders = bent("shuffled")
    assert len(set(map(tuple, orders))) == 24


def test_an_odd_number_is_balanced_over_twice_as_many():
    protocol, orders = bent("williams", {"gesture": "explain", "modulations": ["joy", "anger", "fear"]}, n=6)
    assert cycle(protocol) == 6
    assert set(Counter(pair for order in orders for pair in pairwise(order)).values()) == {2}


def test_items_are_shuffled_once_per_participant():
    value = copy.deepcopy(PAPER.source.value)
    value["parts"]["recognition"]["ask"][0]["rate"]["item_order"] = "shuffled"
    protocol = Protocol.model_validate(value)
    protocol._source = replace(PAPER.source, value=value)
    seen = set()
    for slot in range(12):
        (items,) = {trial.items for trial in draw_plan(protocol, slot).trials if trial.part == "recognition"}
        seen.add(items)
    assert len(seen) > 8


def test_the_csv_names_what_is_asked_on_each_page():
    protocol = load_protocol(PAPER.folder.parent / "online")
    write_orders(protocol, [draw_plan(protocol, 0)], table := io.StringIO())
    rows = list(csv.DictReader(table.getvalue().splitlines()))
    checked = [row["trial"] for row in rows if "attention" in row["items"]]
    assert checked == ["4", "9"]


def test_very_many_orders_are_written_one_by_one():
    class Full(io.StringIO):
        def write(self, text):
            if text.startswith("3,"):
                raise OSError(errno.ENOSPC, "No space left on device")
            return super().write(text)

    drawn = []
    plans = (drawn.append(slot) or draw_plan(PAPER, slot) for slot in range(100_000))
    with pytest.raises(OSError, match="No space left"):
        write_orders(PAPER, plans, table := Full())
    assert drawn == [0, 1, 2, 3] and table.getvalue().count("\n") > 50


def test_the_table_tells_positions_and_who_follows_whom():
    (counts, _) = balance(PAPER, [draw_plan(PAPER, slot) for slot in range(7)])
    title, *rows = balance_table([counts]).splitlines()
    assert title == "recognition: how often in each position | and straight after each other"
    table = {row.split()[0]: row.split("|") for row in rows}
    assert [int(n) for n in table["joy"][0].split()[1:]] == list(counts.positions["joy"])
    followed = table["anger"][1].split()
    assert followed[2] == "–" and int(followed[0]) == counts.follows["joy", "anger"]

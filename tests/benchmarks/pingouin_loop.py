"""The paper's tests with pingouin, group by group: how an analysis script for this study usually looks."""

from __future__ import annotations

import json
import resource
import sys
import time

import pandas as pd
import pingouin as pg

EMOTIONS = ("joy", "sadness", "anger", "fear", "shame", "hurry")
PRINCIPLES = ("arc", "ant", "time", "exa", "sec", "follow")


def analyse(path: str) -> None:
    """Means of every item, t-tests against 3, and high against low by Student's t and McNemar's test."""
    answers = pd.read_csv(path)
    ratings = answers[answers["part"] == "recognition"].copy()
    ratings["response"] = ratings["response"].astype(int)
    ratings.groupby(["stimulus", "item"])["response"].agg(["mean", "sem", "std", "count"])
    for emotion in EMOTIONS:
        target = ratings[(ratings["stimulus"] == emotion) & (ratings["item"] == emotion)]["response"]
        pg.ttest(target, 3, alternative="greater")
    choices = answers[answers["part"] == "intensity"].copy()
    choices["higher"] = (choices["response"] == "higher").astype(int)
    for principle in PRINCIPLES:
        both = choices[choices["stimulus"].isin([f"{principle}_high", f"{principle}_low"])]
        table = both.pivot(index="participant", columns="stimulus", values="higher")
        high, low = table[f"{principle}_high"], table[f"{principle}_low"]
        pg.ttest(high, low, alternative="greater", correction=False)
        pg.chi2_mcnemar(table, f"{principle}_high", f"{principle}_low")


if __name__ == "__main__":
    start = time.perf_counter()
    analyse(sys.argv[1])
    peak_mb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    sys.stdout.write(json.dumps({"seconds": time.perf_counter() - start, "peak_mb": peak_mb}) + "\n")

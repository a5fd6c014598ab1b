"""Answers as a tidy table, one row per answered item, with a codebook that says what everything means."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from datetime import datetime
from pathlib import Path
from typing import Any

from study.orders import Trial
from study.participants import Kind, is_of
from study.protocol import Protocol
from study.questions import Question
from study.responses import Response
from study.sessions import Step, steps
from study.storage import Store

ClipHashes = Mapping[str, Mapping[str, str]]
"""The hashes of clips' files by stimulus id, by hash of the protocol they were rendered from."""

SECRET = {"completion_code"}  # whoever knows it could withdraw the participant
COLUMNS = {
    "participant": "Random name; says nothing about order or person.",
    "part": "The study's part, or 'demographics'.",
    "trial": "Place within the part, from 1; empty for demographics.",
    "stimulus": "Id of the judged clip or pair of clips; empty for demographics.",
    "item": "What was answered.",
    "response": "The answer; empty where none was given.",
    "rt_ms": "From the end of the first full view of the last clip to the last change of this answer, in ms.",
    "order": "Place of the trial among all trials of the session, from 1.",
    "plays": "How often the clip was played to its end; of a pair, the one played less.",
    "played_s": "Seconds truly played in its first full view; of a pair, of both.",
    "shown_at": "When the server first handed out the page, UTC.",
    "answered_at": "When the server stored the answer, UTC.",
    "seed": "Seed of this participant's orders.",
    "stimulus_sha256": "Hash of the clip's file (of a pair, both); leads to its parameters in manifest.json.",
    "protocol_sha256": "Hash of the protocol this participant took part in; the codebook has its questions.",
    "session": "'participant', or 'test' or 'simulated', which are no data.",
    "left": "Of a pair: the clip on the left (on narrow screens above). Empty otherwise.",
}


def rows(
    store: Store, *, kind: Kind = "participant", clips: ClipHashes | None = None
) -> Iterator[dict[str, str]]:
    """Answered items in the order answered, participant by participant; practice is left out.

    `clips` maps stimulus ids to the hashes of their files, for each protocol that participants began with.
    """
    for session, responses in store.responses(kind):
        pages = steps(session.plan)
        files = (clips or {}).get(session.protocol_sha256, {})
        by_key = {page.key: page for page in pages}
        orders = {page.key: n for n, page in enumerate((p for p in pages if _counts(p)), start=1)}
        for response in responses:
            step = by_key[response.submission.step]
            if step.trial and step.trial.practice:
                continue
            for answer in response.submission.answers:
                yield {
                    "participant": session.participant,
                    "part": step.part or step.key,
                    "trial": str(step.trial.number) if step.trial else "",
                    "stimulus": step.trial.stimulus if step.trial else "",
                    "item": answer.item,
                    "response": answer.value,
                    "rt_ms": "" if answer.rt_ms is None else f"{answer.rt_ms:.1f}",
                    "order": str(orders.get(step.key, "")),
                    **_played(response),
                    "shown_at": _moment(response.shown_at),
                    "answered_at": _moment(response.answered_at),
                    "seed": session.plan.seed,
                    "stimulus_sha256": _hashes(step.trial, files),
                    "protocol_sha256": session.protocol_sha256,
                    "session": kind,
                    "left": step.trial.pair[0] if step.trial and step.trial.pair else "",
                }


def responses_csv(store: Store, *, kind: Kind = "participant", clips: ClipHashes | None = None) -> str:
    """The table as CSV (RFC 4180)."""
    file = io.StringIO(newline="")
    writer = csv.DictWriter(file, fieldnames=list(COLUMNS))
    writer.writeheader()
    for row in rows(store, kind=kind, clips=clips):
        writer.writerow(row | {"response": guarded(row["response"])})
    return file.getvalue()


def responses_json(store: Store, *, kind: Kind = "participant") -> str:
    """Everything about every session: its plan, and each answered page with what happened to its clips.

    Of those who withdrew it says when, and how many answers were deleted.
    """
    sessions = [
        {
            **{name: value for name, value in vars(session).items() if name not in SECRET},
            "plan": asdict(session.plan),
            "pages": [
                {
                    **response.submission.model_dump(mode="json"),
                    "shown_at": response.shown_at,
                    "answered_at": response.answered_at,
                }
                for response in responses
            ],
        }
        for session, responses in store.responses(kind)
    ]
    withdrawn = [vars(note) for note in store.withdrawals() if is_of(kind, note.participant)]
    content = {"kind": kind, "is_data": kind == "participant", "sessions": sessions, "withdrawals": withdrawn}
    return json.dumps(content, indent=1, ensure_ascii=False, default=_moment)


def guarded(response: str) -> str:
    """Free text that a spreadsheet would run as a formula, with an apostrophe before it; numbers stay."""
    if response[:1] not in {"=", "+", "-", "@", "\t", "\r"}:
        return response
    try:
        float(response)
    except ValueError:
        return f"'{response}"
    return response


def codebook(
    protocol: Protocol, *, kind: Kind = "participant", earlier: Mapping[str, Protocol] | None = None
) -> dict[str, Any]:
    """What the columns, items and values of the table mean, now and before amendments."""
    return {
        "study": protocol.study,
        "title": protocol.title.root,
        "protocol_sha256": protocol.sha256,
        "session": kind,
        "is_data": kind == "participant",
        "columns": COLUMNS,
        **_asked(protocol),
        "amendments": [amendment.model_dump(mode="json") for amendment in protocol.amendments],
        "earlier": {sha256: _asked(before) for sha256, before in (earlier or {}).items()},
        "left out": "Practice trials.",
    }


def _asked(protocol: Protocol) -> dict[str, Any]:
    """What one version of a protocol shows and asks."""
    parts = {
        part.id: {
            "title": str(part.title),
            "stimuli": list(part.stimuli),
            "references": dict(part.references),
            "pairs": {pair: list(two) for pair, two in part.pairs.items()},
            "items": _items(part.questions),
        }
        for part in protocol.parts.values()
    }
    return {"parts": parts, "demographics": _items(protocol.demographics)}


def export_responses(
    store: Store,
    protocol: Protocol,
    out: Path,
    *,
    kind: Kind = "participant",
    clips: ClipHashes | None = None,
    earlier: Mapping[str, Protocol] | None = None,
) -> Path:
    """Write responses.csv, its codebook and all records as JSON into a folder; gives the path of the table.

    `earlier` are the versions of the protocol that participants began with before amendments, by hash.
    """
    out.mkdir(parents=True, exist_ok=True)
    table = out / "responses.csv"
    with table.open("w", encoding="utf-8", newline="") as file:
        file.write(responses_csv(store, kind=kind, clips=clips))
    book = json.dumps(codebook(protocol, kind=kind, earlier=earlier), indent=2, ensure_ascii=False)
    (out / "responses.codebook.json").write_text(book + "\n", encoding="utf-8")
    (out / "responses.json").write_text(responses_json(store, kind=kind), encoding="utf-8")
    return table


def _counts(page: Step) -> bool:
    return page.trial is not None and not page.trial.practice


def _played(response: Response) -> dict[str, str]:
    views = [view for view in response.submission.views if view.role != "reference"]
    if not views:
        return {"plays": "", "played_s": ""}
    plays, played_s = min(view.plays for view in views), sum(view.played_s for view in views)
    return {"plays": str(plays), "played_s": f"{played_s:.3f}"}


def _hashes(trial: Trial | None, clips: Mapping[str, str]) -> str:
    """The hash of the clip's file; of a pair those of the left and the right one."""
    shown = () if trial is None else trial.pair or (trial.stimulus,)
    return " ".join(clips.get(stimulus, "") for stimulus in shown).strip()


def _moment(moment: datetime) -> str:
    return moment.isoformat(timespec="milliseconds").replace("+00:00", "Z")


def _items(questions: tuple[Question, ...]) -> list[dict[str, Any]]:
    return [entry for question in questions for entry in question.codebook()]

"""`make bench`: every comparison with a peer, interleaved in this run. Ratios, never absolute times.

`python -m tests.benchmarks motion sessions` runs only those named.
"""

from __future__ import annotations

import importlib
import sys
from pathlib import Path

from rich.console import Console
from rich.table import Table


def main(names: list[str]) -> int:
    """Run the benchmarks and print one table; exit code 1 where a goal is missed."""
    known = sorted(path.stem.removeprefix("bench_") for path in Path(__file__).parent.glob("bench_*.py"))
    unknown = set(names) - set(known)
    if unknown:
        sys.stderr.write(f"no benchmark {', '.join(unknown)}; known: {', '.join(known)}\n")
        return 2
    table = Table("what", "peer, in the same run", "ratio", "goal", "", "detail")
    missed = 0
    for name in names or known:
        for row in importlib.import_module(f"tests.benchmarks.bench_{name}").rows():
            goal = f"{'≤' if row.at_most else '≥'} {row.reach:g}×"
            table.add_row(
                row.what, row.peer, f"{row.ratio:.3g}×", goal, "✓" if row.reached else "✗", row.detail
            )
            missed += not row.reached
    Console(width=160).print(table)
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

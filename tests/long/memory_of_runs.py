"""Memory of a process over many runs, with an empty cache: `python tests/long/memory_of_runs.py [NAME ...]`.

Examples by the names of their files, eight of different kinds unless given, are computed one after the other.
What the process has after each is told, the most that it had, and what is left once programs are given back.
It fails where that is more than half of what a process may take on for programs.
"""

import os
import re
import sys
import tempfile
from pathlib import Path

EXAMPLES = Path(__file__).parents[2] / "examples"
USUAL = (
    *("pair_23_61", "spur_film", "torus", "helical_few_teeth_motion"),
    *("spur_wear", "pair_12_120_undercut", "two_stage", "ring"),
)


def taken(name: str = "VmRSS") -> int:
    """Memory of the process now, or by another name of the list that Linux has [MB]."""
    found = re.search(rf"{name}:\s+(\d+)", Path("/proc/self/status").read_text())
    assert found is not None
    return int(found[1]) // 1000


def main(names: list[str]) -> int:
    with tempfile.TemporaryDirectory() as empty:
        os.environ["XDG_CACHE_HOME"] = empty
        from pitchpoint.core import programs  # its cache is chosen as it is imported
        from pitchpoint.runs.run import run_case

        start = taken()
        print(f"{start} MB at the start")
        for name in names:
            run_case(str(EXAMPLES / f"{name}.toml"))
            print(f"{taken()} MB after {name}, at most {taken('VmHWM')}", flush=True)
        programs.forget()
        left = taken() - start
        print(f"{left} MB more than at the start once programs are given back")
        return int(1e6 * left > programs.MOST_MEMORY / 2)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:] or [*USUAL]))

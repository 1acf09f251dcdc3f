"""What benchmarks share: one thread, the rivals beside them, a small run for CI, and the last line.

It is imported before anything that imports JAX or NumPy, which read their threads once. Small runs compile
without optimisation: they show that a benchmark still runs and agrees with its rival, and how fast it is
they do not.
"""

import argparse
import os
import sys
from pathlib import Path

FLAGS = ("--xla_cpu_multi_thread_eigen=false", "intra_op_parallelism_threads=1")
QUICKLY = (
    "--xla_backend_optimization_level=0",
    "--xla_llvm_disable_expensive_passes=true",
    "--xla_cpu_use_fusion_emitters=false",
)
RIVALS = Path(__file__).parent / "rivals"

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ["XLA_FLAGS"] = " ".join(FLAGS + (QUICKLY if "--small" in sys.argv else ()))
sys.path.insert(0, str(RIVALS))


def sizes(
    doc: str | None, rival: str = "", **usual_and_small: tuple[int, int]
) -> argparse.Namespace:
    """How much is to be measured: each number as it is usual, as a small run has it, or as it is asked for.

    With a rival of another environment `rival` is the interpreter of that, or None.
    """
    parser = argparse.ArgumentParser(description=(doc or "").partition("\n")[0])
    parser.add_argument("--small", action="store_true", help="once and little, as CI has it")
    small = "--small" in sys.argv
    for name, both in usual_and_small.items():
        parser.add_argument(f"--{name}", type=int, default=both[small])
    if rival:
        parser.add_argument("--rival", help=f"python of an environment with {rival}")
    return parser.parse_args()


def last_line(**figures: float) -> None:
    """Figures as `every.py` reads them."""
    print("benchmark", Path(sys.argv[0]).stem, *(f"{name}={x:.4g}" for name, x in figures.items()))

"""What became of a solve: one record for balances, equilibria, vibrations and loops around them."""

from collections.abc import Callable, Iterator
from enum import IntEnum
from typing import Any

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float, Int

from pitchpoint.core.doubts import WITHHELD, Doubt

__all__ = [
    "DIRECT",
    "Code",
    "Status",
    "locked_or_lost",
    "solve_summary",
    "status_summary",
    "withheld",
]


class Code(IntEnum):
    """How a solve ended; `sentence` says it."""

    SOLVED = 0
    NOT_FINITE = 1
    NOT_PERIODIC = 2
    UNSTABLE = 3
    UNRESOLVED = 4
    SEPARATES = 5
    STABILITY_UNKNOWN = 6
    LOCKED = 7
    TAKEN_ALONG = 8
    NO_CONTACT = 9
    NOT_CONVERGED = 10
    NO_DESIGN = 11
    BEYOND_FACE = 12
    NOT_SETTLED = 13
    NO_FILM = 14
    UNLOADED = 15
    NO_STEADY_HEAT = 16
    FILM_LOST = 17
    NO_NUMBER = 18
    HELD = 19
    LIES_FLAT = 20

    @property
    def sentence(self) -> str:
        """What the code means."""
        return _SENTENCES[self]

    @property
    def ok(self) -> bool:
        """True where the numbers are those of a solution that is reached."""
        return self is Code.SOLVED


_SENTENCES = {
    Code.SOLVED: "a solution was found",
    Code.NOT_FINITE: "an input is not a finite number, or the mass is not positive",
    Code.NOT_PERIODIC: "no stable motion with the period of the mesh was found",
    Code.UNSTABLE: "a Floquet multiplier is larger than one: disturbances grow, and the balance "
    "cannot be reached",
    Code.UNRESOLVED: "the grid has too few elements for the solution; take more",
    Code.STABILITY_UNKNOWN: "a balance was found; whether it is reached this method cannot say",
    Code.SEPARATES: "a force is negative: the teeth would separate, which this model leaves out",
    Code.LOCKED: "friction locks the mesh: no force moves the load",
    Code.TAKEN_ALONG: "losses beside the teeth take the loaded member along with more than its load; "
    "its other flanks would touch",
    Code.NO_CONTACT: "no contact can carry the load",
    Code.NOT_CONVERGED: "the iteration ended without a solution",
    Code.NO_DESIGN: "the dimensions give no gears that can run",
    Code.BEYOND_FACE: "an elliptic contact is longer than the face has room for, and Hertz's theory ends",
    Code.NOT_SETTLED: "the vibration had not become steady when the longest run ended",
    Code.NO_FILM: "smooth surfaces that neither draw oil in nor approach each other have no film",
    Code.UNLOADED: "no load presses the bodies together",
    Code.NO_STEADY_HEAT: "surfaces that both stand still in their contact have no steady temperature",
    Code.FILM_LOST: "the film of a contact that carries was not solved",
    Code.NO_NUMBER: "an input of the contact is not a finite number",
    Code.LIES_FLAT: "the worn flank comes to lie flat before the cycles are over, and has no depth then",
    Code.HELD: "a law gives more than can be, and its value is held at the limit: what it hangs on does "
    "not move it",
}


class Status(eqx.Module):
    """What became of solves `*b`.

    Attributes:
        code: of `Code`.
        residual: relative error that is left.
        iterations: that it took.
    """

    code: Int[Array, "*b"]
    residual: Float[Array, "*b"]
    iterations: Int[Array, "..."]

    @property
    def sentence(self) -> str:
        """What the worst of the codes means."""
        return Code(int(np.max(np.asarray(self.code)))).sentence


DIRECT: dict[str, Any] = {
    "code": 0,
    "sentence": "computed directly: nothing was solved for",
    "residual": None,
    "iterations": None,
}
"""What stands in a dataset for which nothing was solved."""


def status_summary(status: Status) -> dict[str, Any]:
    """Status of many solves as plain numbers and words, for a dataset.

    Args:
        status: of solves `*b`.

    Example:
        >>> import jax.numpy as jnp
        >>> from pitchpoint.core.status import Code, Status, status_summary
        >>> codes = jnp.array([Code.SOLVED, Code.SOLVED, Code.LOCKED])
        >>> told = status_summary(Status(codes, jnp.array([1e-14, 3e-14, 0.2]), jnp.array(4)))
        >>> told["code"], told["iterations"]
        (7, 4)
        >>> told["sentence"]
        '2 of 3: a solution was found; 1 of 3: friction locks the mesh: no force moves the load'
    """
    return solve_summary(
        np.asarray(status.code), np.asarray(status.residual), np.asarray(status.iterations)
    )


def solve_summary(
    code: np.ndarray, residual: np.ndarray | None = None, iterations: np.ndarray | None = None
) -> dict[str, Any]:
    """The worst code, how many solves ended how, and the largest residual of those that are solved.

    Args:
        code: of `Code`, any shape.
        residual: of each; None where a part does not keep it.
        iterations: most that a solve took; None where a part does not keep them.
    """
    solved = code == Code.SOLVED
    largest = None
    if residual is not None:
        largest = float(np.broadcast_to(residual, code.shape)[solved].max(initial=0.0))
    return {
        "code": int(code.max(initial=0)),
        "sentence": "; ".join(_counted(code)),
        "residual": largest,
        "iterations": None if iterations is None else int(np.max(iterations, initial=0)),
    }


def withheld(codes: np.ndarray, words: Callable[[int, str], tuple[str, str]]) -> list[Doubt]:
    """Doubts on numbers that are not there, one for each way in which solves ended without.

    Args:
        codes: of `Code`, of these solves alone, any shape.
        words: sentence and brief, by how many they are and why.
    """
    every = (
        words(int(count), Code(int(code)).sentence)
        for code, count in zip(*np.unique(codes, return_counts=True), strict=True)
    )
    return [Doubt(sentence, moves=WITHHELD, brief=brief) for sentence, brief in every]


def locked_or_lost(locked: np.ndarray | bool, lost: np.ndarray | bool = False) -> np.ndarray:
    """Codes of balances that friction locks, that were not found, and of all others.

    Args:
        locked: True where friction locks the mesh.
        lost: True where no balance was found otherwise.
    """
    code = np.where(lost, int(Code.NOT_CONVERGED), int(Code.SOLVED))
    return np.where(locked, int(Code.LOCKED), code)


def _counted(codes: np.ndarray) -> Iterator[str]:
    for code, count in zip(*np.unique(codes, return_counts=True), strict=True):
        part = "" if count == codes.size else f"{count} of {codes.size}: "
        yield f"{part}{Code(int(code)).sentence}"

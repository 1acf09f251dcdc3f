"""Many designs built in one call: meshes in groups that share their programs, and what became of each."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Generic, NoReturn, TypeVar

import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import array, jax
from pitchpoint.core.status import Code, Status
from pitchpoint.errors import InputError
from pitchpoint.gears.mesh import Mesh

__all__ = [
    "LEAST",
    "Designs",
    "Faults",
    "Group",
    "Number",
    "check_counts",
    "designs_by_flags",
    "over_designs",
    "padded",
    "select_designs",
]

Number = float | Float[Array, ""]
Faults = Iterator[tuple[Any, Callable[[], NoReturn]]]
"""Conditions, plain or traced, and what tells a plain one in gear words."""

M = TypeVar("M", bound=Mesh)
T = TypeVar("T")


@dataclass(frozen=True, eq=False)
class Group(Generic[M]):
    """Designs of one static structure.

    Attributes:
        mesh: with an axis of designs before all others, as `jax.vmap` takes and gives it.
        numbers: which designs these are.
    """

    mesh: M
    numbers: np.ndarray


@dataclass(frozen=True, eq=False)
class Designs(Generic[M]):
    """Designs that were built together.

    A bad one harms no other: its status says so, its numbers mean nothing, `check` says why.

    Attributes:
        groups: together they hold once each design that could be built; often there is one.
        status: of each design, shape (design,).
        checks: warnings about one design; InputError where it cannot run.
        refused: why the others could not be built, by their numbers.
    """

    groups: tuple[Group[M], ...]
    status: Status
    checks: Callable[[M], Sequence[str]]
    refused: Mapping[int, InputError] = field(default_factory=dict)

    def __len__(self) -> int:
        """Number of designs."""
        return int(np.size(self.status.code))

    def __getitem__(self, number: int) -> M:
        """One design for itself.

        Raises:
            InputError: it could not be built.
            IndexError: there is none of this number.
        """
        if number in self.refused:
            raise self.refused[number]
        for group in self.groups:
            for place in np.flatnonzero(group.numbers == number):
                design: M = jax.tree.map(array, select_designs(group.mesh, int(place)))
                return design
        raise IndexError(f"there are {len(self)} designs, and number {number} is none of them")

    def __iter__(self) -> Iterator[M]:
        """Each design for itself, in order."""
        return (self[number] for number in range(len(self)))

    @property
    def good(self) -> np.ndarray:
        """True for each design that can run, shape (design,)."""
        return np.equal(self.status.code, int(Code.SOLVED))

    def check(self, number: int) -> Sequence[str]:
        """Sentences on what is unusual about one design that can run.

        Raises:
            InputError: it cannot run; with the sentence and the name of the argument to change.
        """
        return self.checks(self[number])

    def sentence(self, number: int) -> str:
        """Why one design cannot run; empty if it can."""
        try:
            self.check(number)
        except InputError as error:
            return str(error)
        return ""


def select_designs(tree: T, where: Any) -> T:
    """Some designs of a batch, as arrays of NumPy."""
    chosen: T = jax.tree.map(lambda leaf: np.asarray(leaf)[where], tree)
    return chosen


LEAST = 64
"""Rows of the smallest batch: one program serves all that have no more designs."""


def padded(tree: T, count: int) -> T:
    """A batch of so many designs with its last one repeated up to 64 or a power of two: few programs."""
    size = max(LEAST, 1 << (count - 1).bit_length())
    return select_designs(tree, np.minimum(np.arange(size), count - 1))


def over_designs(compute: Callable[..., T], tree: Any, axes: int) -> T:
    """What a function of one design gives for all along so many leading axes."""
    for _ in range(axes):
        compute = jax.vmap(compute)
    return compute(tree)


def designs_by_flags(flags: np.ndarray) -> Iterator[tuple[tuple[bool, ...], np.ndarray]]:
    """Rows of flags that occur, and the numbers of the designs that have them.

    Args:
        flags: shape (design, flag).
    """
    codes = flags @ (1 << np.arange(flags.shape[1]))
    for code in np.unique(codes):
        which = np.flatnonzero(codes == code)
        yield tuple(map(bool, flags[which[0]])), which


def check_counts(counts: Mapping[str, int]) -> None:
    """InputError if dimensions were given for different numbers of designs.

    Args:
        counts: of values, by the names of the dimensions that were given one by one.
    """
    if len(set(counts.values())) > 1:
        listing = ", ".join(f"{count} of {key}" for key, count in sorted(counts.items()))
        raise InputError(f"each design needs its own value of a list; given are {listing}")

"""Friction of line contacts from their solved films, as a law that a case may choose."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np
from jax.typing import ArrayLike
from numpy.typing import NDArray

from pitchpoint.core.factored import Numbers
from pitchpoint.core.status import Code
from pitchpoint.errors import ConvergenceError, InputError
from pitchpoint.lubrication.ehl.line import LineContact
from pitchpoint.lubrication.ehl.model import FilmModel
from pitchpoint.lubrication.ehl.solve import Films, solve_lines
from pitchpoint.lubrication.lubrication_registry import FrictionLaw
from pitchpoint.materials.lubricants import Lubricant

__all__ = ["EHL_LINE", "FilmTraction", "ehl_line"]

Each = NDArray[np.float64]


def ehl_line(
    *,
    line_load: Numbers,
    radius: Numbers,
    modulus: Numbers,
    speed_a: Numbers,
    speed_b: Numbers,
    roughness_rq: Numbers,
) -> Numbers:
    """The conditions that a solved film asks for; its coefficient is no formula of them.

    A balance of forces and the films take turns, see `FilmTraction`. What asks for a formula is refused.

    Args:
        line_load: normal load per length of contact line [N/m].
        radius: relative radius of curvature [m].
        modulus: E' [Pa].
        speed_a: surface speed of member 0 relative to the contact [m/s].
        speed_b: surface speed of member 1 relative to the contact [m/s].
        roughness_rq: composite Rq [m].

    Raises:
        InputError: always.
    """
    raise InputError(
        "'ehl_line' solves the film of every contact in turns with the balance of forces, and what is asked "
        "for here takes a friction law that is a formula"
    )


class FilmTraction:
    """Friction of the solved films of an oil: a solver that a balance takes turns with.

    Args:
        model: how films are solved.
        oil: between the flanks.
        temperature: of the oil in the inlet [K].
        rolling: whether rolling resistance is asked for too.
        progress: told the number of films that are solved, of all turns.

    Attributes:
        films: those of the last turn; None before the first.
    """

    def __init__(
        self,
        model: FilmModel,
        oil: Lubricant,
        temperature: ArrayLike,
        *,
        rolling: bool = False,
        progress: Callable[[int], None] | None = None,
    ) -> None:
        self.model, self.oil, self.temperature, self.rolling = model, oil, temperature, rolling
        self.films: Films | None = None
        self._progress, self._done = progress or (lambda _: None), 0

    def __call__(
        self,
        *,
        line_load: Each,
        radius: Each,
        modulus: Each,
        speed_a: Each,
        speed_b: Each,
        roughness_rq: Each,
    ) -> Each:
        """Friction of the oil and of asperities over the load of each contact [contact].

        With rolling resistance on each surface [N/m] it is of shape (2, contact).

        Arguments as in `ehl_line`, NumPy arrays [contact].

        Raises:
            ConvergenceError: a film was not solved.
        """
        contacts = self.model.contacts(
            line_load=line_load,
            radius=radius,
            modulus=modulus,
            speed_a=speed_a,
            speed_b=speed_b,
            oil=self.oil,
            temperature=self.temperature,
            roughness_rq=roughness_rq,
        )
        self.films = self._turn(contacts)
        _demand(self.films)
        film = self.films.film
        friction: Each = np.asarray(film.friction)
        if not self.rolling:
            return friction
        # Against the sense in which the surfaces run.
        return np.stack([friction, np.asarray(film.rolling) * np.sign(speed_a + speed_b)])

    def _turn(self, contacts: LineContact) -> Films:
        progress = lambda done, _: self._progress(self._done + done)  # noqa: E731
        films = solve_lines(contacts, nodes=self.model.nodes, profiles=False, progress=progress)
        self._done += films.solved.size
        return films

    @property
    def warnings(self) -> tuple[str, ...]:
        """What to be wary of about the films of the last turn, in sentences without their stop."""
        return () if self.films is None else self.films.warnings


def _demand(films: Films) -> None:
    """ConvergenceError if a film was not solved, with what became of how many."""
    lost = ~films.solved
    if lost.any():
        worst = Code(int(np.max(np.asarray(films.ended.code))))
        raise ConvergenceError(
            f"the film of {lost.sum()} of {lost.size} contacts that carry was not solved: {worst.sentence}"
        )


EHL_LINE: Final = FrictionLaw(
    name="ehl_line",
    title="Solved film of every line contact (EHL)",
    function=ehl_line,
    sources=("dowson_higginson_1966", "patir_cheng_1978", "greenwood_tripp_1970"),
    note=(
        "Shear of the oil and friction of asperities from pressure and film of each contact, solved in turns"
        " with the balance of forces until both agree to 1e-6; so does their rolling resistance, unless a"
        " case names a model of it. A contact takes about 10 ms a turn: a helical mesh with many slices takes"
        " minutes."
    ),
    shape="line",
    films=FilmModel(),
)
"""Its `films` are the usual choices; a case puts its own in their place."""

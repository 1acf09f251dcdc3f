"""Temperatures of a drive by named thermal resistances, over time and in their steady and periodic states."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import eigh

from pitchpoint.duty_cycle.history import ICE_POINT
from pitchpoint.errors import ConvergenceError, InputError

__all__ = ["AMBIENT", "RunawayError", "ThermalNetwork"]

Floats = NDArray[np.float64]

AMBIENT = "ambient"
"""Name of the air around, whose temperature is given."""

_ROUNDS = 500
"""Rounds of losses and temperatures; what takes more runs away or swings."""

_LONGEST_DECAY = 30.0
"""Exponent of the decay within a piece; e^30 of the last bit is still 1e-3 of what has decayed to e^-30."""

_SETTLED = 1e-7
"""Change of a round at which temperatures have settled [K]."""

_SLOWEST = 0.999
"""Part of the change before beyond which it is not known whether rounds end."""

_HOTTEST = 2000.0
"""Temperature beyond which a body has run away [K]."""


class RunawayError(ConvergenceError):
    """There is no steady temperature.

    Attributes:
        body: the hottest one.
    """

    def __init__(self, body: str) -> None:
        super().__init__(
            f"there is no steady temperature below {_HOTTEST - ICE_POINT:.0f} degC: more is lost than the "
            f"resistances carry away, or losses grow faster with the temperature, first at {body}"
        )
        self.body = body


@dataclass(frozen=True)
class ThermalNetwork:
    """Bodies that store heat, with resistances between them and to the air around.

    Attributes:
        capacities: heat capacity of each body by name [J/K].
        resistances: between two names, one of which may be "ambient" [K/W].
        ambient: temperature of the air [K].

    Temperatures of bodies are uniform; radiation is part of its resistance, so that it is linear.

    Raises:
        InputError: a resistance between unknown bodies or a body and itself, a body without a way to the air,
            what is not above zero.

    From C dT/dt = heat - sum of (T - T of the neighbour)/R.

    Example:
        >>> drive = ThermalNetwork(
        ...     {"gears": 120.0, "housing": 800.0},
        ...     {("gears", "housing"): 0.6, ("housing", "ambient"): 1.5},
        ... )
        >>> (drive.steady({"gears": 15.0, "housing": 6.0}) - drive.ambient).round(6).tolist()
        [40.5, 31.5]
        >>> [round(seconds, 2) for seconds in drive.time_constants.tolist()]
        [1389.83, 62.17]
    """

    capacities: Mapping[str, float]
    resistances: Mapping[tuple[str, str], float]
    ambient: float = 293.15

    def __post_init__(self) -> None:
        if not self.capacities:
            raise InputError("needs one body at least", key="capacities")
        if AMBIENT in self.capacities:
            raise InputError(
                f'"{AMBIENT}" is the air around, whose temperature is given; a body has another name',
                key="capacities",
            )
        for body, capacity in self.capacities.items():
            if not 0.0 < capacity < np.inf:
                raise InputError(
                    f"{capacity} was given for {body}; it is above 0", key="capacities"
                )
        for (from_body, to_body), resistance in self.resistances.items():
            unknown = [
                body for body in (from_body, to_body) if body not in (*self.capacities, AMBIENT)
            ]
            if unknown or from_body == to_body:
                bodies = ", ".join([*self.capacities, AMBIENT])
                raise InputError(
                    f"a resistance is between two of {bodies}, and {from_body} and {to_body} were given",
                    key="resistances",
                )
            if not 0.0 < resistance < np.inf:
                raise InputError(
                    f"{resistance} was given between {from_body} and {to_body}; it is above 0",
                    key="resistances",
                )
        self._demand_ways()

    def _demand_ways(self) -> None:
        reached = {AMBIENT}
        for _ in self.capacities:
            reached |= {end for ways in self.resistances if reached & {*ways} for end in ways}
        if alone := [body for body in self.capacities if body not in reached]:
            raise InputError(
                f"there is no way for the heat from {alone[0]} to ambient", key="resistances"
            )

    @cached_property
    def bodies(self) -> tuple[str, ...]:
        """Names in the order in which arrays have them."""
        return tuple(self.capacities)

    @cached_property
    def _conductances(self) -> Floats:
        """Heat that leaves each body for a degree of each body [W/K]."""
        place = {body: at for at, body in enumerate(self.bodies)}
        matrix = np.zeros((len(place), len(place)))
        for ways, resistance in self.resistances.items():
            inner = [place[end] for end in ways if end != AMBIENT]
            for at in inner:
                matrix[at, at] += 1.0 / resistance
            for at, neighbour in (inner, inner[::-1]) if len(inner) == 2 else ():
                matrix[at, neighbour] -= 1.0 / resistance
        return matrix

    @cached_property
    def _modes(self) -> tuple[Floats, Floats]:
        """Rates of decay [1/s] and shapes with unit heat capacity, of the symmetric pair of matrices."""
        rates, shapes = eigh(self._conductances, np.diag([*self.capacities.values()]))
        return rates, shapes

    @property
    def time_constants(self) -> Floats:
        """Of the modes, longest first, shape (b,) [s]."""
        return np.asarray(1.0 / self._modes[0], float)

    def steady(self, heat: Mapping[str, float] | ArrayLike) -> Floats:
        """Temperatures under constant heat, shape (b,) [K].

        Args:
            heat: into each body, none where a name is missing [W].
        """
        rise = np.linalg.solve(self._conductances, self._ordered(heat))
        return np.asarray(self.ambient + rise, float)

    def steady_with(self, heat: Callable[[Floats], Floats]) -> Floats:
        """Temperatures under heat that depends on them, shape (b,) [K].

        Args:
            heat: into each body at temperatures [K] of the bodies, both of shape (b,) [W].

        Raises:
            RunawayError: there is no steady state, since heat grows faster than it leaves.
        """
        return self._settled(
            lambda now: self.steady(heat(now)), np.full(len(self.bodies), self.ambient)
        )

    def course(self, start: Floats, durations: Floats, heat: Floats) -> Floats:
        """Temperatures at the ends of steps with constant heat in each, exact, shape (n, b) [K].

        Args:
            start: at the beginning, shape (b,) [K].
            durations: of the steps, shape (n,) [s].
            heat: into each body in each step, shape (n, b) [W].
        """
        _, shapes = self._modes
        masses = np.array([*self.capacities.values()])
        modal = self._amplitudes((start - self.ambient) * masses @ shapes, durations, heat)
        rise: Floats = np.einsum("mn,bm->nb", modal, shapes)
        return self.ambient + rise

    def periodic(self, durations: Floats, heat: Floats) -> Floats:
        """Temperatures at the begin of a cycle that comes back to them, shape (b,) [K].

        Args:
            durations: of its steps, shape (n,) [s].
            heat: into each body in each step, shape (n, b) [W].
        """
        rates, shapes = self._modes
        after = self._amplitudes(np.zeros_like(rates), durations, heat)[:, -1]
        rise: Floats = shapes @ (after / -np.expm1(-rates * durations.sum()))
        return self.ambient + rise

    def _amplitudes(self, begin: Floats, durations: Floats, heat: Floats) -> Floats:
        """Of the modes at the ends of steps, shape (m, n)."""
        rates, shapes = self._modes
        # Not by @: threads of the linear algebra cost more than these few columns.
        into = np.einsum("nb,bm->mn", heat, shapes / rates)
        forced = -np.expm1(-np.outer(rates, durations)) * into
        rows = zip(begin, rates, forced, strict=True)
        return np.stack(
            [_decaying(amplitude, rate * durations, adds) for amplitude, rate, adds in rows]
        )

    def periodic_with(self, durations: Floats, heat: Callable[[Floats], Floats]) -> Floats:
        """Periodic temperatures under heat that depends on them, in the middle of steps, shape (n, b) [K].

        Args:
            durations: of the steps of a cycle, shape (n,) [s].
            heat: into each body in each step at the temperatures in the middle of steps, both (n, b) [W].

        Raises:
            RunawayError: heat grows faster than it leaves.
        """

        def again(middle: Floats) -> Floats:
            warm = heat(middle)
            begin = self.periodic(durations, warm)
            ends = np.vstack([begin[None], self.course(begin, durations, warm)])
            return 0.5 * (ends[1:] + ends[:-1])

        cold = np.full((durations.size, len(self.bodies)), self.ambient)
        return self._settled(again, cold)

    def _settled(self, again: Callable[[Floats], Floats], start: Floats) -> Floats:
        """Where temperatures and their losses agree, from the cold: of several the coolest, which is stable.

        A round whose change is a part of that before, as those towards a stable state are, goes on to where
        such rounds end (Irons and Tuck 1969).
        """
        now, changes = start, [np.zeros_like(start)]
        for _ in range(_ROUNDS):
            following = again(now)
            change = following - now
            if not np.isfinite(change).all() or following.max() > _HOTTEST:
                break
            if np.abs(change).max() < _SETTLED:
                return following
            before = changes[-1]
            part = float((change * before).sum() / max((before * before).sum(), 1e-300))
            steady = before.any() and -1.0 < part < _SLOWEST
            now = following + change * part / (1.0 - part) if steady else following
            changes.append(0.0 * change if steady else change)
        raise RunawayError(self.bodies[int(np.argmax(np.atleast_2d(now).max(axis=0)))])

    def _ordered(self, heat: Mapping[str, float] | ArrayLike) -> Floats:
        if isinstance(heat, Mapping):
            for body in heat:
                if body not in self.capacities:
                    raise InputError(
                        f"there is no body {body}, but {', '.join(self.bodies)}", key="heat"
                    )
            return np.array([heat.get(body, 0.0) for body in self.bodies])
        return np.asarray(heat, float)


def _decaying(begin_value: float, exponents: Floats, adds: Floats) -> Floats:
    """x_k = e^(-exponents_k) x_(k-1) + adds_k from x_0 = begin_value, shape (n,).

    Sums of adds over their decay run over pieces in which that is at least e^-30, lest it underflows.
    """
    passed = np.cumsum(exponents)
    values, begin = np.empty_like(adds), 0
    while begin < adds.size:
        before = passed[begin - 1] if begin else 0.0
        end = max(int(np.searchsorted(passed, before + _LONGEST_DECAY, "right")), begin + 1)
        decay = np.exp(before - passed[begin:end])
        if end == begin + 1:
            values[begin] = begin_value * decay[0] + adds[begin]
        else:
            values[begin:end] = decay * (begin_value + np.cumsum(adds[begin:end] / decay))
        begin_value, begin = values[end - 1], end
    return values

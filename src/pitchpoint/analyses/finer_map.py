"""A loss map with values between its nodes, by the powers that losses follow there."""

import numpy as np
from scipy.interpolate import PchipInterpolator

from pitchpoint.efficiency.loss_table import LOCKED

__all__ = ["finer_map"]

HALVINGS = 3
"""Times that the least load is halved, below which what is lost is a straight line."""

PARTS = 3
"""Into which each step is cut, of loads and speeds at equal ratios.

Of an odd number the point half way lies in the middle of one, where a straight line is off most."""

RISES = 1e-6
"""Part of what is lost that a load has to add, for the power of the load to be told from rounding."""

Values = np.ndarray
"""Over law, torque, speed, temperature."""


def finer_map(
    torques: np.ndarray, speeds: np.ndarray, degrees: np.ndarray, lost: Values
) -> tuple[np.ndarray, np.ndarray, np.ndarray, Values]:
    """Axes and torques that are lost, with others between that of the nodes.

    Friction by a law grows with powers of load, speed and viscosity, which falls with the temperature about
    as an exponential: a monotone cubic of logarithms is exact for a power, where a straight line is 15 %
    off half way from no load to the first one at a power of 1.2. Without load drag is left, so that what a
    load adds to it is taken. Where something is not known at one of two neighbours, it is not known between
    them; where a logarithm has no meaning, the straight line is left.

    Args:
        torques: of the output, ascending, none and as many negative ones as positive [torque].
        speeds: ascending from rest, which stays as it is [speed].
        degrees: temperatures, ascending [temperature].
        lost: torque that is lost [law, torque, speed, temperature]; `LOCKED` or NaN where there is none.

    Returns:
        The same with more nodes; all of the given ones are among them, with their values.

    Raises:
        ValueError: no torque is not in the middle.

    Example:
        >>> import numpy as np
        >>> load, pace, degree = np.arange(-2.0, 3.0), np.array([0.0, 1.0]), np.array([300.0])
        >>> lost = (0.5 + np.abs(load) ** 1.2)[None, :, None, None] * np.ones((1, 1, 2, 1))
        >>> torques, *_, values = finer_map(load, pace, degree, lost)
        >>> bool(np.allclose(values[0, :, 1, 0], 0.5 + np.abs(torques) ** 1.2, rtol=1e-3))
        True
    """
    if torques.size < 3 or torques[torques.size // 2] != 0.0:
        raise ValueError("no torque has to be in the middle")
    torques, lost = _under_loads(torques, lost)
    moving = speeds[1:]
    places = _cut(np.log(moving))
    faster = _along(np.log(moving), lost[:, :, 1:].swapaxes(2, 3), places).swapaxes(2, 3)
    warmer = _cut(degrees)
    lost = _along(degrees, np.concatenate([lost[:, :, :1], faster], axis=2), warmer)
    between = np.exp(places)
    between[:: PARTS if moving.size > 1 else 1] = moving
    return torques, np.append(0.0, between), warmer, lost


def _cut(nodes: np.ndarray) -> np.ndarray:
    """Nodes with others between, at equal steps."""
    steps = np.linspace(nodes[:-1], nodes[1:], PARTS, endpoint=False, axis=1)
    return np.append(steps.ravel(), nodes[-1])


def _along(nodes: np.ndarray, values: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Values at places between nodes of the last axis, by a monotone cubic of their logarithms."""
    if nodes.size < 2:
        return values
    usable = (values > 0.0).all(axis=-1, keepdims=True)
    logs = np.log(np.where(usable, values, 1.0))
    curve = np.exp(PchipInterpolator(nodes, logs, axis=-1)(places))
    straight = _straight(nodes, values, places)
    at_node = np.isin(places, nodes)
    return np.where(usable & ~at_node, curve, straight)


def _straight(nodes: np.ndarray, values: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Values by a straight line between neighbours; locked or NaN where one of them is that counts."""
    low = np.clip(np.searchsorted(nodes, places, "right") - 1, 0, nodes.size - 2)
    weight = (places - nodes[low]) / (nodes[low + 1] - nodes[low])
    left, right = values[..., low], values[..., low + 1]
    line = left + weight * (right - left)
    line = np.where((left < 0.0) | (right < 0.0), LOCKED, line)
    return np.where(weight == 0.0, left, np.where(weight == 1.0, right, line))


def _under_loads(torques: np.ndarray, lost: Values) -> tuple[np.ndarray, Values]:
    """Torques of either sign with others between, and what is lost under them."""
    loads, none = torques[torques > 0.0], torques.size // 2
    light = loads[0] * 0.5 ** np.arange(HALVINGS, 0, -1)
    places = np.append(light, np.exp(_cut(np.log(loads))))
    places[HALVINGS::PARTS] = loads
    turned = np.moveaxis(lost, 1, -1)
    back, idle, forth = turned[..., none::-1], turned[..., none : none + 1], turned[..., none:]
    sides = [_one_way(np.append(0.0, loads), branch, places) for branch in (back, forth)]
    losses = np.concatenate([sides[0][..., ::-1], idle, sides[1]], axis=-1)
    return np.concatenate([-places[::-1], [0.0], places]), np.moveaxis(losses, -1, 1)


def _one_way(loads: np.ndarray, values: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Values under loads from zero on: what a load adds to that without any, by powers of the load."""
    straight = _straight(loads, values, places)
    rise = values[..., 1:] - values[..., :1]
    defined = (values >= 0.0).all(axis=-1, keepdims=True)
    usable = defined & (rise > RISES * values[..., 1:]).all(axis=-1, keepdims=True)
    if loads.size < 3:
        return straight
    nodes, at = np.log(loads[1:]), np.log(places)
    curve = PchipInterpolator(nodes, np.log(np.where(usable, rise, 1.0)), axis=-1)
    within = curve(np.maximum(at, nodes[0]))
    # Nothing that rises towards no load: where more load adds less, what is below is the first one's.
    slope = np.maximum(curve(nodes[0], 1)[..., None], 0.0)
    below = slope * np.minimum(at - nodes[0], 0.0)
    added = values[..., :1] + np.exp(within + below)
    return np.where(usable & ~np.isin(places, loads), added, straight)

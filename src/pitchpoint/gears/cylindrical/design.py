"""Cylindrical pairs from what an engineer knows of them, one at a time or many in one call."""

import dataclasses
from collections.abc import Callable, Iterator
from functools import partial
from inspect import signature
from typing import Any

import numpy as np
from jaxtyping import Array

from pitchpoint._jax import array, jax, jnp
from pitchpoint.core.programs import program
from pitchpoint.core.status import Code, Status
from pitchpoint.errors import InputError
from pitchpoint.gears.contact_lines import LARGEST_CONTACT_RATIO, SLICES, lanes_for_contact_ratio
from pitchpoint.gears.cylindrical.checks import cannot_run, check_cylindrical
from pitchpoint.gears.cylindrical.pair import CylindricalPair
from pitchpoint.gears.design_groups import (
    Designs,
    Group,
    check_counts,
    designs_by_flags,
    over_designs,
    padded,
    select_designs,
)
from pitchpoint.gears.involute import usual_dedenda

__all__ = [
    "build_cylindrical_pair",
    "build_cylindrical_pairs",
    "cylindrical_pairs_apart",
    "designed_pair",
    "with_bores",
]

RIM_RATIO = 1.0 / 0.3
"""Root radius over bore radius where no bore is given."""

RING_RIM_RATIO = 1.2
"""Outer over root radius of a ring where it is not given."""

_OF_BOTH = (
    "teeth",
    "profile_shift",
    "addendum",
    "dedendum",
    "fillet_radius",
    "tip_alteration",
    "rim_ratio",
    "infeed",
)
Values = dict[str, Any]
Grown = tuple[CylindricalPair, Array | np.ndarray, np.ndarray]


def build_cylindrical_pair(
    *,
    teeth: tuple[int, int],
    module: float,
    pressure_angle: float,
    face_width: float,
    helix_angle: float = 0.0,
    profile_shift: tuple[float, float] = (0.0, 0.0),
    addendum: tuple[float, float] = (1.0, 1.0),
    dedendum: tuple[float, float] | None = None,
    fillet_radius: tuple[float, float] = (0.38, 0.38),
    tip_alteration: tuple[float, float] | None = None,
    least_tip: float = 0.0,
    centre_distance: float | None = None,
    rim_ratio: tuple[float, float] | None = None,
    infeed: tuple[float, float] = (0.0, 0.0),
    cutter_teeth: float | None = None,
    cutter_shift: float | None = None,
    right_flank: bool = False,
    slices: int = SLICES,
) -> CylindricalPair:
    """Pair from what an engineer knows; the rest by ISO 21771.

    Args:
        teeth: z1, z2; z2 negative for a ring with internal teeth.
        module: normal module [m].
        face_width, centre_distance: [m]; without backlash if no centre distance is given.
        pressure_angle, helix_angle: of the basic rack and of the reference cylinders [rad].
        profile_shift: x1, x2.
        addendum, dedendum, fillet_radius: of the basic racks in modules; dedendum defaults to the
            addendum of the mate + 0.25, see `usual_dedenda`.
        tip_alteration: k1, k2; keeps the rack's tip clearance by default.
        least_tip: thickness in the normal section, in modules, to which tips that would be thinner
            are shortened; for tip alterations that are not given.
        rim_ratio: root radius over bore radius of each gear; outer over root radius of a ring.
        infeed: x_E - x, by which both gears are cut beyond their profile shifts; tips stay where they are.
        cutter_teeth, cutter_shift: z_0 and x_0 of the pinion cutter of a ring; both or none.
        right_flank: True if the right flanks of both gears touch.
        slices: of each contact line, for helical gears; even, or one for its middle alone.

    Raises:
        InputError: the flanks cannot meet at all; `check_cylindrical` says what else is wrong.

    Example:
        >>> from math import radians
        >>> pair = build_cylindrical_pair(
        ...     teeth=(18, 36), module=3e-3, pressure_angle=radians(20.0), face_width=0.02
        ... )
        >>> round(float(pair.centre_distance), 6)
        0.081
    """
    arguments = dict(locals())
    helical, internal = bool(helix_angle != 0.0), bool(teeth[1] < 0)
    ((pair, contact_ratio, _),) = _grown(_opened(arguments, helical, internal), axes=0)
    ratio = float(contact_ratio)
    if not _in_reach(ratio):
        check_cylindrical(pair)  # says why, in gear words
    return dataclasses.replace(pair, lanes=lanes_for_contact_ratio(ratio, helical=helical))


def with_bores(pair: CylindricalPair, bores: tuple[float, float] | None) -> CylindricalPair:
    """The pair with the bodies under its teeth as bored; of a ring it is its outer diameter.

    Args:
        pair: of gears.
        bores: diameters of both [m]; as usual if None.

    Raises:
        InputError: a bore that leaves no body.
    """
    if bores is None:
        return pair
    rim_ratios = []
    for number, (gear, bore) in enumerate(zip(pair.gears, bores, strict=True), 1):
        root = 2.0 * abs(float(gear.root_radius))
        ratio = bore / root if gear.internal else root / bore
        if ratio <= 1.0:
            side = "larger" if gear.internal else "smaller"
            raise InputError(
                f"the bore diameter of gear {number} is {1e3 * bore:.6g} mm; it must be {side} than "
                f"its root circle, {1e3 * root:.6g} mm",
                key="bore_diameter",
            )
        rim_ratios.append(ratio)
    return dataclasses.replace(pair, rim_ratio=jnp.asarray(rim_ratios))


def build_cylindrical_pairs(**values: Any) -> Designs[CylindricalPair]:
    """Many pairs in one call, each as `build_cylindrical_pair` builds it.

    Args:
        values: the arguments of `build_cylindrical_pair`, each as there, common to all designs, or an
            array with an axis of designs before its own. `slices` is common to all.

    Returns:
        Pairs in groups that are spur or helical, external or internal, undercut or not, shortened or not
        on each gear; a group holds as many pairs of teeth as its largest contact ratio asks for. The status
        of each design says whether it can run, `Designs.check` why not.

    Raises:
        InputError: arrays for different numbers of designs.

    Example:
        >>> import numpy as np
        >>> shifts = np.stack([np.linspace(0.0, 0.5, 6), np.zeros(6)], axis=1)
        >>> designs = build_cylindrical_pairs(
        ...     teeth=(18, 36),
        ...     module=3e-3,
        ...     pressure_angle=np.radians(20.0),
        ...     face_width=0.02,
        ...     profile_shift=shifts,
        ... )
        >>> bool(designs.good.all())
        True
        >>> [round(1e3 * float(pair.centre_distance), 2) for pair in designs][:3]
        [81.0, 81.3, 81.58]
    """
    groups = [Group(_with_lanes(pair, ratio), which) for pair, ratio, which in _groups(values)]
    order = np.argsort(np.concatenate([group.numbers for group in groups]))
    each_status = [_over(_judged, _plain(group.mesh), axes=1) for group in groups]
    status: Status = jax.tree.map(lambda *parts: np.concatenate(parts)[order], *each_status)
    return Designs(tuple(groups), status, check_cylindrical)


def cylindrical_pairs_apart(
    **values: Any,
) -> Iterator[tuple[Group[CylindricalPair], list[CylindricalPair | None]]]:
    """Groups as those of `build_cylindrical_pairs`, and each pair of them as `build_cylindrical_pair` has it.

    Pairs hold arrays of NumPy; there is None in the place of one whose flanks cannot meet.
    """
    for batch, ratio, which in _groups(values):
        lanes = [
            lanes_for_contact_ratio(contact_ratio, helical=batch.helical)
            if _in_reach(contact_ratio)
            else 0
            for contact_ratio in np.asarray(ratio).tolist()
        ]
        structures = {
            count: jax.tree.structure(_replaced(batch, 1, lanes=count)) for count in {*lanes} - {0}
        }
        leaves = [np.asarray(leaf) for leaf in jax.tree.leaves(batch)]
        pairs = [
            jax.tree.unflatten(structures[count], [leaf[row, ...] for leaf in leaves])
            if count
            else None
            for row, count in enumerate(lanes)
        ]
        yield Group(batch, which), pairs


def _groups(values: Values) -> Iterator[Grown]:
    """Batches of pairs of one static structure, their contact ratios, and which designs they are."""
    bound = signature(build_cylindrical_pair).bind(**values)
    bound.apply_defaults()
    slices = bound.arguments.pop("slices")
    table = _table(bound.arguments)
    flags = np.stack([table["helix_angle"] != 0.0, table["teeth"][:, 1] < 0], axis=1)
    for kind, numbers in designs_by_flags(flags):
        opened = _opened(_of(table, numbers) | {"slices": slices}, *kind)
        for pair, ratio, which in _grown(opened, axes=1):
            yield pair, ratio, numbers[which]


def designed_pair(pair: CylindricalPair) -> tuple[CylindricalPair, Status]:
    """The pair with all that follows from its dimensions, and whether it can run.

    A pure function that can be traced, vectorised and differentiated: `jax.vmap` makes it that of a batch.

    Args:
        pair: with its dimensions and its static structure, as `build_cylindrical_pairs` finds it.

    Returns:
        The pair, and the status: no number of it comes from an iteration that may fail, so a code alone.
    """
    pair = pair.completed()
    pair = _crossed(pair) if any(pair.undercut) else pair
    code = jnp.where(cannot_run(pair), int(Code.NO_DESIGN), int(Code.SOLVED))
    return pair, Status(code, jnp.zeros(()), jnp.asarray(0))


def _table(given: Values) -> Values:
    """Arguments with an axis of designs before their own; those that are not given stay None.

    Raises:
        InputError: arrays for different numbers of designs.
    """
    table: Values = {
        key: None if value is None else np.asarray(value) for key, value in given.items()
    }
    shapes = {key: (2,) if key in _OF_BOTH else () for key in table}
    of_designs = {key for key, value in table.items() if np.ndim(value) > len(shapes[key])}
    counts = {key: np.shape(table[key])[0] for key in of_designs}
    check_counts(counts)
    count = max(counts.values(), default=1)
    return {
        key: None if value is None else np.broadcast_to(value, (count, *shapes[key]))
        for key, value in table.items()
    }


def _of(table: Values, numbers: np.ndarray) -> Values:
    """Arguments of some designs."""
    return {key: None if value is None else value[numbers] for key, value in table.items()}


def _opened(given: Values, helical: bool, internal: bool) -> CylindricalPair:
    """Pairs with what is given of them; what follows is still open.

    Args:
        given: arguments of `build_cylindrical_pair`, all with the same leading axes.
        helical, internal: common to them.
    """
    values = {key: value for key, value in given.items() if value is not None}
    slices = values.pop("slices")
    of_both = np.asarray(values["addendum"], dtype=float)
    angle = np.asarray(values["pressure_angle"], dtype=float)
    rims = RIM_RATIO, RING_RIM_RATIO if internal else RIM_RATIO
    usual: Values = {
        "dedendum": usual_dedenda(of_both, ring=internal),
        "tip_alteration": np.zeros_like(of_both),
        "centre_distance": np.zeros_like(angle),
        "rim_ratio": np.broadcast_to(rims, of_both.shape),
        "crossing": np.stack([angle, angle], axis=-1),
    }
    flags = {
        "right_flank": np.asarray(values.pop("right_flank"), dtype=bool),
    }
    static: dict[str, Any] = {
        "follows": (given["centre_distance"] is None, given["tip_alteration"] is None),
        "shortened": (False, False),
        "undercut": (False, False),
        "helical": helical,
        "internal": internal,
        "lanes": 2,
        "slices": slices if helical else 1,
    }
    numbers: Values = {key: array(value, jnp.float64) for key, value in (usual | values).items()}
    arrays = numbers | {key: array(value) for key, value in flags.items()}

    def one(parts: Values) -> CylindricalPair:
        return CylindricalPair(**parts, **static)

    return over_designs(one, arrays, angle.ndim)


def _grown(pair: CylindricalPair, axes: int) -> Iterator[Grown]:
    """Pairs with all that follows, by what is undercut or shortened, contact ratios, and which ones they are.

    Args:
        pair: still open, with so many leading axes, none or one.
        axes: their number.
    """
    pair, ratio, limit, thickness = _over(_complete, pair, axes)
    undercut = np.asarray(pair.profile_shift) + np.asarray(pair.infeed) < np.asarray(limit)
    undercut &= (True, not pair.internal)
    least = np.asarray(pair.least_tip)[..., None] if pair.follows[1] else 0.0
    short = (least > 0.0) & (np.asarray(thickness) < least)
    flags = np.concatenate([undercut, short], axis=-1).reshape(-1, 4)
    for (pinion_undercut, wheel_undercut, *shortened), which in designs_by_flags(flags):
        part, part_ratio = (select_designs((pair, ratio), which)) if axes else (pair, ratio)
        if pinion_undercut or wheel_undercut:
            cut = _replaced(part, axes, undercut=(pinion_undercut, wheel_undercut))
            part, part_ratio = _over(_with_crossings, cut, axes)
        if any(shortened):
            shorter = _replaced(part, axes, shortened=tuple(shortened))
            part, part_ratio, _, _ = _over(_complete, shorter, axes)
        yield part, part_ratio, which


def _replaced(pair: CylindricalPair, axes: int, **static: Any) -> CylindricalPair:
    replaced: Callable[[CylindricalPair], CylindricalPair] = partial(dataclasses.replace, **static)
    return over_designs(replaced, pair, axes)


def _plain(pair: CylindricalPair) -> CylindricalPair:
    """A batch without what is of no account to its dimensions: few programs."""
    return _replaced(pair, 1, lanes=2, slices=1)


def _with_lanes(pair: CylindricalPair, ratio: Array | np.ndarray) -> CylindricalPair:
    """A batch with places for the pairs of its largest contact ratio."""
    ratios_in_reach = [value for value in np.asarray(ratio).tolist() if _in_reach(value)]
    return _replaced(
        pair,
        1,
        lanes=lanes_for_contact_ratio(max(ratios_in_reach, default=1.0), helical=pair.helical),
    )


def _in_reach(ratio: float) -> bool:
    return 0.0 < ratio < LARGEST_CONTACT_RATIO


def _over(compute: Callable[[CylindricalPair], Any], pair: CylindricalPair, axes: int) -> Any:
    """Results of a program for one pair or for a batch."""
    if not axes:
        return compute(pair)
    count = len(pair.module)
    return select_designs(compute(padded(pair, count)), slice(count))


@program
def _complete(
    pair: CylindricalPair,
) -> tuple[CylindricalPair, Array, Array, Array]:
    """Pair with the dimensions that follow, contact ratio, undercut limits, tip thicknesses in modules."""

    def alone(design: CylindricalPair) -> tuple[CylindricalPair, Array, Array, Array]:
        design = design.completed()
        return (
            design,
            design.contact_ratio,
            jnp.stack([gear.undercut_limit for gear in design.gears]),
            jnp.stack([gear.tip_thickness for gear in design.gears]) / design.module,
        )

    return over_designs(alone, pair, pair.module.ndim)


@program
def _with_crossings(pair: CylindricalPair) -> tuple[CylindricalPair, Array]:
    def alone(design: CylindricalPair) -> tuple[CylindricalPair, Array]:
        design = _crossed(design)
        return design, design.contact_ratio

    return over_designs(alone, pair, pair.module.ndim)


@program
def _judged(pair: CylindricalPair) -> Status:
    return over_designs(lambda one: designed_pair(one)[1], pair, pair.module.ndim)


def _crossed(pair: CylindricalPair) -> CylindricalPair:
    """The pair with the places where undercuts cross its flanks."""
    crossings = [gear.crossing_angle() if gear.undercut else gear.crossing for gear in pair.gears]
    return dataclasses.replace(pair, crossing=jnp.stack(crossings))

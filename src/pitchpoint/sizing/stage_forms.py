"""Gears of a stage without a size: built once at a module of a millimetre, rated at any size and load.

Angles, tooth forms and contact ratios do not hang on the size, lengths go with the module or the face width.
So many sizes are rated from few built gears, by the formulas that rate every case.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import equinox as eqx
import jax
import numpy as np
from jaxtyping import Float, Int

from pitchpoint._jax import jnp
from pitchpoint.analyses.analysis import silent
from pitchpoint.analyses.analysis_registry import REFLECTED
from pitchpoint.analyses.inspection import inspection_part
from pitchpoint.analyses.strength import rating_inputs
from pitchpoint.cases.built_drive import Ready
from pitchpoint.core.programs import program
from pitchpoint.errors import InputError
from pitchpoint.gears.contact_lines import PitchPoint, pitch_point
from pitchpoint.gears.cylindrical.din_3967 import thickness_allowances
from pitchpoint.gears.rated_pair import RatedPair, bare_pair, rated_pair
from pitchpoint.lubrication.friction_coefficient import iso_tr_14179_2
from pitchpoint.runs.run import load_case
from pitchpoint.sizing.task_table import Task
from pitchpoint.sizing.three_k import mesh_efficiency, three_k_efficiencies
from pitchpoint.strength.rating import ROWS, ratings

__all__ = [
    "FIELD",
    "Form",
    "Forms",
    "Sized",
    "case_of",
    "formed",
    "gears_as_discs",
    "running_tables",
]

Tree = dict[str, Any]
Values = Float[np.ndarray, " option"]
Numbers = Int[np.ndarray, " option"]

FIELD, CENTRE_FIELD = "e24", "js7"
"""Fields of tooth thickness (DIN 3967) and of centre distance (ISO 286) of all gears."""

ROUGHNESS = 0.4e-6
"""Ra of all flanks [m]."""

MODULE, WIDTH, TORQUE, SPEED = 1e-3, 10e-3, 100.0, 10.0
"""Module and face width [m], torque at the output [N m] and speed of the input [rad/s] of forms as built."""

ROUNDED = 1e-4
"""To which face widths are rounded up [m]."""

LEAST_WIDTH, MOST_WIDTH = 6.0, 30.0
"""Face widths over modules between which they are chosen."""

STEPS = 6
"""Of the search for a width: safeties of flanks go with its root, those of roots with itself, but for K_v and
the overlap of helical teeth."""


@dataclass(frozen=True, eq=False)
class Form:
    """Gears of a stage without a size.

    Attributes:
        kind: "pair", "planetary", "stepped" or "3K".
        gears: their table in a case file, without module and face width.
        built: at `MODULE` and `WIDTH`.
        ratio: speed of the input over that of the output, in size.
    """

    kind: str
    gears: Tree
    built: Ready
    ratio: float

    def table(self, module: float, width: float) -> Tree:
        """Table of the gears at a module and a face width [m]."""
        return sized_table(self.gears, module, width)


def sized_table(gears: Tree, module: float, width: float) -> Tree:
    """A table of gears with a module and a face width [m]."""
    across = f"{1e3 * width:.6g} mm"
    table = gears | {"module": f"{1e3 * module:.6g} mm", "face_width": across}
    if "second" in gears:
        table["second"] = gears["second"] | {"face_width": across}
    return table


def case_of(task: Task, stages: Sequence[Tree], torque: float, speed: float) -> Tree:
    """Tables of a case of some stages.

    Args:
        task: what is asked.
        stages: tables of gears, from the input.
        torque: at the output [N m].
        speed: of the input [rad/s].
    """
    gears = {"gears": stages[0]} if len(stages) == 1 else {"stages": [{"gears": g} for g in stages]}
    return {
        **gears,
        "materials": {"gear_1": task.material, "gear_2": task.material},
        "strength": {"life": f"{task.life / 3600.0:.12g} h", **_load_factors(task)},
        **running_tables(task, torque, speed),
        "models": {"friction": "iso_tr_14179_2"},
    }


def _load_factors(task: Task) -> Tree:
    """Keys of [strength] for the load factors of a task that are not 1."""
    factors = {name: getattr(task, name) for name in ("application_factor", "face_load_factor")}
    return {name: value for name, value in factors.items() if value != 1.0}


def running_tables(task: Task, torque: float, speed: float) -> Tree:
    """Tables of a case of any family that say how it runs: oil, roughness, operation; see `case_of`."""
    return {
        "lubricant": {"name": task.lubricant},
        "roughness": {"ra": f"{1e6 * ROUGHNESS:g} um"},
        "operation": {
            "torque": f"{torque:.12g} N m",
            "speed": f"{speed:.12g} rad/s",
            "temperature": f"{task.temperature - 273.15:.12g} degC",
        },
    }


def formed(task: Task, kind: str, gears: Tree) -> Form | None:
    """A form as every case is built; None where its gears cannot run.

    Args:
        task: what is asked.
        kind: of the form.
        gears: without module and face width.
    """
    tree = case_of(task, [sized_table(gears, MODULE, WIDTH)], TORQUE, SPEED)
    try:
        built = load_case(tree)
    except InputError:
        return None
    return Form(kind, gears, built, abs(1.0 / built.output_rate))


@dataclass(frozen=True, eq=False)
class Sized:
    """Stages with a size; arrays over options.

    Attributes:
        form: number of the form.
        module, width: [m].
        flank, root: least safeties.
        loss: part of the power that is lost between the teeth.
        mass: of the gears [kg].
        diameter, length: of the gears [m]; `spans` has the parts of the former.
        distance: centre distance [m].
        torque: at the output of the stage [N m].
    """

    form: Numbers
    module: Values
    width: Values
    flank: Values
    root: Values
    loss: Values
    mass: Values
    diameter: Values
    length: Values
    distance: Values
    torque: Values

    def __getitem__(self, chosen: Any) -> "Sized":
        return Sized(*(values[chosen] for values in vars(self).values()))

    def __len__(self) -> int:
        return len(self.form)


class Forms:
    """Forms that are rated together.

    Args:
        task: what is asked.
        forms: some.
    """

    def __init__(self, task: Task, forms: Sequence[Form]) -> None:
        self.task, self.forms = task, tuple(forms)
        self.ratio = np.array([form.ratio for form in forms])
        self._rows = [[row for _, row in rating_inputs(form.built)] for form in forms]
        flat = [(k, row) for k, rows in enumerate(self._rows) for row in rows]
        self._of_form = np.array([k for k, _ in flat])
        self._batches = [*_alike([row for _, row in flat])]
        self.mass = np.array([gears_as_discs(form.built)[0] for form in forms])
        self._measure()

    def _measure(self) -> None:
        """Lengths of all forms as built, and what their losses take."""
        first = [self._of_form.searchsorted(k) for k in range(len(self.forms))]
        count = len(self._of_form)
        self._tips, self._roots = np.zeros((count, 2)), np.zeros((count, 2))
        self._references, self._teeth = np.zeros((count, 2)), np.zeros((count, 2))
        self._parts, self._bases = np.zeros((count, 2)), np.zeros((count, 2))
        self._radius, self._rolling = np.zeros(count), np.zeros(count)
        self._load, self._speed = np.zeros(count), np.zeros(count)
        self._driver, self._rims = np.zeros((count, 2)), np.zeros((count, 2))
        self._distances, self._overlaps, self._slopes = np.zeros((3, count))
        for numbers, (mesh, _, duty, *_) in self._batches:
            for at in range(0, len(numbers), ROWS):
                take = np.minimum(np.arange(at, at + ROWS), len(numbers) - 1)
                pair, point = jax.device_get(_measured(_rows(mesh, take), duty.driver[take]))
                place = numbers[take]
                self._tips[place], self._roots[place] = pair.tip_radii, pair.root_radii
                self._references[place], self._teeth[place] = pair.reference_radii, pair.teeth
                pitch = 2.0 * np.pi * pair.base_radii[:, 0] / pair.teeth[:, 0]
                middle = pair.base_radii[:, 0] * np.tan(pair.working_pressure_angle)
                ends = pair.path_ends
                self._parts[place] = (
                    np.stack([ends[:, 1] - middle, middle - ends[:, 0]], 1) / pitch[:, None]
                )
                self._bases[place] = np.abs(pair.base_radii)
                self._overlaps[place] = pair.overlap_ratio
                self._slopes[place] = np.cos(pair.base_helix_angle)
                self._radius[place], self._rolling[place] = point.radius, point.sum_speed
            self._load[numbers], self._speed[numbers] = duty.load, duty.speed
            self._driver[numbers], self._rims[numbers] = duty.driver, mesh.rim_ratio
            self._distances[numbers] = mesh.centre_distance
        self.first = np.array(first, int)
        self._end = np.append(self.first[1:], count)
        self.distance = self._distances[self.first]

    def efficiency(
        self, form: Numbers, module: Values, width: Values, torque: Values, speed: Values
    ) -> Values:
        """Efficiency of options by the losses of their teeth, see `mesh_efficiency`.

        Args:
            form: number of the form.
            module, width: [m].
            torque: at the output [N m].
            speed: of the input [rad/s].
        """
        meshes = np.ones((len(form), 3))
        scale, (eta, oil) = module / MODULE, self._oil
        for place in range(3):
            row = self.first[form] + place
            has = row < self._end[form]
            row = np.where(has, row, self.first[form])
            loaded = np.sum((1.0 - self._driver[row]) * self._bases[row], axis=1) * scale
            force = self._load[row] * torque / TORQUE / loaded
            friction = np.asarray(
                iso_tr_14179_2(
                    reference_line_load=jnp.asarray(force / width),
                    reference_sum_speed=jnp.asarray(
                        self._rolling[row] * scale * self._speed[row] * speed / SPEED
                    ),
                    reference_radius=jnp.asarray(self._radius[row] * scale),
                    viscosity=jnp.asarray(eta),
                    roughness_ra=jnp.asarray(ROUGHNESS),
                    lubricant_factor=jnp.asarray(oil),
                )
            )
            lost = tooth_loss(
                self._teeth[row],
                self._parts[row],
                friction,
                self._overlaps[row] * (width / WIDTH) / scale,
                self._slopes[row],
            )
            meshes[:, place] = np.where(has, 1.0 - lost, 1.0)
        return self._of_stages(form, meshes)

    def _of_stages(self, form: Numbers, meshes: np.ndarray) -> Values:
        """Efficiency of stages from those of their meshes."""
        kinds = np.array([one.kind for one in self.forms])[form]
        basic = self.ratio[form] - 1.0
        both = meshes[:, 0] * meshes[:, 1]
        values = np.where(kinds == "pair", meshes[:, 0], (1.0 + basic * both) / (1.0 + basic))
        of_3k = kinds == "3K"
        if of_3k.any():
            teeth = np.stack([self._five_teeth(k) for k in form[of_3k].tolist()])
            values[of_3k] = three_k_efficiencies(teeth, meshes[of_3k])[0]
        return np.asarray(values)

    def _five_teeth(self, form: int) -> np.ndarray:
        gears = self.forms[form].gears
        return np.array([*gears["teeth"], *gears["second"]["teeth"]], float)

    @property
    def _oil(self) -> tuple[float, float]:
        oil = self.forms[0].built.meshes[0].design.lubricant
        return float(oil.viscosity(self.task.temperature)), float(oil.lubricant_factor)

    def safeties(
        self, form: Numbers, module: Values, width: Values, torque: Values, speed: Values
    ) -> tuple[Values, Values]:
        """Least safeties of flanks and roots of options, over all meshes; see `efficiency`."""
        flank, root = np.full(len(form), np.inf), np.full(len(form), np.inf)
        for numbers, row in self._batches:
            place = np.full(len(self._of_form), -1)
            place[numbers] = np.arange(len(numbers))
            for mesh in range(3):
                at = self.first[form] + mesh
                has = at < self._end[form]
                at = np.where(has, at, 0)
                which = np.flatnonzero(has & (place[at] >= 0))
                if not len(which):
                    continue
                values = (module[which], width[which], torque[which], speed[which])
                each = self._rated(row, place[at[which]], at[which], *values)
                flank[which] = np.fmin(flank[which], each[0])
                root[which] = np.fmin(root[which], each[1])
        return flank, root

    def _rated(
        self,
        row: Any,
        take: np.ndarray,
        at: np.ndarray,
        module: Values,
        width: Values,
        torque: Values,
        speed: Values,
    ) -> tuple[Values, Values]:
        """Least safeties of single meshes, in rows that share one program."""
        radii = 2.0 * np.abs(self._references[at]) * (module / MODULE)[:, None]
        thinned = _thinnest(radii)
        found: list[tuple[np.ndarray, np.ndarray]] = []
        for start in range(0, len(take), ROWS):
            some = np.minimum(np.arange(start, start + ROWS), len(take) - 1)
            mesh, ends, duty, factors, strengths, finish = _rows(row, take[some])
            scale = module[some] / MODULE
            # Rows of a batch are put in place without the checks that a mesh makes of its arrays.
            mesh = eqx.tree_at(
                lambda one: (one.module, one.face_width, one.centre_distance),
                mesh,
                (module[some], width[some], mesh.centre_distance * scale),
            )
            load, turned = duty.load * torque[some] / TORQUE, duty.speed * speed[some] / SPEED
            duty = eqx.tree_at(lambda one: (one.load, one.speed), duty, (load, turned))
            finish = eqx.tree_at(lambda one: one.thickness, finish, thinned[some])
            rated = ratings(mesh, ends * scale[:, None], duty, factors, strengths, finish)
            keep = min(ROWS, len(take) - start)
            found.append(
                tuple(
                    np.min(np.asarray(rated[name])[:keep], axis=1)
                    for name in ("flank_safety", "root_safety")
                )
            )
        return np.concatenate([a for a, _ in found]), np.concatenate([b for _, b in found])

    def sized(
        self, form: Numbers, module: Values, torque: Values, speed: Values
    ) -> tuple[Sized, np.ndarray]:
        """Options with the least width that bears the load, and True for those that do.

        Args:
            form: number of the form.
            module: [m].
            torque: at the output [N m].
            speed: of the input [rad/s].
        """
        task = self.task
        pinion = 2.0 * np.abs(self._references[self.first[form]]).min(axis=1) * module / MODULE
        low = LEAST_WIDTH * module
        high = np.maximum(np.minimum(MOST_WIDTH * module, task.slenderness * pinion), 0.0)
        possible = low <= high
        width = np.where(possible, np.sqrt(low * np.maximum(high, low)), low)
        for _ in range(STEPS):
            flank, root = self.safeties(form, module, width, torque, speed)
            lacks = np.maximum((task.flank_safety / flank) ** 2, task.root_safety / root)
            width = np.clip(width * lacks, low, np.maximum(high, low))
        width = np.ceil(width / ROUNDED - 1e-6) * ROUNDED
        flank, root = self.safeties(form, module, width, torque, speed)
        bears = possible & (flank >= task.flank_safety) & (root >= task.root_safety)
        loss = 1.0 - self.efficiency(form, module, width, torque, speed)
        scale = module / MODULE
        extents = [self._extents(k) for k in range(len(self.forms))]
        around, along = np.array(extents).reshape(-1, 2).T
        sizes = Sized(
            form,
            module,
            width,
            flank,
            root,
            loss,
            self.mass[form] * scale**2 * width / WIDTH,
            around[form] * scale,
            along[form] * width,
            self.distance[form] * scale,
            torque,
        )
        return sizes, bears

    def _extents(self, form: int) -> tuple[float, float]:
        """Diameter around the gears of a form as built [m], and its length in face widths."""
        row, last = self.first[form], self._end[form]
        kind = self.forms[form].kind
        tips, a = np.abs(self._tips[row:last]), self._distances[row]
        if kind == "pair":
            return float(tips[0].sum() + a), 1.0
        rings = np.abs(self._roots[row:last, 1]) * self._rims[row:last, 1]
        rings = rings * (self._teeth[row:last, 1] < 0.0)
        planets = a + max(tips[0, 1], tips[-1, 0])
        return 2.0 * float(max(rings.max(), planets)), 1.0 if kind == "planetary" else 2.0

    def tips(self, form: int) -> tuple[float, float]:
        """Tip radii of a pair over its module."""
        first, second = np.abs(self._tips[self.first[form]]) / MODULE
        return float(first), float(second)


def tooth_loss(
    teeth: Float[np.ndarray, "mesh 2"],
    parts: Float[np.ndarray, "mesh 2"],
    friction: Float[np.ndarray, " mesh"],
    overlap: Float[np.ndarray, " mesh"],
    slope: Float[np.ndarray, " mesh"],
) -> Float[np.ndarray, " mesh"]:
    """Mean part of the power that meshes lose by Coulomb friction.

    Args:
        teeth: z1, z2, negative for a ring.
        parts: of the transverse contact ratio on either side of the pitch point.
        friction: coefficient.
        overlap: overlap ratio.
        slope: cosine of the helix angle on the base cylinders.

    Spur teeth by `mesh_efficiency`; helical ones from an overlap ratio of 1 on as lines under an even load,
    mu pi (1/z1 + 1/z2) (e1^2 + e2^2)/(e1 + e2), and a straight line between both.

    Example:
        >>> import numpy as np
        >>> of_helix = np.array([0.0, 1.0]), np.array([1.0, 1.0])
        >>> lost = tooth_loss(np.full((2, 2), 30.0), np.full((2, 2), 0.8), np.full(2, 0.05), *of_helix)
        >>> lost.round(5)
        array([0.00712, 0.00838])
    """
    first, second = parts.T
    spur = 1.0 - mesh_efficiency((teeth[:, 0], teeth[:, 1]), (first, second), friction)
    even = (first * np.abs(first) + second * np.abs(second)) / (first + second)
    helical = friction * np.pi * np.sum(1.0 / teeth, axis=1) * even
    return np.asarray((spur + np.clip(overlap, 0.0, 1.0) * (helical - spur)) / slope)


def _rows(tree: Any, where: Any) -> Any:
    return jax.tree.map(lambda leaf: np.asarray(leaf)[where], tree)


def _alike(rows: Sequence[Any]) -> Iterator[tuple[np.ndarray, Any]]:
    """Rows as `rated` takes them, stacked as far as their gears are of one kind, and which ones they are."""
    simple = [(bare_pair(row[0]), *row[1:]) for row in rows]
    kinds: dict[Any, list[int]] = {}
    for number, row in enumerate(simple):
        kinds.setdefault(jax.tree.structure(row), []).append(number)
    for numbers in kinds.values():
        stacked = jax.tree.map(
            lambda *leaves: np.stack([np.asarray(leaf) for leaf in leaves]),
            *(simple[number] for number in numbers),
        )
        yield np.array(numbers), stacked


@program
def _measured(mesh: Any, driver: Any) -> tuple[RatedPair, PitchPoint]:
    """Dimensions and pitch points of some meshes.

    Args:
        mesh: bare ones, with an axis of pairs in front.
        driver: one for the gear that drives.
    """
    both: Callable[[Any, Any], tuple[RatedPair, PitchPoint]] = jax.vmap(
        lambda one, driven: (rated_pair(one), pitch_point(one, driven))
    )
    return both(mesh, driver)


@cache
def _thinnest_of(micrometres: int) -> float:
    return thickness_allowances(field=FIELD, diameter=1e-6 * micrometres)[1]


def _thinnest(diameters: np.ndarray) -> np.ndarray:
    """Lower allowances of the tooth thickness by `FIELD`, of reference diameters [m]."""
    rounded = np.round(1e6 * diameters).astype(int)
    values, back = np.unique(rounded, return_inverse=True)
    return np.array([_thinnest_of(int(um)) for um in values])[back].reshape(diameters.shape)


def gears_as_discs(built: Ready) -> tuple[float, float, float]:
    """Mass [kg], inertia at the input [kg m2], and mean backlash at the output [rad] of all gears of a drive.

    Args:
        built: with fields of thickness and of centre distance.
    """
    if REFLECTED.why_not(built) is None:
        data = REFLECTED.compute(built, {}, silent)
        play = float(data["output_backlash"].sel(case="mean"))
        inertia = float(data["reflected_inertia"].sel(end="input"))
        return float(data["drive_mass"]), inertia, play
    data = inspection_part(built.meshes[0])
    wheel = float(data["disc_inertia"][1]) * built.output_rate**2
    play = float(data["backlash_angle"].sel(case="mean")[1])
    return float(data["disc_mass"].sum()), float(data["disc_inertia"][0]) + wheel, play

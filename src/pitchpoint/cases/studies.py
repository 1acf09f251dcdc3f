"""Computations of a case: the cycle in detail, studies, spread of the laws, back-driving."""

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import Any

import numpy as np
import xarray as xr
from jaxtyping import Array

from pitchpoint._jax import jax
from pitchpoint.cases import loss_map
from pitchpoint.cases.build import Built, build
from pitchpoint.cases.document import Document, leaves, resolve
from pitchpoint.cases.failures import fails
from pitchpoint.cases.laws import limits_words
from pitchpoint.cases.quantities import Pair, Quantity, SIValue, shown
from pitchpoint.cases.readings import readings_of
from pitchpoint.cases.schema import (
    FORCE,
    SPEED,
    TEMPERATURE,
    TORQUE,
    Study,
    Sweep,
    quantity_at,
    validate,
)
from pitchpoint.contact.surface import Surfaces
from pitchpoint.efficiency.profile import profile
from pitchpoint.efficiency.quasi_static import Models
from pitchpoint.efficiency.summary import summarise
from pitchpoint.errors import ConvergenceError, InputError, shorten
from pitchpoint.gears.mesh import PATHS, Mesh
from pitchpoint.loading.sharing import LOAD_SHARING
from pitchpoint.lubrication.applicability import applies
from pitchpoint.lubrication.film_thickness import FILM_THICKNESS
from pitchpoint.lubrication.friction_coefficient import LAWS, FrictionLaw
from pitchpoint.lubrication.rolling_resistance import ROLLING_RESISTANCE
from pitchpoint.programs import program
from pitchpoint.results.rounding import difference
from pitchpoint.results.store import dataset, without_nan
from pitchpoint.units import si_unit

__all__ = ["Job", "Variant", "jobs"]

PIECE = 256
"""Points of a sweep that are kept on disk together."""

_TOLD = ("targets", "issues", "studies")

SWEPT = ("gears", "materials", "lubricant", "roughness", "operation")
"""Tables whose values may be swept; rival models stand side by side as a list in [models]."""

AT_CONTACT = ("film_thickness", "lambda_ratio", "pressure", "entrainment", "sliding_velocity")
"""Figures of a test rig, whose contact stays as it is."""

_SHOWN = 3

_WITH_FRICTION = {"largest_contact_force_ratio"} | {
    f"{kind}_{name}{ending}"
    for kind in ("mean", "min", "max")
    for name in ("loss", "efficiency", "input_torque", "friction")
    for ending in ("", "_path")
}
"""Figures that are undefined where friction locks the mesh."""

TOLERANCE = 1e-10
"""Largest relative residual of the torque balance that counts as converged."""

NEARLY_JAMMED = 1e-3
"""Distance from the coefficient that locks the mesh, relative, at which it is said to be reached."""

PRESSURE = Quantity("pressure", 0.0, 1e15, "GPa")

Progress = Callable[[int], None]


@dataclass(frozen=True)
class Job:
    """One dataset to compute, in one piece or several.

    Attributes:
        name: of the part, and of its file.
        title: for progress and figures.
        pieces: each computes one dataset, told a callback for progress; a long sweep has several.
        whole: puts several pieces together; along their points by default.
    """

    name: str
    title: str
    pieces: "tuple[Callable[[Progress], xr.Dataset], ...]"
    whole: "Callable[[Sequence[xr.Dataset]], xr.Dataset] | None" = None

    def joined(self, pieces: Sequence[xr.Dataset]) -> xr.Dataset:
        """The whole dataset."""
        if self.whole is not None:
            return self.whole(pieces)
        return pieces[0] if len(pieces) == 1 else _joined(pieces)


@dataclass(frozen=True)
class Variant:
    """A case file in one variant, with the means to build it again with changed values.

    Attributes:
        tree: tables of the file.
        name: of the file or of the shipped case, for messages.
        variant: one of those in the file.
        settings: values by dotted key that replace those of the file.
        own: friction law of the user's own.
        recorded: name of the case whose record the file is; empty where it is the case itself.
        warnings: about the record.
    """

    tree: Mapping[str, Any]
    name: str
    variant: str
    settings: Mapping[str, Any] = field(default_factory=dict)
    own: FrictionLaw | None = None
    recorded: str = ""
    warnings: tuple[str, ...] = ()

    @property
    def label(self) -> str:
        """Name of the case in its results."""
        return self.recorded or self.name

    def document(self, **changes: Any) -> Document:
        """Plain values with further settings."""
        return resolve(
            dict(self.tree),
            name=self.name,
            variant=self.variant,
            settings={**self.settings, **changes},
        )

    @cached_property
    def _computed(self) -> "Variant":
        """The tables that a point is computed from: a sweep reads them for every point."""
        return replace(self, tree=_without(self.tree))

    def built(self, changes: Mapping[str, Any]) -> Built:
        """Case with some values changed."""
        document = (self._computed if changes else self).document(**changes)
        return build(validate(document), document, self.own)


def _without(tree: Mapping[str, Any]) -> dict[str, Any]:
    kept = {key: value for key, value in tree.items() if key not in _TOLD}
    overlays = kept.get("variants", {})
    if isinstance(overlays, dict):
        kept["variants"] = {
            name: {key: value for key, value in overlay.items() if key not in _TOLD}
            if isinstance(overlay, dict)
            else overlay
            for name, overlay in overlays.items()
        }
    return kept


def jobs(variant: Variant, extra: Mapping[str, Study]) -> Iterator[Job]:
    """All parts of a case in the order in which they are worth having.

    Args:
        variant: the case.
        extra: studies that the user added.

    Raises:
        InputError: before the first part, for the case and for the ends of every sweep.
    """
    built = variant.built({})
    for name in built.case.studies.keys() & extra.keys():
        raise InputError("is a study of the case already", file=variant.name, key=f"studies.{name}")
    studies = [_study(variant, n, study, f"studies.{n}") for n, study in built.case.studies.items()]
    studies += [_study(variant, name, study, "--sweep") for name, study in extra.items()]
    mesh = built.design.mesh
    if _drawing(mesh):
        yield Job("teeth", "teeth", (lambda _: _teeth(built),))
    yield Job("cycle", "mesh cycle", (lambda _: _cycle(built),))
    yield Job("operation", "operating point", (lambda _: _operation(built),))
    yield Job("laws", "spread of the friction laws", (lambda _: _laws(built),))
    yield from _yielding(built)
    yield from studies
    if built.transmits:
        yield from _of_power(built)


def _of_power(built: Built) -> Iterator[Job]:
    """Parts on the power that goes through."""
    yield from _running(built)
    whole = partial(loss_map.joined, laws=[law.title for law in built.laws])
    yield Job("loss_map", "loss map", tuple(loss_map.pieces(built)), whole)
    yield Job("back_driving", "back-driving", (lambda _: _back_driving(built),))


def _deviating(built: Built, deviations: Surfaces) -> Iterator[Job]:
    """What deviations around the gears do to their motion."""
    from pitchpoint.cases import kinematic_error

    def compute(told: Progress) -> xr.Dataset:
        return kinematic_error.kinematic_error_part(built, deviations, told)

    yield Job("kinematic_error", "kinematic error", (compute,))


def _running(built: Built) -> Iterator[Job]:
    """Torque that runs and starts a drive with losses beside its teeth."""
    if not built.design.drag:
        return
    from pitchpoint.cases import running

    def compute(_: Progress) -> xr.Dataset:
        return running.running_part(built)

    yield Job("running", "running without load", (compute,))


def _yielding(built: Built) -> Iterator[Job]:
    """Parts on how teeth yield, and what follows; what they import is not needed without them."""
    dynamics, deviations = built.case.dynamics, built.deviations
    shares = LOAD_SHARING[built.case.models.load_sharing].by_stiffness
    if not shares and dynamics is None and built.design.mesh.touching and not any(deviations):
        return
    from pitchpoint.cases import torsion

    yield Job("torsion", "torsion", (lambda _: torsion.torsion_part(built),))
    if any(deviations):
        yield from _deviating(built, deviations)
    if built.design.mesh.line_of_action is None:
        return
    from pitchpoint.cases import vibration

    yield Job("stiffness", "mesh stiffness", (lambda _: vibration.stiffness_part(built),))
    if dynamics is None:
        return
    yield Job("vibration", "vibration", (lambda _: vibration.vibration_part(built),))
    if dynamics.speeds is not None:
        title = "vibration against speed"
        yield Job("resonance", title, (lambda _: vibration.resonance_part(built),))


def _teeth(built: Built) -> xr.Dataset:
    """What a drawing of the teeth to scale needs."""
    numbers = jax.device_get(_drawing(built.design.mesh))
    dims, labels = built.family.drawing, built.family.coordinates
    data = {name: (dims.get(name) or _dims(name, v), v) for name, v in numbers.items()}
    used = {name for each, _ in data.values() for name in each}
    return dataset(data, {k: v for k, v in labels.items() if k in used}, title="teeth")


def _dims(name: str, values: np.ndarray) -> tuple[str, ...]:
    """Dimensions of an array that the family does not name: two values are those of two gears."""
    if np.shape(values) == (2,):
        return ("gear",)
    return tuple(f"{name}_{axis}" for axis in range(np.ndim(values)))


@program
def _drawing(mesh: Mesh) -> dict[str, Array]:
    return mesh.drawing()


def _cycle(built: Built) -> xr.Dataset:
    runs, names = _profiles(built, built.models), built.law_names
    _demand_motion(*_jammed(runs), [built], names)
    _demand_convergence(np.stack([run["residual"] for run in runs]), [built], names)
    lanes = ("law", "node", "pair", "slice")
    common = {
        "phase": (("node",), runs[0]["phase"]),
        "weight": (("node",), runs[0]["weight"]),
        "path": (lanes[1:], runs[0]["path"]),
        "active": (lanes[1:], runs[0]["active"]),
    }
    each = {
        name: (lanes if runs[0][name].ndim == 3 else lanes[:2], np.stack([r[name] for r in runs]))
        for name in runs[0]
        if name not in common and not name.startswith("outside")
    }
    warnings = [
        text
        for law, run in zip(built.laws, runs, strict=True)
        for text in _told_of(law, _outside(built, law, run))
    ]
    warnings += _conformal_warning(built.design.mesh, runs[0])
    warnings += _pressure_warning(built, runs)
    warnings += _face_warning(built, runs[0])
    data = dataset(
        {**common, **each},
        {"law": names},
        title="mesh cycle",
        warnings=warnings,
        film_law=built.case.models.film_thickness,
        events=built.nominal["events"].tolist(),
    )
    long_name, symbol = PATHS[built.design.mesh.counts]
    data["path"].attrs.update(long_name=long_name, symbol=symbol)
    filled = built.design.mesh.filled
    return data if filled is None else data.isel(pair=filled)


def _profiles(built: Built, under: Sequence[Models]) -> list[dict[str, np.ndarray]]:
    """The mesh cycle under each of some models."""
    film = FILM_THICKNESS[built.case.models.film_thickness]
    point = built.design, built.operation
    return [profile(*point, models, film, engaged=built.engaged) for models in under]


def _jammed(
    runs: Sequence[Mapping[str, np.ndarray]],
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Whether friction locks the mesh, and where it is nearest to that its coefficients [law, 1]."""
    names = ("largest_friction", "jamming_coefficient")
    nearest = [int(np.argmax(run[names[0]] / run[names[1]])) for run in runs]
    acting, limit = (
        np.array([[run[name][node]] for run, node in zip(runs, nearest, strict=True)])
        for name in names
    )
    return np.stack([run["locked"].any(keepdims=True) for run in runs]), acting, limit


def _operation(built: Built) -> xr.Dataset:
    count = len(built.models)
    extra = {
        **_vibrations([built], count),
        **_temperatures([built], count),
        **_at_contact([built], built.models),
    }
    return _summaries([built], built.models, extra, title="operating point")


def _laws(built: Built) -> xr.Dataset:
    """Every law of the library in its range at the operating point: how far they themselves disagree.

    The attribute `outside` lists the others and the laws of the case that are out of theirs, each with
    its efficiency there and the reasons.
    """
    every = [law for law in LAWS if law.sources and applies(law, built.design.mesh) is None]
    others = built.under([law for law in every if law not in built.laws])
    under = {models.law: models for models in (*others, *built.models)}
    considered = [under[law] for law in dict.fromkeys([*every, *built.laws])]
    title = "friction laws that apply"
    data = _summaries([built], considered, {}, title=title, may_lock=True)
    reasons = [
        _outside(built, models.law, run)
        for models, run in zip(considered, _profiles(built, considered), strict=True)
    ]
    outside = [
        {
            "law": str(data["law"].values[k]),
            "mean_efficiency": float(data["mean_efficiency"].values[k, 0]),
            "reasons": told,
        }
        for k, told in enumerate(reasons)
        if told
    ]
    kept = [k for k, models in enumerate(considered) if models.law in every and not reasons[k]]
    return data.isel(law=kept).assign_attrs(outside=json.dumps(without_nan(outside)))


def _study(variant: Variant, name: str, study: Study, where: str) -> Job:
    fixed = {key: value for key, value in leaves(study.change) if value != {}}
    title = study.title or name
    if study.sweep is None:
        _point(variant, fixed, where)
        return Job(f"study_{name}", title, (_points(variant, [fixed], {}, title, {}, where),))
    where = where if where.startswith("--") else f"{where}.sweep"
    values, kind = sweep_values(study.sweep, where, variant.name, variant.document().tree)
    _demand_one(variant, study.sweep, where)
    told = {
        "sweep_key": study.sweep.key,
        "axis_kind": kind.kind if kind else "",
        "axis_unit": kind.unit if kind else "",
    }
    for value in (values[0], values[-1]):
        _point(variant, {**fixed, study.sweep.key: value}, where, study.sweep.key)
    pieces = []
    for start in range(0, len(values), PIECE):
        part = values[start : start + PIECE]
        axis = {"axis": (("point",), np.array([_number(value) for value in part]))}
        changes = [{**fixed, study.sweep.key: value} for value in part]
        pieces.append(_points(variant, changes, axis, title, told, where))
    return Job(f"study_{name}", title, tuple(pieces))


def _demand_one(variant: Variant, sweep: Sweep, where: str) -> None:
    """InputError if one number would be swept over two gears to which the case gives different ones."""
    value: Any = variant.document().tree
    for part in sweep.key.split("."):
        value = value.get(part) if isinstance(value, dict) else None
    several = isinstance(value, list | tuple) and len(set(map(str, value))) > 1
    if several and any(not isinstance(one, list | tuple) for one in sweep.values or (0,)):
        raise InputError(
            f"{sweep.key} has different values for gear 1 and gear 2, {shown(value)}, and one number would "
            f"set both; sweep {sweep.key}.1 or {sweep.key}.2",
            file=variant.name,
            key=where,
        )


def _points(
    variant: Variant,
    changes: Sequence[Mapping[str, Any]],
    axis: Mapping[str, Any],
    title: str,
    told: Mapping[str, str],
    where: str,
) -> Callable[[Progress], xr.Dataset]:
    def compute(progress: Progress) -> xr.Dataset:
        swept = told.get("sweep_key", "")
        points = [_point(variant, change, where, swept) for change in changes]
        under = points[0].models
        extra = {
            **axis,
            **_vibrations(points, len(under)),
            **_temperatures(points, len(under)),
            **_at_contact(points, under),
            **readings_of(points, len(under)),
        }
        data = _summaries(points, under, extra, progress, title=title)
        data.attrs.update(told)
        if told.get("axis_kind"):
            data["axis"].attrs.update(units=si_unit(told["axis_kind"]), long_name=swept)
        return data

    return compute


def _point(variant: Variant, changes: Mapping[str, Any], where: str, swept: str = "") -> Built:
    """Case with the changes of a study; what is wrong with it is told with study and value."""
    try:
        return variant.built(changes)
    except InputError as error:
        at = f"at {swept} = {_told(swept, changes[swept])}: " if swept else ""
        inside = f"{shorten(error.key, 160)}: " if error.key and error.key != swept else ""
        message = f"{at}{inside}{error.message}"
        raise InputError(message, file=error.file, key=where, value=changes.get(swept)) from None


def _told(key: str, value: Any) -> str:
    quantity = quantity_at(key)
    return quantity.show(value) if quantity and isinstance(value, float) else shown(value)


def sweep_values(
    sweep: Sweep, where: str, name: str, tree: Mapping[str, Any]
) -> tuple[list[Any], Any]:
    """Values of a sweep, numbers in SI, and their kind.

    Args:
        sweep: as given.
        where, name: key and file, for messages.
        tree: plain values of the case.

    Raises:
        InputError: an unknown key, or a value that the key does not take.
    """
    try:
        quantity = quantity_at(sweep.key, tree)
        if sweep.key.partition(".")[0] not in SWEPT:
            raise InputError(f"cannot be swept; keys of {', '.join(SWEPT)} can")
        if sweep.values is not None:
            if quantity is None:
                return list(sweep.values), None
            return [_read(quantity, value) for value in sweep.values], quantity
        if quantity is None:
            raise InputError(
                f"{shown(sweep.key)} is no number; give values in place of start and stop"
            )
        ends = quantity.read(sweep.start), quantity.read(sweep.stop)
        grid = np.linspace(*ends, int(sweep.count))
        return [SIValue(value) for value in (np.round(grid) if quantity.whole else grid)], quantity
    except InputError as error:
        raise error.at(file=name, key=f"{where}: {shorten(sweep.key)}") from None


def _read(quantity: Quantity, value: Any) -> Any:
    """Value in SI, or a list of two for the two gears."""
    if isinstance(value, list | tuple):
        return [SIValue(number) for number in Pair(quantity).read(value)]
    return SIValue(quantity.read(value))


def _back_driving(built: Built) -> xr.Dataset:
    """The loaded member drives at its own speed and carries the same power to the former driver."""
    return _summaries([built.backwards], built.models, {}, title="back-driving", may_lock=True)


def _at_contact(points: Sequence[Built], under: Sequence[Models]) -> dict[str, Any]:
    """Pressure, film and speeds at the one contact of a rig, which transmits nothing."""
    if points[0].transmits:
        return {}
    runs = [_profiles(point, under) for point in points]
    return {
        name: (
            ("law", "point"),
            np.array([[run[name][0, 0, 0] for run in each] for each in runs]).T,
        )
        for name in AT_CONTACT
    }


def _temperatures(points: Sequence[Built], laws: int) -> dict[str, Any]:
    """Temperatures and moduli of the teeth where a model says that they warm up."""
    if points[0].case.models.tooth_temperature == "isothermal":
        return {}
    values: dict[str, list[float]] = {}
    for point in points:
        for gear, used in enumerate(point.solids, 1):
            flank = used.temperature if used.flank is None else used.flank
            values.setdefault(f"flank_temperature_{gear}", []).append(flank)
            values.setdefault(f"root_temperature_{gear}", []).append(used.temperature)
            values.setdefault(f"young_{gear}", []).append(float(used.solid.young))
    return {name: (("law", "point"), np.array([each] * laws)) for name, each in values.items()}


def _vibrations(points: Sequence[Built], laws: int) -> dict[str, Any]:
    """Figures of stiffness and vibration, the same under every friction law."""
    if points[0].case.dynamics is None:
        return {}
    from pitchpoint.cases.vibration import figures_of

    found = _in_groups(points, figures_of)
    return {name: (("law", "point"), np.stack([values] * laws)) for name, values in found.items()}


def _summaries(
    points: list[Built],
    under: Sequence[Models],
    extra: Mapping[str, Any],
    progress: Progress = lambda _: None,
    *,
    title: str,
    may_lock: bool = False,
) -> xr.Dataset:
    """Figures of points under several laws; among several, or with `may_lock`, locked ones are NaN."""
    names = [models.law.name for models in under]
    runs = [_grouped(points, models, progress) for models in under]
    out = {name: np.stack([run[name] for run in runs]) for name in runs[0]}
    if not may_lock and len(points) == 1:
        ends = (out["nearest_friction"], out["nearest_jamming_coefficient"])
        _demand_motion(out["locked"], *ends, points, names)
    for name, values in out.items():
        if values.dtype.kind == "f" and name in _WITH_FRICTION:
            values[out["locked"]] = np.nan
    residual = np.where(out["locked"], 0.0, out["residual"])
    _demand_convergence(residual, points, names)
    if points[0].case.models.averaging == "path":
        for name in ("mean_loss", "mean_efficiency", "mean_input_torque"):
            out[name] = out[f"{name}_path"]
    out = {name: values for name, values in out.items() if not name.endswith("_path")}
    out["efficiency_fluctuation"] = difference(out["max_efficiency"], out["min_efficiency"])
    out["torque_ripple"] = difference(out["max_input_torque"], out["min_input_torque"])
    if not points[0].design.mesh.touching:
        del out["loss_factor"]  # of the shares of one load: no figure of the gears alone
    else:
        out["loss_factor_efficiency"] = 1.0 - out["mean_friction"] * out["loss_factor"]
    told = dict.fromkeys(text for point in points for text in point.warnings)
    warnings = few([*told])
    if "vibration_status" in extra:
        from pitchpoint.cases.vibration import status_sentences

        warnings += status_sentences(extra["vibration_status"][1][0])
    if not may_lock:
        for models, locked in zip(under, out["locked"], strict=True):
            warnings += _lock_warning(models.law, locked)
    data = dataset(
        {**{name: (_FIGURE[: values.ndim], values) for name, values in out.items()}, **extra},
        {"law": names, **_named_places(points[0])},
        title=title,
        warnings=warnings,
    )
    data["mean_efficiency"].attrs.update(points[0].covers)
    if not points[0].transmits:
        data["mean_efficiency"].attrs["note"] = "undefined (NaN): no power goes through a test rig"
    return data


_FIGURE = ("law", "point", "place")


def _named_places(built: Built) -> dict[str, list[str]]:
    """Places beside the teeth where power is lost; none without any."""
    return {"place": [*built.case.losses]} if built.case.losses else {}


def _joined(pieces: Sequence[xr.Dataset]) -> xr.Dataset:
    """Pieces of a sweep as one; their warnings too."""
    data = xr.concat(pieces, "point", combine_attrs="override")
    told = [text for piece in pieces for text in json.loads(piece.attrs["warnings"])]
    data.attrs["warnings"] = json.dumps(few([*dict.fromkeys(told)]))
    return data


def few(sentences: list[str]) -> list[str]:
    """The first warnings of a sweep, and how many more there are."""
    rest = len(sentences) - _SHOWN
    more = [f"... and {rest} more warnings of this kind in the sweep."] if rest > 0 else []
    return sentences[:_SHOWN] + more


def _lock_warning(law: FrictionLaw, locked: np.ndarray) -> list[str]:
    if not locked.any():
        return []
    return [f"{law.title}: friction locks the mesh at {locked.sum()} of {locked.size} points."]


def _grouped(points: list[Built], models: Models, progress: Progress) -> dict[str, np.ndarray]:
    """Summaries in order, points of equal static structure computed together."""

    def of(group: Sequence[Built]) -> dict[str, np.ndarray]:
        return summarise([(point.design, point.operation) for point in group], models, progress)

    return _in_groups(points, of)


def _in_groups(
    points: Sequence[Built], compute: Callable[[Sequence[Built]], dict[str, np.ndarray]]
) -> dict[str, np.ndarray]:
    """Results [point ...] in order, from computations of points of equal static structure."""
    groups: dict[Any, list[int]] = {}
    for position, point in enumerate(points):
        shapes = tuple(np.shape(leaf) for leaf in jax.tree.leaves(point.design))
        groups.setdefault((jax.tree.structure(point.design), shapes), []).append(position)
    parts = [(where, compute([points[i] for i in where])) for where in groups.values()]
    result = {
        name: np.empty((len(points), *values.shape[1:]), values.dtype)
        for name, values in parts[0][1].items()
    }
    for where, values in parts:
        for name in result:
            result[name][where] = values[name]
    return result


def _number(value: Any) -> float:
    """Place on the axis of a sweep: the number itself, or that of gear 1."""
    first = value[0] if isinstance(value, list | tuple) and value else value
    return float(first) if isinstance(first, int | float) else np.nan


def _demand_convergence(residual: np.ndarray, points: Sequence[Built], laws: Sequence[str]) -> None:
    """ConvergenceError if a balance [law, point] was not found: no numbers are returned."""
    failed = ~(residual <= TOLERANCE)
    if failed.any():
        law, point = divmod(int(np.argmax(failed)), residual.shape[1])
        if np.isposinf(residual[law, point]):
            raise ConvergenceError(
                "losses beside the teeth drive the loaded member with more than its load "
                f"{_where(points[min(point, len(points) - 1)])}: other flanks would touch"
            )
        raise ConvergenceError(
            f"the torque balance did not converge (relative residual {residual[law, point]:.2g}, "
            f"allowed {TOLERANCE:g}) with {laws[law]} {_where(points[min(point, len(points) - 1)])}"
        )


def _demand_motion(
    locked: np.ndarray,
    acting: np.ndarray,
    limit: np.ndarray,
    points: Sequence[Built],
    laws: Sequence[str],
) -> None:
    """ConvergenceError if friction locks the mesh [law, point]: there is no balance to find."""
    if locked.any():
        law, point = divmod(int(np.argmax(locked)), locked.shape[1])
        raise ConvergenceError(
            f"friction locks the mesh with {laws[law]} {_where(points[min(point, len(points) - 1)])}: "
            f"{jamming_words(float(acting[law, point]), float(limit[law, point]))}; no force carries the load"
        )


def jamming_words(acting: float, limit: float) -> str:
    """Why friction locks a mesh, in words.

    Args:
        acting: friction coefficient, under the force without friction.
        limit: from which on the mesh locks.

    Example:
        >>> jamming_words(0.312, 0.29)
        'friction 0.312 reaches the 0.29 at which this mesh locks'
        >>> jamming_words(0.25, 0.29)
        'friction 0.25 grows with the force, and at 0.29 this mesh locks'
    """
    if acting < limit * (1.0 - NEARLY_JAMMED):
        return f"friction {acting:.3g} grows with the force, and at {limit:.3g} this mesh locks"
    return f"friction {acting:.3g} reaches the {limit:.3g} at which this mesh locks"


_LOADS = {"torque": TORQUE, "force": FORCE}


def _where(built: Built) -> str:
    point = built.case.operation
    return ", ".join(
        f"{name} {kind.show(value)}"
        for name, kind, value in (
            (f"at {built.case.gears.load}", _LOADS[built.case.gears.load], point.load),
            ("speed", SPEED, point.speed),
            ("temperature", TEMPERATURE, point.temperature),
        )
    )


def _conformal_warning(mesh: Mesh, run: Mapping[str, Any]) -> list[str]:
    """Contacts whose flanks have the same curvature nearly, where the formulas of contact do not hold."""
    loaded = np.asarray(run["load"]) > 0.0
    largest = float(mesh.largest_radius)
    flat = loaded & (np.asarray(run["radius"]) > largest * (1.0 - 1e-9))
    if not flat.any():
        return []
    return [
        f"{flat.sum()} of {loaded.sum()} loaded contacts of the mesh cycle are conformal: their relative "
        f"radius is cut at {largest:.3g} m, and pressure and film there say little."
    ]


LEAST_FACE = 3.0
"""Mean number of slices of a contact line below which it is nearly a point, not a line."""


def _face_warning(built: Built, run: Mapping[str, Any]) -> list[str]:
    """Part of the contact lines that gets no load; refused where hardly any of them gets some."""
    mesh, active = built.design.mesh, np.asarray(run["active"])
    carries = np.asarray(run["load"]) > 0.0
    pairs, slices = carries.any(axis=2), active.shape[2]
    if mesh.touching or slices == 1 or not pairs.any():
        return []
    lines = np.sum(pairs.sum(axis=1) * run["weight"])
    mean = float(np.sum(carries.sum(axis=(1, 2)) * run["weight"]) / lines)
    load = _LOADS[built.case.gears.load].show(built.case.operation.load)
    if mean < LEAST_FACE:
        raise InputError(
            f"at {load} only {mean:.2g} of {slices} slices of a contact line get load in the mean, nearly a "
            "point in place of a line; less crowning, end relief or misalignment, a higher load or more "
            "slices leave a line of contact",
            key="gears",
        )
    if mean > slices * (1.0 - 1e-9):
        return []
    return [
        f"Of the contact lines that carry, {100.0 * (1.0 - mean / slices):.2g} % get no load at {load}: "
        "there flanks do not touch."
    ]


def _pressure_warning(built: Built, runs: Sequence[Mapping[str, np.ndarray]]) -> list[str]:
    """A Hertz pressure that a material does not bear even once."""
    largest = max(float(np.max(run["pressure"])) for run in runs)
    limits = [
        (limit.value, gear) for gear, used in enumerate(built.solids, 1) if (limit := used.bears)
    ]
    weakest, gear = min(limits, default=(np.inf, 0))
    if not largest > weakest:
        return []
    name = built.solids[gear - 1].record.name
    return [
        fails(
            f"the Hertz pressure reaches {PRESSURE.show(float(f'{largest:.3g}'))}; {name} bears about "
            f"{PRESSURE.show(weakest)}, and that a few times only."
        )
    ]


def _told_of(law: FrictionLaw, reasons: Sequence[str]) -> list[str]:
    return [f"{law.title}: {reason}." for reason in reasons]


def _outside(built: Built, law: FrictionLaw, run: Mapping[str, np.ndarray]) -> list[str]:
    """Why a law does not hold at an operating point, in words; empty where it does."""
    reasons = [
        f"the {name.replace('_', ' ')} leaves the range of the law, {limits_words(name, limits)}, "
        f"{_how_long(run[f'outside {law.name} {name}'], run['weight'])}"
        for name, limits in law.ranges.items()
        if np.any(run[f"outside {law.name} {name}"])
    ]
    if run["locked"].any():
        reasons.append(f"its friction coefficient, {run['friction'].max():.2g}, locks the mesh")
    loaded = run["load"] > 0.0
    if not loaded.any():
        return reasons
    highest = float(run["friction"].max(where=loaded, initial=0.0))
    thinnest = float(run["lambda_ratio"].min(where=loaded, initial=np.inf))
    if law.full_film and thinnest < 1.0:
        reasons.append(
            f"it describes contacts with a full film, but the film is down to {thinnest:.2g} of the "
            f"composite roughness Rq; its friction coefficient, up to {highest:.2g}, is an extrapolation"
        )
    elif highest > law.largest:
        reasons.append(
            f"its friction coefficient reaches {highest:.2g}; steel in oil has at most about "
            f"{law.largest:g}, so that this is an extrapolation"
        )
    rolling = ROLLING_RESISTANCE[built.case.models.rolling_resistance]
    if law.whole and rolling.sources:
        reasons.append(
            "its coefficient was fitted to whole losses of gears, those of rolling among them; with "
            f"'{rolling.name}' beside it rolling counts twice, here with {_rolling_share(run):.2g} % of "
            "the loss"
        )
    return reasons


def _how_long(outside: np.ndarray, weight: np.ndarray) -> str:
    share = float(np.sum(outside * weight))
    return "throughout" if share > 1.0 - 1e-9 else f"in {100.0 * share:.2g} % of the mesh cycle"


def _rolling_share(run: Mapping[str, np.ndarray]) -> float:
    """Part of the loss in the teeth that rolling takes [%]."""
    rolling, sliding = (
        float(np.sum(np.sum(run[name], axis=(1, 2)) * run["weight"]))
        for name in ("rolling_loss", "sliding_loss")
    )
    return 100.0 * rolling / (rolling + sliding)

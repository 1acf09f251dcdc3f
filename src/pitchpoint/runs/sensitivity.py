"""Which numbers of a case its figures hang on over ranges of all of them: Sobol' indices."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from jaxtyping import Float

from pitchpoint.errors import InputError
from pitchpoint.input.quantities import shown
from pitchpoint.registry import nearest
from pitchpoint.runs.case import CaseLike
from pitchpoint.runs.layouts import FEWEST
from pitchpoint.runs.run import FrictionChoice, Progress
from pitchpoint.runs.study import study

__all__ = ["FIGURES", "indices_of", "indices_of_study", "sobol_indices"]

FIGURES = ("mean_efficiency", "mean_loss", "torque_ripple")
"""Whose variance is parted unless others are named."""

CONFIDENCE = 0.95
"""Part of the resampled indices that lie between the bounds of an index."""

RESAMPLES = 200
"""Resampled indices from which the bounds come."""


def sobol_indices(
    case: CaseLike,
    over: Mapping[str, Any],
    n: int,
    *,
    figures: Sequence[str] = FIGURES,
    seed: int = 0,
    variant: str | None = None,
    friction: FrictionChoice | None = None,
    folder: str | Path | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Parts of the variance of figures that each number of a case has, alone and with others.

    Args:
        case: a `Case`, or what makes one.
        over: lowest and highest value by key, SI numbers or texts with a unit; all values between are equally
            likely, or as the distribution says that `study` takes, those of different keys independent.
        n: designs of each of two samples, a power of two; (keys + 2) n designs are computed in all.
        figures: of the study whose variance is parted.
        seed: the same one draws the same designs.
        variant, friction, folder, workers, scheduler, progress: see `study`.

    Returns:
        `first_order` and `total_order` over `figure`, `law` and `key`, each with bounds `_low` and `_high` in
        which 95 of 100 resampled indices lie; not a number where a figure does not vary. `designs` counts
        those of each sample that entered: where some could not be computed, the largest power of two left.

    Raises:
        InputError: a number of designs that is no power of two, a figure that the study does not have, or
            fewer than 16 designs that can be computed; see `study`.

    From Sobol (2001) by the estimators of Saltelli et al. (2010), on a scrambled Sobol' sequence.
    """
    computed = study(
        case,
        over,
        "saltelli",
        n=n,
        seed=seed,
        variant=variant,
        friction=friction,
        folder=folder,
        workers=workers,
        scheduler=scheduler,
        progress=progress,
    )
    return indices_of_study(computed, figures)


def indices_of_study(computed: xr.Dataset, figures: Sequence[str] = FIGURES) -> xr.Dataset:
    """Sobol' indices of the figures of a study whose designs are those of Saltelli.

    Args:
        computed: what `study(..., how="saltelli")` gave.
        figures: whose variance is parted.

    Returns:
        See `sobol_indices`.

    Raises:
        InputError: a study of another kind, a figure that it does not have, or too few designs with figures.
    """
    layout = json.loads(computed.attrs.get("layout", "{}"))
    if layout.get("how") != "saltelli":
        raise InputError('Sobol\' indices follow from a study by how = "saltelli" alone', key="how")
    keys, n, seed = layout["keys"], layout["n"], layout["seed"]
    data = xr.concat([_figure(computed, name) for name in figures], "figure")
    rows = data.transpose("figure", "law", "design").values.reshape(-1, len(keys) + 2, n)
    sound = np.flatnonzero(np.isfinite(rows).all(axis=(0, 1)))
    count = 1 << max(sound.size.bit_length() - 1, 0)
    if sound.size < FEWEST:
        reasons = {str(reason) for reason in computed["reason"].values.ravel() if str(reason)}
        cause = f": {min(reasons)}" if reasons else ""
        raise InputError(
            f"{sound.size} of {n} designs can be computed with all changes of them{cause}"
        )
    indices = indices_of(rows[..., sound[:count]], seed)
    shape = (len(figures), data.sizes["law"], len(keys))
    return xr.Dataset(
        {
            name: (("figure", "law", "key"), values.reshape(shape))
            for name, values in indices.items()
        },
        {"figure": [*figures], "law": data["law"].values, "key": keys},
        {"designs": count, "asked": n, "seed": seed},
    )


def indices_of(
    rows: Float[np.ndarray, "figure sample design"], seed: int = 0
) -> dict[str, Float[np.ndarray, "figure key"]]:
    """Indices of first and total order, with the bounds of each.

    Args:
        rows: values in both samples, then those of the first one with each key in turn as in the second.
        seed: of the resampling.

    Example:
        >>> import numpy as np
        >>> from scipy.stats import qmc
        >>> first, second = np.split(qmc.Sobol(4, rng=1).random(1024), 2, axis=1)
        >>> linear = np.array([1.0, 2.0])  # variances 1 to 4
        >>> swapped = [np.where(np.arange(2) == key, second, first) for key in (0, 1)]
        >>> found = indices_of(np.stack([one @ linear for one in (first, second, *swapped)])[None])
        >>> found["first_order"].round(2).tolist()
        [[0.2, 0.8]]
    """
    from scipy.stats import sobol_indices as parted

    every: dict[str, list[Float[np.ndarray, " key"]]] = {}
    for sample in rows:
        for name, value in _of_figure(sample, parted, seed).items():
            every.setdefault(name, []).append(value)
    return {name: np.stack(values) for name, values in every.items()}


def _of_figure(
    rows: Float[np.ndarray, "sample design"], parted: Any, seed: int
) -> dict[str, Float[np.ndarray, " key"]]:
    keys = len(rows) - 2
    nothing = np.full(keys, np.nan)
    if not np.ptp(rows[:2]) > ROUNDING * np.abs(rows[:2]).max():
        names = ("first_order", "total_order")
        return {name + end: nothing for name in names for end in ("", "_low", "_high")}
    rng = np.random.default_rng(seed)
    count = rows.shape[1]
    picked = [np.arange(count), *rng.integers(count, size=(RESAMPLES, count))]
    samples = (rows[:, pick] for pick in picked)
    every = [
        parted(func={"f_A": one[0][None], "f_B": one[1][None], "f_AB": one[2:, None]}, n=count)
        for one in samples
    ]
    indices: dict[str, Any] = {}
    for name in ("first_order", "total_order"):
        index, *others = (np.reshape(getattr(one, name), keys) for one in every)
        low, high = np.quantile(
            others, [(1.0 - CONFIDENCE) / 2.0, (1.0 + CONFIDENCE) / 2.0], axis=0
        )
        indices |= {name: index, f"{name}_low": low, f"{name}_high": high}
    return indices


ROUNDING = 1e-9
"""Range of a figure over its size below which it does not vary: what a solver leaves."""


def _figure(found: xr.Dataset, name: str) -> xr.DataArray:
    """One figure over designs and laws; InputError if there is none."""
    dims_of_figure = {"design", "law"}
    figures = [
        str(one)
        for one, data in found.data_vars.items()
        if dims_of_figure == {*map(str, data.dims)}
    ]
    figures = [one for one in figures if np.issubdtype(found[one].dtype, np.floating)]
    if name not in figures:
        raise InputError(
            f"{shown(name)} is no figure of this study{nearest(name, figures)}; it has {', '.join(figures)}"
        )
    return found[name].drop_vars(
        [str(one) for one in found[name].coords if str(one) not in dims_of_figure]
    )

"""Sobol' indices against a closed form."""

import numpy as np
import xarray as xr
from scipy.stats import qmc

import pitchpoint as pp
from pitchpoint.analyses.design_batch import CaseDesigns
from pitchpoint.runs.sensitivity import indices_of


def ishigami(x, a=7.0, b=0.1):
    """Sobol and Levitan (1999)."""
    return np.sin(x[0]) + a * np.sin(x[1]) ** 2 + b * x[2] ** 4 * np.sin(x[0])


def test_indices_of_a_closed_form():
    """Ishigami's function: parts of the variance a^2/8 + b pi^4/5 + b^2 pi^8/18 + 1/2."""
    a, b = 7.0, 0.1
    alone = [0.5 * (1.0 + b * np.pi**4 / 5.0) ** 2, a**2 / 8.0, 0.0]
    shared = b**2 * np.pi**8 * (1.0 / 18.0 - 1.0 / 50.0)  # of the first and the third
    whole = sum(alone) + shared
    both = qmc.scale(qmc.Sobol(6, rng=1).random(2**14), -np.pi, np.pi).T
    first, second = both[:3], both[3:]
    swapped = [np.where((np.arange(3) == key)[:, None], second, first) for key in range(3)]
    found = indices_of(np.stack([ishigami(one) for one in (first, second, *swapped)])[None])
    np.testing.assert_allclose(found["first_order"][0], np.array(alone) / whole, atol=0.02)
    total = (np.array(alone) + np.array([shared, 0.0, shared])) / whole
    np.testing.assert_allclose(found["total_order"][0], total, atol=0.02)
    assert np.all(found["first_order_low"] <= found["first_order"])
    assert np.all(found["first_order"] <= found["first_order_high"])


def test_bounds_are_as_wide_as_95_of_100_indices_of_other_samples():
    """Of a linear function on random designs: some four standard deviations of what other draws give."""
    indices, widths = [], []
    for seed in range(12):
        first, second = np.random.default_rng(seed).random((2, 3, 256))
        swapped = [np.where((np.arange(3) == key)[:, None], second, first) for key in range(3)]
        rows = np.stack([one.sum(axis=0) for one in (first, second, *swapped)])
        found = indices_of(rows[None])
        indices.append(found["first_order"][0])
        widths.append((found["first_order_high"] - found["first_order_low"])[0])
    in_deviations = np.mean(widths) / np.mean(np.std(indices, axis=0))
    assert 2.7 < in_deviations < 5.6


def test_what_does_not_vary_has_no_indices():
    found = indices_of(np.ones((1, 4, 16)))
    assert np.isnan(found["total_order"]).all()


def test_indices_of_a_study_are_those_of_its_layout(monkeypatch):
    """Ishigami's function in the place of a drive, through the layout and the study as users have them."""
    keys = ["operation.torque", "operation.speed", "operation.temperature"]
    ranges = {keys[0]: (20.0, 90.0), keys[1]: (50.0, 300.0), keys[2]: (300.0, 360.0)}
    ends = np.array([*ranges.values()])

    def computed(self, progress=None):
        values = np.array(
            [[float(str(v).split()[0]) for v in one.values()] for one in self.changes]
        )
        share = (values - ends[:, 0]) / (ends[:, 1] - ends[:, 0])
        loss = ishigami((2.0 * share.T - 1.0) * np.pi)
        shape = (1, len(loss))
        whole = {
            "mean_loss": (("law", "point"), loss[None], {"units": "W", "long_name": "loss"}),
            "residual": (("law", "point"), np.zeros(shape)),
            "iterations": (("law", "point"), np.ones(shape, int)),
            "locked": (("law", "point"), np.zeros(shape, bool)),
            "reason": (("law", "point"), np.full(shape, "")),
        }
        solve = {"solve": '{"residual": 0.0, "iterations": 1}'}
        return xr.Dataset(whole, {"law": ["xu_2007"]}, solve)

    monkeypatch.setattr(CaseDesigns, "compute", computed)
    found = pp.sobol_indices("tian2024", ranges, 2**14, figures=["mean_loss"], variant="physical")
    first = found["first_order"].values[0, 0]
    total = found["total_order"].values[0, 0]
    assert found["key"].values.tolist() == keys and found.attrs["designs"] == 2**14
    np.testing.assert_allclose(first, [0.3139, 0.4424, 0.0], atol=0.02)
    np.testing.assert_allclose(total, [0.5576, 0.4424, 0.2437], atol=0.02)

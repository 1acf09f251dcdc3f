"""Part of the load on asperities after Masjedi and Khonsari: values by hand, trends, cuts, gradients."""

import numpy as np
import pytest

from pitchpoint import citations
from pitchpoint._jax import jax, jnp
from pitchpoint.lubrication.asperity_load import masjedi_khonsari_2012
from pitchpoint.lubrication.lubrication_registry import ASPERITY_LOAD

MODULUS, RADIUS, ALPHA = 2.26e11, 0.01, 4500.0 / 2.26e11
GIVEN = {
    "line_load": 1e-4 * MODULUS * RADIUS,
    "entrainment": 1e-11 * MODULUS * RADIUS / 0.04,
    "viscosity": 0.04,
    "pressure_viscosity": ALPHA,
    "radius": RADIUS,
    "modulus": MODULUS,
    "roughness_rq": 2e-5 * RADIUS,
    "hardness": 0.02 * MODULUS,
}


def share(**changed):
    return _share({name: jnp.asarray(value) for name, value in {**GIVEN, **changed}.items()})


@jax.jit
def _share(given):
    return masjedi_khonsari_2012(**given)


def test_values_by_hand():
    assert float(share()) * 100.0 == pytest.approx(22.12545937949713, rel=1e-12)
    slower = share(entrainment=0.1 * GIVEN["entrainment"])
    assert float(slower) * 100.0 == pytest.approx(76.9814652547954, rel=1e-12)


def test_asperities_carry_less_the_thicker_the_film_over_them():
    speeds = jnp.logspace(-5.0, 2.0, 141)
    by_speed = np.asarray(share(entrainment=speeds))
    assert (np.diff(by_speed) <= 0.0).all() and by_speed[0] == 1.0 and by_speed[-1] < 1e-3
    by_viscosity = np.asarray(share(viscosity=0.04 * speeds))
    assert (np.diff(by_viscosity) <= 0.0).all()
    by_roughness = np.asarray(share(roughness_rq=jnp.logspace(-9.0, -5.0, 81)))
    assert (np.diff(by_roughness) >= 0.0).all()


def test_smooth_flanks_leave_it_to_the_film_and_standstill_to_asperities():
    assert float(share(roughness_rq=0.0)) == 0.0
    assert float(share(roughness_rq=1e-12)) == pytest.approx(0.0, abs=1e-12)
    assert float(share(entrainment=0.0)) == 1.0


def test_far_outside_its_range_it_is_cut():
    assert float(share(line_load=4.9e-6 * MODULUS * RADIUS, entrainment=1e-5)) == 1.0


@pytest.mark.parametrize("missing", ["line_load", "entrainment", "roughness_rq"])
def test_gradients_are_finite_where_nothing_is_left(missing):
    slope = jax.grad(lambda value: share(**{missing: value}))(jnp.asarray(0.0))
    assert np.isfinite(slope)


def test_sources_are_known():
    for law in ASPERITY_LOAD.values():
        assert {*law.sources} <= {*citations.available()}

"""Efficiency of helical and internal pairs against integrals and closed forms of the plane of action."""

import dataclasses

import equinox as eqx
import numpy as np
import pytest
from scipy.integrate import quad
from sound import pair

from pitchpoint._jax import jax, jnp
from pitchpoint.efficiency.quasi_static import Design, Models, Operation, cycle
from pitchpoint.efficiency.summary import loss_factor
from pitchpoint.loading.loading_registry import LOAD_SHARING
from pitchpoint.lubrication.lubrication_registry import LAWS, ROLLING_RESISTANCE
from pitchpoint.materials import lubricants
from pitchpoint.materials.solids import Solid
from pitchpoint.materials.surfaces import Roughness

STEEL = Solid(young=206e9, poisson=0.3, density=7850.0)
PA66 = Solid(young=3.54e9, poisson=0.35, density=1140.0)
OIL = lubricants.find("pao-vg-220").build()
ROUGHNESS = Roughness.from_composite_rq(0.8e-6)
SPEED = 188.5
LAW = {law.name: law for law in LAWS}
FRICTION = ("constant", "xu_2007")
FAINT = 1e-7


def few(teeth, module, shift):
    return pair(teeth, 20.0, module, 16e-3, profile_shift=shift, least_tip=0.25)


def plain(mesh):
    """The same pair with what is static made alike, so that few programs are compiled."""
    alike = {"follows": (False, False), "shortened": (False, False)}
    return dataclasses.replace(mesh, lanes=3 if mesh.helical else 2, **alike)


RACK = {"addendum": (1.0, 0.8), "dedendum": (1.25, 1.25), "fillet_radius": (0.38, 0.25)}
RING = {"profile_shift": (0.3, -0.3), **RACK}
MESHES = {
    "GP1": few((4, 51), 1.5e-3, (0.74, 0.05)),
    "GP2": few((4, 51), 1.5e-3, (0.85, -0.06)),
    "GP3": few((6, 77), 1.0e-3, (0.60, 0.29)),
    "GP4": few((6, 77), 1.0e-3, (0.85, 0.04)),
    "V1": pair((24, 95), 10.0, 14e-3, 0.36, profile_shift=(0.48, 0.6691), centre_distance=0.861),
    "external": pair((20, 60), **RING),
    "ring": pair((20, -60), **RING),
    "helical external": pair((20, 60), 15.0, **RING),
    "helical ring": pair((20, -60), 15.0, **RING),
}
GP = tuple(MESHES)[:4]
LOAD = {**dict.fromkeys(MESHES, 300.0), **dict.fromkeys(GP, 5.355), "V1": 1e5}


def operation(load):
    return Operation(*map(jnp.asarray, (load, SPEED, 330.0)))


def models(mu=0.05, sharing="equal", law="constant"):
    return Models(
        tuple(LAW[name] for name in FRICTION),
        jnp.asarray(FRICTION.index(law)),
        {"constant": {"coefficient": jnp.asarray(mu)}},
        LOAD_SHARING[sharing],
        ROLLING_RESISTANCE["none"],
    )


@eqx.filter_jit
def _over_cycle(design, operation, models):
    found = cycle(design, operation, models, nodes=12)
    low, high = found.extremes(found.state.efficiency)
    return {
        "mean_loss": found.mean_loss,
        "mean_efficiency": found.mean_efficiency,
        "ripple": found.ripple,
        "low": low,
        "high": high,
        "residual": found.residual,
        "efficiency": found.state.efficiency,
        "loss": found.state.loss,
        "input_power": found.state.input_power,
        "output_power": found.state.output_power,
        "load": jnp.sum(found.state.balance.load, axis=(0, 1)),
        "torque": found.state.input_torque,
    }


def over_cycle(name, mu=0.05, sharing="equal", law="constant", mesh=None):
    solids = (STEEL, PA66 if name in GP else STEEL)
    design = Design(plain(mesh or MESHES[name]), solids, OIL, ROUGHNESS)
    found = _over_cycle(design, operation(LOAD[name]), models(mu, sharing, law))
    return jax.device_get(found)


@eqx.filter_jit
def _factor(mesh, models):
    return loss_factor(Design(mesh, (STEEL, STEEL), OIL, ROUGHNESS), models)


def factor(mesh):
    return float(_factor(plain(mesh), models()))


# ------------------------------------------------------------------ what the plane of action gives


@dataclasses.dataclass
class Rectangle:
    """The zone of contact, lengths in base pitches along the path and in overlap across it.

    Every contact line is parallel to its diagonal direction: one that entered x base pitches ago
    holds the path from x - overlap to x, clipped to the zone. Per unit of path the line is
    b/(overlap cos(beta_b)) long, the same everywhere, so means over the line are means over its path.
    """

    length: float
    pitch: float
    overlap: float
    scale: float

    @classmethod
    def of(cls, mesh):
        start, end = np.asarray(mesh.limits)
        base, (z1, z2) = float(mesh.base_pitch), np.asarray(mesh.teeth)
        ratio = z2 / z1
        # Sliding over the speed of the base circle is (1 + 1/u) |s - s_C|/r_b1; p_bt = 2 pi r_b1/z1.
        slope = np.cos(float(mesh.base_helix_angle))
        return cls(
            (end - start) / base,
            (float(mesh.pitch_position) - start) / base,
            float(mesh.overlap_ratio),
            np.pi / z1 * (ratio + 1.0) / ratio / slope,
        )

    @property
    def ends(self):
        """Squares of the addendum contact ratios, summed."""
        return (self.length - self.pitch) ** 2 + self.pitch**2

    @property
    def factor(self):
        """Mean over the phase of twice the mean sliding along all contact lines, by adaptive quadrature."""

        def sliding(at):
            return np.sign(at - self.pitch) * (at - self.pitch) ** 2 / 2.0

        def mean(phase):
            entered = phase + np.arange(8)
            low, high = np.clip([entered - self.overlap, entered], 0.0, self.length)
            return np.sum(sliding(high) - sliding(low)) / np.sum(high - low)

        marks = [self.length, self.pitch]
        marks += [mark + self.overlap for mark in (0.0, *marks)]
        bends = sorted({mark % 1.0 for mark in marks})
        found = quad(mean, 0.0, 1.0, points=bends, limit=400, epsabs=0.0, epsrel=1e-11)
        return 2.0 * self.scale * found[0]

    @property
    def whole_overlap(self):
        """The same where the overlap is a whole number: the total length of the lines is constant."""
        return self.scale * self.ends / self.length

    @property
    def ohlendorf(self):
        """The form for spur gears, over cos(beta_b)."""
        return self.scale * (1.0 - self.length + self.ends)


HELICAL = [*GP, "V1", "helical external", "helical ring"]


@pytest.mark.parametrize("name", HELICAL)
def test_loss_factor_of_helical_pairs_is_the_integral_over_the_contact_lines(name):
    expected = Rectangle.of(MESHES[name]).factor
    assert factor(MESHES[name]) == pytest.approx(expected, rel=1e-8)


@pytest.mark.parametrize("name", [*GP, "V1"])
def test_loss_as_friction_vanishes_is_the_loss_factor(name):
    found = over_cycle(name, FAINT)
    power = LOAD[name] * SPEED * float(MESHES[name].teeth[0] / MESHES[name].teeth[1])
    expected = Rectangle.of(MESHES[name]).factor
    assert found["mean_loss"] / (FAINT * power) == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("name", [*GP, "V1"])
def test_contacts_carry_the_transverse_force_over_the_cosine_of_the_base_helix(name):
    mesh = MESHES[name]
    normal = LOAD[name] / (float(mesh.base_radii[1]) * np.cos(float(mesh.base_helix_angle)))
    for sharing in ("equal", "from_stiffness"):
        np.testing.assert_allclose(over_cycle(name, 0.0, sharing)["load"], normal, rtol=1e-12)


@pytest.mark.parametrize("name", HELICAL)
@pytest.mark.parametrize("overlap", [1.0, 2.0])
def test_whole_overlap_has_a_closed_form(name, overlap):
    mesh = MESHES[name]
    width = mesh.face_width * overlap / mesh.overlap_ratio
    mesh = dataclasses.replace(mesh, face_width=width)
    # Up to two more lines than the pair was built for; the same number for all.
    lanes = int(np.ceil(float(mesh.contact_ratio))) + 1
    assert lanes <= 5
    found = float(_factor(dataclasses.replace(plain(mesh), lanes=5), models()))
    assert found == pytest.approx(Rectangle.of(mesh).whole_overlap, rel=1e-9)


def test_spur_form_over_the_cosine_is_the_limit_of_narrow_gears():
    """Helical gears slide as in Ohlendorf's form only while the overlap is small against one."""
    away = []
    for overlap in (1e-3, 2e-3):
        mesh = MESHES["V1"]
        narrow = dataclasses.replace(
            mesh, face_width=mesh.face_width * overlap / mesh.overlap_ratio
        )
        away.append(factor(narrow) / Rectangle.of(narrow).ohlendorf - 1.0)
    assert abs(away[0]) < 1e-3
    assert away[1] / away[0] == pytest.approx(2.0, rel=0.05)
    wide = Rectangle.of(MESHES["V1"])
    assert wide.factor / wide.ohlendorf == pytest.approx(1.174, abs=0.002)


@pytest.mark.parametrize(
    ("name", "closed", "lines"),
    [
        ("GP1", 0.53, 0.485),
        ("GP2", 0.59, 0.514),
        ("GP3", 0.34, 0.358),
        ("GP4", 0.41, 0.396),
    ],
)
def test_loss_factors_of_the_pairs_with_few_teeth(name, closed, lines):
    """The reference values are those of Ohlendorf's form, which these pairs are too wide for.

    Its 1 - eps_alpha stands for a pair that carries alone; with a transverse contact ratio below one
    no pair would carry there. The contact lines give 5 % more to 13 % less.
    """
    rectangle = Rectangle.of(MESHES[name])
    # 0.5802 for GP2, 0.01 below the reference; the other three to both digits.
    assert rectangle.ohlendorf == pytest.approx(closed, abs=0.0101 if name == "GP2" else 0.005)
    assert factor(MESHES[name]) == pytest.approx(lines, abs=6e-4)


# ------------------------------------------------------------------ torques, losses, ripple


@pytest.mark.parametrize("law", FRICTION)
@pytest.mark.parametrize("name", [*GP, "V1"])
def test_efficiency_from_torques_equals_efficiency_from_losses(name, law):
    found = over_cycle(name, sharing="from_stiffness", law=law)
    by_loss = 1.0 - found["loss"] / found["input_power"]
    np.testing.assert_allclose(found["efficiency"], by_loss, rtol=1e-12)
    by_output = found["output_power"] / (found["output_power"] + found["loss"])
    np.testing.assert_allclose(found["efficiency"], by_output, rtol=1e-12)
    assert found["residual"] < 1e-12
    assert 0.9 < found["low"] < found["mean_efficiency"] < found["high"] < 1.0


@pytest.mark.parametrize("sharing", ["equal", "from_stiffness"])
@pytest.mark.parametrize("name", [*GP, "V1"])
def test_instantaneous_efficiency_and_ripple_are_finite_and_periodic(name, sharing):
    """Contact lines grow from nothing and shrink to it, so the end of the period joins its start."""
    found = over_cycle(name, sharing=sharing)
    efficiency, torque = found["efficiency"], found["torque"]
    assert np.all(np.isfinite(efficiency)) and np.all(np.isfinite(torque))
    for values in (efficiency, torque):
        assert values[-1] == pytest.approx(values[0], rel=1e-9)
        assert np.ptp(values) > 1e-3 * np.mean(values), "nothing changes over the cycle"
    slack = 1e-12
    assert found["low"] - slack <= efficiency.min() <= efficiency.max() <= found["high"] + slack
    assert np.ptp(torque) <= found["ripple"] * (1.0 + 1e-9)
    mean = LOAD[name] * float(MESHES[name].teeth[0] / MESHES[name].teeth[1])
    assert 1e-3 < found["ripple"] / mean < 1e-2


def test_input_torque_of_a_helical_pair_hardly_jumps():
    """Lines grow from nothing: the ripple is less than a quarter of that of a narrow pair."""
    mesh = MESHES["V1"]
    narrow = dataclasses.replace(mesh, face_width=1e-3 * mesh.face_width)
    ripples = [over_cycle("V1", mesh=one)["ripple"] for one in (mesh, narrow)]
    assert ripples[0] < 0.25 * ripples[1]


@pytest.mark.parametrize("sharing", ["equal", "from_stiffness"])
def test_efficiency_of_the_pairs_with_few_teeth(sharing):
    """The order is that of the loss factors: the longer the path beyond the pitch point, the more is lost."""
    found = {name: over_cycle(name, 0.05, sharing)["mean_efficiency"] for name in GP}
    assert sorted(found, key=found.get) == ["GP2", "GP1", "GP4", "GP3"]
    for name, efficiency in found.items():
        # The stiff side of the path is the root of the wheel, where sliding is fast.
        more = 1.0 if sharing == "equal" else 1.11
        lost = 0.05 * Rectangle.of(MESHES[name]).factor * more
        assert 1.0 - efficiency == pytest.approx(lost, rel=0.05)


# ------------------------------------------------------------------ internal pairs, straight teeth


@pytest.mark.parametrize("name", ["external", "ring"])
def test_loss_factor_of_internal_gears_has_the_closed_form_with_a_negative_ratio(name):
    """H_V = pi (u + 1)/(z1 u) (1 - eps + e1^2 + e2^2), u = z2/z1 negative for a ring."""
    found = over_cycle(name, FAINT)
    power = LOAD[name] * SPEED / 3.0
    rectangle = Rectangle.of(MESHES[name])
    assert 1.0 < rectangle.length < 2.0
    assert rectangle.scale == pytest.approx(
        np.pi / 20.0 * (4.0 / 3.0 if name == "external" else 2.0 / 3.0), rel=1e-12
    )
    assert found["mean_loss"] / (FAINT * power) == pytest.approx(rectangle.ohlendorf, rel=1e-6)


@pytest.mark.parametrize("law", FRICTION)
def test_ring_pair_is_more_efficient_than_the_external_pair_of_equal_teeth(law):
    external, ring = (over_cycle(name, law=law) for name in ("external", "ring"))
    lost = [1.0 - found["mean_efficiency"] for found in (external, ring)]
    assert 0.2 < lost[1] / lost[0] < 0.6


def test_straight_limit_of_a_helical_pair():
    """A helix of 1e-4 deg: a line takes 4e-6 of the period to enter.

    Means and extremes of the efficiency follow to 1e-6. The ripple hangs on the sliding at the very
    ends of the path, which the slices of a line smear over that much: it follows to twice the overlap.
    """
    narrow = pair((20, 60), 1e-4, **RING)
    straight, helical = over_cycle("external"), over_cycle("external", mesh=narrow)
    for key in ("mean_loss", "mean_efficiency", "low", "high"):
        assert helical[key] == pytest.approx(straight[key], rel=1e-6), key
    overlap = float(narrow.overlap_ratio)
    assert helical["ripple"] == pytest.approx(straight["ripple"], rel=2.0 * overlap)

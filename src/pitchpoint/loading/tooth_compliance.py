"""How far loaded teeth yield, and the stiffness of a pair of teeth per length of contact line."""

from collections.abc import Sequence
from dataclasses import replace
from functools import cache

import equinox as eqx
import numpy as np
from jaxtyping import Array, Bool, Float

from pitchpoint._jax import array, jax, jnp
from pitchpoint.contact.contacts import Contacts
from pitchpoint.contact.ellipse import hertz_1881
from pitchpoint.contact.flattening import line_compression, yang_sun_1985
from pitchpoint.contact.hertz import line_half_width
from pitchpoint.core.doubts import reworded
from pitchpoint.gears.tooth_section import FLANK_NODES, ToothSection, chebyshev_nodes
from pitchpoint.loading.foundation import foundation_compliance, foundation_warnings
from pitchpoint.loading.loading_registry import LINE_STIFFNESS, TOOTH_COMPLIANCE, ToothCompliance
from pitchpoint.materials.solids import Solid

__all__ = [
    "TeethAt",
    "Terms",
    "beam_compliance",
    "bending",
    "interpolate",
    "middle_of_lines",
    "teeth_at",
    "terms_of",
    "tooth_compliance",
    "uncovered",
    "unit_stiffness",
]

# Of the stiffness of a pair eight leave an error of 3e-7; with sixty it is the same to the last digit.
_BEAM_STATIONS = 20
# Without load a contact has no width, and its compliance no bound; what lighter ones have is that of 1 mN/m.
_LEAST_LINE_LOAD = 1e-3
# Of the thickness at the root; the beam goes with its third power, which must not be zero.
_THINNEST = 1e-3
# Chebyshev series grow without bound beyond the flank: rounding may lead there, nothing else does.
_BEYOND = 1e-6
_LEAST_ARC = 1e-18  # m; the slope of a root is endless at zero

Sections = tuple[ToothSection, ToothSection]
Solids = tuple[Solid, Solid]
Field = Float[Array, "pair slice *b"]


class Terms(eqx.Module):
    """Terms of a model of compliance.

    Attributes:
        foundation: one if the body under the tooth yields, else zero.
        weber: True if the contact yields by Weber's law.
        common: True if one modulus stands for both members.
        middle: True if a whole contact line is as stiff as in its middle.
    """

    foundation: Float[Array, ""]
    weber: Bool[Array, ""]
    common: Bool[Array, ""]
    middle: Bool[Array, ""]


def terms_of(name: str, line: str = "integrated") -> Terms:
    """What a model takes into account, as numbers: all models share one compiled program.

    Args:
        name: in `TOOTH_COMPLIANCE`.
        line: in `LINE_STIFFNESS`.
    """
    model = TOOTH_COMPLIANCE[name]
    return Terms(
        foundation=array(float(model.foundation)),
        weber=array(model.contact == "weber"),
        common=array(model.modulus == "common"),
        middle=array(LINE_STIFFNESS[line].name == "middle"),
    )


def uncovered(
    model: ToothCompliance, sections: Sections, names: Sequence[str] = ("gear 1", "gear 2")
) -> tuple[str, ...]:
    """Sentences on what a model does not cover for these teeth; none if it does.

    Args:
        model: of `TOOTH_COMPLIANCE`.
        sections: the tooth of each member.
        names: of the bodies that carry them.
    """
    if not model.foundation:
        return ()
    return tuple(
        reworded(sentence, f"{name}: {{}}.".format)
        for name, section in zip(names, sections, strict=True)
        for sentence in foundation_warnings(section)
    )


def beam_compliance(section: ToothSection, poisson: Float[Array, ""]) -> Float[Array, " node"]:
    """Compliance of a tooth as a beam clamped at the root circle, times E and per length of tooth.

    Bending, shear and compression of the tooth by the load along the flank's normal at each node:
    q E = int M^2/I dy + int (2.4 (1 + nu) cos^2(a) + sin^2(a))/A dy with the moment
    M = (y_p - y) cos(a) - x_p sin(a), I = (2 x)^3/12 and A = 2 x; plane stress, the shear spread
    over the section as in a rectangle.

    Args:
        section: the tooth.
        poisson: Poisson's ratio.

    Returns:
        Displacement of the load point along the load, over the load.

    Source: Weber and Banaschek (1953); Atanasiu et al. (2011), eqs. 17 and 18 with the square of
    the moment, which their dimensions ask for.
    """
    thickness, height, weight = _stations(section)
    half_thickness, node_height = section.flank
    cosine, sine = jnp.cos(section.load_angle), jnp.sin(section.load_angle)
    lever = node_height[:, None] - height
    moment = lever * cosine[:, None] - (half_thickness * sine)[:, None]
    direct = 2.4 * (1.0 + poisson) * cosine**2 + sine**2
    energy = 1.5 * moment**2 / thickness**3 + direct[:, None] / (2.0 * thickness)
    return jnp.sum(energy * weight, axis=1)


def tooth_compliance(section: ToothSection, solid: Solid, terms: Terms) -> Float[Array, " node"]:
    """Compliance of one tooth, with the body under it if the model says so, at the nodes [m2/N].

    Args:
        section: the tooth.
        solid: its material; `young` and `poisson` without axes.
        terms: of an entry of `TOOTH_COMPLIANCE`.

    Source: Weber and Banaschek (1953) for the sum; see `beam_compliance`, `foundation_compliance`.
    """
    shape = beam_compliance(section, solid.poisson)
    return (shape + terms.foundation * foundation_compliance(section)) / solid.young


class TeethAt(eqx.Module):
    """Both teeth at the contacts, whatever these carry and however their flanks are worn.

    Attributes:
        bending: compliance of each tooth per length of contact line [m2/N], or of a whole ellipse [m/N].
        depth: from the flank to the tooth's axis along the load [m].
    """

    bending: tuple[Field, Field]
    depth: tuple[Field, Field]


def teeth_at(contacts: Contacts, sections: Sections, solids: Solids, terms: Terms) -> TeethAt:
    """Teeth where contacts lie on them.

    Args:
        contacts: of a mesh of two gears.
        sections: the tooth of each member.
        solids: the material of each member.
        terms: of an entry of `TOOTH_COMPLIANCE`.
    """
    contacts = _as_stiff(contacts, terms)
    bent = _bending(contacts, sections, _moduli(solids, terms), terms)
    if contacts.shape == "ellipse":
        over = zip(bent, sections, strict=True)
        bent = [one if at.width is None else one / at.width for one, at in over]
    depth = [
        interpolate(_depth(section), section, contacts.flank[k])
        for k, section in enumerate(sections)
    ]
    return TeethAt((bent[0], bent[1]), (depth[0], depth[1]))


def unit_stiffness(
    contacts: Contacts,
    teeth: TeethAt,
    solids: Solids,
    terms: Terms,
    line_load: Float[Array, "..."],
) -> Field:
    """Stiffness of the pairs of teeth along the normal, per length of contact line [N/m2].

    That of an elliptic contact is the whole one [N/m]: its teeth bend over their faces alike, and it yields
    as Hertz has it, whatever the model says of lines.

    Args:
        contacts: of a mesh of two gears.
        teeth: where the contacts lie on them.
        solids: the material of each member.
        terms: of an entry of `TOOTH_COMPLIANCE`.
        line_load: load per length [N/m], or on an ellipse [N], broadcast over the contacts; only contacts
            that do not yield in proportion to it depend on it, and less than 0.001 counts as that.

    Returns:
        Load over approach, a secant where the contact's law is not linear; finite in inactive lanes.

    Source: Atanasiu et al. (2011), eq. 16: deflections of both teeth and of the contact add up.
    """
    contacts = _as_stiff(contacts, terms)
    yielding, both = _moduli(solids, terms), teeth.bending[0] + teeth.bending[1]
    if contacts.shape == "ellipse":
        return 1.0 / (both + _hertz(contacts, yielding, line_load))
    weber = _weber(contacts, teeth, yielding, line_load)
    return 1.0 / (both + jnp.where(terms.weber, weber, _linear(yielding)))


def bending(contacts: Contacts, sections: Sections, solids: Solids, terms: Terms) -> Field:
    """How far both teeth of a pair bend by a load per length of contact line, without their contact [m2/N].

    Args:
        contacts: of a mesh of two gears.
        sections: the tooth of each member.
        solids: the material of each member.
        terms: of an entry of `TOOTH_COMPLIANCE`.

    Source: Atanasiu et al. (2011), eq. 16, less the deflection of the contact.
    """
    contacts = _as_stiff(contacts, terms)
    first, second = _bending(contacts, sections, _moduli(solids, terms), terms)
    return first + second


def middle_of_lines(contacts: Contacts) -> Contacts:
    """Contacts whose slices all lie on their flanks, and curve, as in the middle of their contact line.

    Of involutes: the radius of a profile, and with it the root of its arc length, is linear along the line.

    Args:
        contacts: of a mesh, slices over the whole of each contact line.

    Source: Atanasiu et al. (2011), text after eq. 20, the alternative procedure.
    """
    length = jnp.where(contacts.active, contacts.weight, 0.0)
    whole = jnp.sum(length, axis=1, keepdims=True)
    touches = whole > 0.0

    def mean(values: Field) -> Field:
        found = jnp.sum(length * values, axis=-length.ndim + 1, keepdims=True)
        # Safe in the branch that is not taken too: its derivative would be NaN, which no `where` takes away.
        return jnp.where(touches, found / jnp.where(touches, whole, 1.0), values)

    root = jnp.sqrt(jnp.maximum(contacts.flank, _LEAST_ARC))
    profile = contacts.curvature[:, 0]
    bent = profile != 0.0
    # Safe in the branch that is not taken too: its derivative would be NaN, which no `where` takes away.
    radius = mean(jnp.where(bent, 1.0 / jnp.where(bent, profile, 1.0), 0.0))
    known = bent & (radius != 0.0)
    middle = jnp.where(known, 1.0 / jnp.where(known, radius, 1.0), profile)
    return replace(
        contacts, flank=mean(root) ** 2, curvature=contacts.curvature.at[:, 0].set(middle)
    )


def _as_stiff(contacts: Contacts, terms: Terms) -> Contacts:
    """Contacts where the stiffness of their lines is that of the teeth."""
    if contacts.path.shape[1] == 1:
        return contacts
    there: Contacts = jax.lax.cond(terms.middle, middle_of_lines, lambda them: them, contacts)
    return there


def _bending(contacts: Contacts, sections: Sections, solids: Solids, terms: Terms) -> list[Field]:
    """The same of each tooth, of solids as they yield under these terms."""
    return [
        interpolate(tooth_compliance(section, solid, terms), section, contacts.flank[k])
        for k, (section, solid) in enumerate(zip(sections, solids, strict=True))
    ]


def interpolate(values: Float[Array, " node"], section: ToothSection, flank: Field) -> Field:
    """Values given at the nodes of a tooth, at places on its flank; beyond the ends as at the ends.

    Args:
        values: at the section's nodes.
        section: the tooth.
        flank: arc length along the profile, as in `Contacts.flank` [m].

    Source: Clenshaw (1955), sum of a Chebyshev series; here over the root of the arc length.
    """
    low, high = section.reach[0], section.reach[1]
    root = jnp.sqrt(jnp.maximum(flank, (1e-9 * high) ** 2))
    place = (2.0 * root - low - high) / (high - low)
    # A contact on the very tip must not fall off the end by rounding: its slope would be lost.
    place = jnp.clip(place, -1.0 - _BEYOND, 1.0 + _BEYOND)
    return _clenshaw(jnp.asarray(_to_coefficients()) @ values, place)


def _moduli(solids: Solids, terms: Terms) -> Solids:
    first, second = solids
    common = 2.0 * first.young * second.young / (first.young + second.young)
    one, two = (replace(s, young=jnp.where(terms.common, common, s.young)) for s in solids)
    return one, two


def _linear(solids: Solids) -> Float[Array, ""]:
    young = jnp.stack([solid.young for solid in solids])
    poisson = jnp.stack([solid.poisson for solid in solids])
    return yang_sun_1985(young=young, poisson=poisson)


def _hertz(contacts: Contacts, solids: Solids, load: Float[Array, "..."]) -> Field:
    first, second = (solid.plane_strain_modulus for solid in solids)
    pressed = jnp.maximum(load, _LEAST_LINE_LOAD)
    found = hertz_1881(
        load=pressed,
        radius=contacts.radius,
        transverse_radius=1.0 / contacts.relative_curvature[1],
        modulus=2.0 / (1.0 / first + 1.0 / second),
    )
    return found.approach / pressed


def _weber(
    contacts: Contacts, teeth: TeethAt, solids: Solids, line_load: Float[Array, "..."]
) -> Field:
    first, second = (solid.plane_strain_modulus for solid in solids)
    half_width = line_half_width(
        line_load=jnp.maximum(line_load, _LEAST_LINE_LOAD),
        radius=contacts.radius,
        modulus=2.0 / (1.0 / first + 1.0 / second),
    )
    parts = [
        line_compression(
            young=solid.young,
            poisson=solid.poisson,
            depth=depth,
            half_width=half_width,
        )
        for depth, solid in zip(teeth.depth, solids, strict=True)
    ]
    return parts[0] + parts[1]


def _depth(section: ToothSection) -> Float[Array, " node"]:
    """Distance from the flank to the tooth's axis along the load [m]."""
    return section.flank[0] / jnp.cos(section.load_angle)


def _stations(section: ToothSection) -> tuple[Float[Array, "node station"], ...]:
    """Half thickness, height and integration weight from the root circle up to each node."""
    matrix, weight = _quadrature()
    nodal = jnp.stack([*section.flank, section.slope])
    thickness, height, slope = jnp.moveaxis(
        (nodal @ matrix.T).reshape(3, FLANK_NODES, _BEAM_STATIONS), 0, 0
    )
    fillet = jnp.broadcast_to(
        section.fillet[:, None, :], (2, FLANK_NODES, section.fillet.shape[-1])
    )
    step = jnp.broadcast_to(section.step, fillet.shape[1:])
    joined = jnp.concatenate([fillet[0], thickness], axis=1)
    # A virtual tooth may be pointed where the real one is not.
    joined = jnp.maximum(joined, _THINNEST * joined[:, :1])
    return (
        joined,
        jnp.concatenate([fillet[1], height], axis=1),
        jnp.concatenate([step, slope * weight], axis=1),
    )


def _clenshaw(coefficients: Float[Array, " node"], place: Field) -> Field:
    """Chebyshev series at places in [-1, 1]."""

    def step(
        carry: tuple[Field, Field], value: Float[Array, ""]
    ) -> tuple[tuple[Field, Field], None]:
        later, last = carry
        return (value + 2.0 * place * later - last, later), None

    none = jnp.zeros_like(place)
    (later, last), _ = jax.lax.scan(step, (none, none), coefficients[:0:-1])
    return coefficients[0] + place * later - last


@cache
def _to_coefficients() -> np.ndarray:
    """Matrix from values at the nodes to coefficients of the Chebyshev series."""
    nodes = chebyshev_nodes()
    return np.linalg.inv(np.polynomial.chebyshev.chebvander(nodes, FLANK_NODES - 1))


@cache
def _quadrature() -> tuple[np.ndarray, np.ndarray]:
    """Matrix from nodes to stations below each node, and the stations' weights.

    The stations crowd towards the node like a cube: there a thin tip is thinnest, and a third power
    of the thickness has to be resolved.
    """
    unit, weight = np.polynomial.legendre.leggauss(_BEAM_STATIONS)
    unit, weight = (unit + 1.0) / 2.0, weight / 2.0
    nodes = chebyshev_nodes()
    length = nodes[:, None] + 1.0
    place = nodes[:, None] - length * unit**3
    basis = np.polynomial.chebyshev.chebvander(place.ravel(), FLANK_NODES - 1)
    return basis @ _to_coefficients(), length * 3.0 * unit**2 * weight

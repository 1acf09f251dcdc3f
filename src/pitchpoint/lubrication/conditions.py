"""Conditions at each contact under the names by which the laws of friction and film ask for them."""

import inspect
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from functools import lru_cache
from types import FunctionType
from typing import Any, Protocol, runtime_checkable

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.contact import hertz
from pitchpoint.contact.contact_registry import ELLIPTIC_CONTACT, USUAL_ELLIPSE, EllipticContact
from pitchpoint.contact.contacts import KINDS, TOUCH, Contacts, Shape
from pitchpoint.contact.ellipse import Ellipse
from pitchpoint.core.factored import Numbers, factored_product, product_array
from pitchpoint.errors import InputError
from pitchpoint.gears.contact_lines import PitchPoint

__all__ = [
    "FILM",
    "UNITS",
    "Conditions",
    "Law",
    "demand_shape",
    "evaluate",
    "law_arguments",
    "of_other_shape",
    "shape_of",
]

Lanes = Float[Numbers, "pair slice *#b"]
Each = Float[Numbers, "*#b"]


class Conditions(eqx.Module):
    """State of every contact at given load and speed; laws read its properties by name.

    Attributes:
        contacts: of the mesh.
        load: normal force of each slice [N].
        nominal_load: normal force of the whole mesh without friction [N].
        slip, roll: difference and sum of the surface velocities per radian of the driver [m/rad].
        speed: of the driver [rad/s].
        modulus: E' [Pa], 2/E' = sum of (1 - nu^2)/E.
        temperature: of the oil [K].
        viscosity, kinematic_viscosity: dynamic [Pa s] and kinematic [m2/s], at oil temperature.
        pressure_viscosity: alpha at oil temperature [1/Pa].
        viscosity_slope: -d ln eta/dT at oil temperature [1/K].
        conductivity: of heat, of the oil [W/m/K].
        lubricant_factor: X_L.
        roughness_ra: mean Ra of both flanks [m].
        roughness_rq: composite Rq of both flanks [m].
        hardness: Vickers hardness of the softer flank [Pa]; not a number where one is not known.
        reference: pitch-point values, or None.
        elliptic: how an elliptic contact follows from its load; static.
        film: law of the film thickness that a law asks for; None where it asks for none; static.
    """

    contacts: Contacts
    load: Lanes
    nominal_load: Each
    slip: Lanes
    roll: Lanes
    speed: Each
    modulus: Float[Array, ""]
    temperature: Each
    viscosity: Each
    kinematic_viscosity: Each
    pressure_viscosity: Each
    viscosity_slope: Each
    conductivity: Float[Array, ""]
    lubricant_factor: Float[Array, ""]
    roughness_ra: Float[Array, ""]
    roughness_rq: Float[Array, ""]
    hardness: Float[Array, ""]
    reference: PitchPoint | None
    elliptic: EllipticContact = eqx.field(static=True, default=ELLIPTIC_CONTACT[USUAL_ELLIPSE])
    film: "Law | None" = eqx.field(static=True, default=None)

    @property
    def shape(self) -> Shape:
        """Whether the contacts are lines or ellipses."""
        return self.contacts.shape

    @property
    def line_load(self) -> Lanes:
        """Normal load per length of contact line [N/m]; of line contacts."""
        self._demand("line", "load per length")
        return self.load / self.contacts.weight

    @property
    def speed_a(self) -> Lanes:
        """Surface speed of member 0 relative to the contact [m/s]."""
        return (self.roll + self.slip) / 2.0 * self.speed

    @property
    def speed_b(self) -> Lanes:
        """Surface speed of member 1 relative to the contact [m/s]."""
        return (self.roll - self.slip) / 2.0 * self.speed

    @property
    def entrainment(self) -> Lanes:
        """Mean of the surface speeds, without sign [m/s].

        Source: Hamrock and Dowson (1977), mean surface velocity.
        """
        entrainment: Lanes = factored_product(jnp.abs(self.roll / 2.0), self.speed)
        return entrainment

    @property
    def sliding(self) -> Lanes:
        """Difference of the surface speeds, without sign [m/s].

        Source: Johnson, Contact Mechanics (1985), section 1.2.
        """
        sliding: Lanes = factored_product(jnp.abs(self.slip), self.speed)
        return sliding

    @property
    def slide_roll_ratio(self) -> Lanes:
        """Sliding over entrainment; a matter of geometry, defined at standstill too.

        Source: Xu et al. (2007), SR.
        """
        mean, slip = jnp.abs(self.roll) / 2.0, jnp.abs(self.slip)
        # Safe in the branch that is not taken too: its derivative would be NaN, which no `where` takes away.
        return jnp.where(mean > 0.0, slip / jnp.where(mean > 0.0, mean, 1.0), 0.0)

    @property
    def radius(self) -> Lanes:
        """Relative radius of curvature in the rolling direction [m]."""
        return self.contacts.radius

    @property
    def transverse_radius(self) -> Lanes:
        """Relative radius of curvature across the rolling direction [m]; of elliptic contacts."""
        self._demand("ellipse", "radius across the rolling direction")
        return 1.0 / self.contacts.relative_curvature[1]

    @property
    def pressure(self) -> Lanes:
        """Largest Hertz pressure [Pa]."""
        if self.shape == "ellipse":
            return self.ellipse.pressure
        return hertz.line_pressure(
            line_load=self.line_load, radius=self.radius, modulus=self.modulus
        )

    @property
    def ellipse(self) -> Ellipse:
        """Semi-axes, pressure and approach of each contact; of elliptic contacts."""
        return self.elliptic.function(
            load=product_array(self.load),
            radius=self.radius,
            transverse_radius=self.transverse_radius,
            modulus=self.modulus,
        )

    @property
    def semi_axis_along(self) -> Lanes:
        """Semi-axis of the contact in the rolling direction [m]; of elliptic contacts."""
        return self.ellipse.along

    @property
    def semi_axis_across(self) -> Lanes:
        """Semi-axis of the contact at right angles to the rolling direction [m]; of elliptic contacts."""
        return self.ellipse.across

    @property
    def half_width(self) -> Lanes:
        """Half-width of a line contact [m]; of line contacts."""
        self._demand("line", "half-width")
        return hertz.line_half_width(
            line_load=self.line_load, radius=self.radius, modulus=self.modulus
        )

    @property
    def load_parameter(self) -> Lanes:
        """W of film laws: w/(E' R) of a line [1], F/(E' R_x^2) of an ellipse [1].

        Source: Dowson and Higginson (1959); Hamrock and Dowson (1977).
        """
        force = self.line_load if self.shape == "line" else self.load / self.radius
        return force / (self.modulus * self.radius)

    @property
    def speed_parameter(self) -> Lanes:
        """U of film laws, eta0 u/(E' R) with the mean surface speed [1].

        Source: Dowson and Higginson (1959).
        """
        return self.viscosity * self.entrainment / (self.modulus * self.radius)

    @property
    def material_parameter(self) -> Each:
        """G of film laws, alpha E' [1].

        Source: Dowson and Higginson (1959).
        """
        return self.pressure_viscosity * self.modulus

    @property
    def roughness_parameter(self) -> Lanes:
        """Composite Rq over radius [1].

        Source: Masjedi and Khonsari (2012).
        """
        return self.roughness_rq / self.radius

    @property
    def hardness_parameter(self) -> Each:
        """V, Vickers hardness over E' [1].

        Source: Masjedi and Khonsari (2012).
        """
        return self.hardness / self.modulus

    @property
    def thermal_loading(self) -> Lanes:
        """L of the heat by shear in the inlet, beta eta0 u^2/k with the mean surface speed [1].

        Source: Murch and Wilson (1975); Aihara (1987), equation 20.
        """
        speed = product_array(self.entrainment)
        loading: Lanes = self.viscosity_slope * self.viscosity * speed**2 / self.conductivity
        return loading

    @property
    def ellipticity(self) -> Lanes:
        """Semi-axis across the rolling direction over that along it, (R_y/R_x)^(2/pi) [1].

        Source: Hamrock and Dowson (1977); of elliptic contacts.
        """
        ratio: Lanes = (self.transverse_radius / self.radius) ** (2.0 / jnp.pi)
        return ratio

    @property
    def film_thickness(self) -> Lanes:
        """Film thickness by the film law of the case, minimum or central as that law has it [m].

        That of a contact without load, which no law describes, is zero.
        """
        if self.film is None:
            raise InputError("asks for the film thickness, and no film law stands beside this law")
        load = product_array(self.load)
        at = replace(self, load=jnp.where(load > 0.0, load, 1.0), film=None)
        return jnp.where(load > 0.0, evaluate(self.film, at), 0.0)

    @property
    def lambda_ratio(self) -> Lanes:
        """Film thickness over composite Rq, lambda [1]; infinite between flanks without roughness."""
        rough = self.roughness_rq > 0.0
        ratio = self.film_thickness / jnp.where(rough, self.roughness_rq, 1.0)
        return jnp.where(rough, ratio, jnp.inf)

    @property
    def path_position(self) -> Lanes:
        """Position of the contact from the start of its path [base pitches, circular pitches or turns]."""
        return self.contacts.path

    @property
    def face_position(self) -> Lanes:
        """Position of the contact across the face [m], counted as `Contacts.width`."""
        return self.contacts.width

    @property
    def face_width(self) -> Float[Array, ""]:
        """Face width of the mesh [m]."""
        return self._pitch_point.width

    @property
    def reference_line_load(self) -> Each:
        """Tangential force at the base circle over the face width F_bt/b, without friction [N/m].

        Source: ISO/TR 14179-2:2001, F_bt/b; Tian et al. (2024), eq. 12.
        """
        return self.nominal_load / self._pitch_point.line_length

    @property
    def reference_sum_speed(self) -> Each:
        """Sum of the surface speeds at the pitch point [m/s].

        Source: ISO/TR 14179-2:2001, v_SigmaC; Tian et al. (2024), eq. 12.
        """
        return self.speed * self._pitch_point.sum_speed

    @property
    def reference_radius(self) -> Float[Array, ""]:
        """Relative radius of curvature at the pitch point [m].

        Source: ISO/TR 14179-2:2001, rho_redC; Tian et al. (2024), eq. 12.
        """
        return self._pitch_point.radius

    @property
    def pitch_line_speed(self) -> Each:
        """Speed of the pitch circles [m/s]."""
        return self.speed * self._pitch_point.pitch_line_speed

    def _demand(self, shape: Shape, what: str) -> None:
        """InputError if the contacts have no such quantity."""
        if self.shape != shape:
            raise InputError(f"{KINDS[shape]} have a {what}, and these touch {TOUCH[self.shape]}")

    @property
    def _pitch_point(self) -> PitchPoint:
        if self.reference is None:
            raise InputError(
                "a law for a whole mesh does not apply: this contact has no pitch point"
            )
        return self.reference


FILM = ("film_thickness", "lambda_ratio")
"""Conditions that follow from the film law that stands beside a law."""

# Unit of every condition that a law may ask for by name.
UNITS: Mapping[str, str] = {
    "line_load": "N/m",
    "load": "N",
    "entrainment": "m/s",
    "sliding": "m/s",
    "slide_roll_ratio": "1",
    "speed_a": "m/s",
    "speed_b": "m/s",
    "radius": "m",
    "transverse_radius": "m",
    "pressure": "Pa",
    "half_width": "m",
    "semi_axis_along": "m",
    "semi_axis_across": "m",
    "viscosity": "Pa s",
    "kinematic_viscosity": "m2/s",
    "pressure_viscosity": "1/Pa",
    "viscosity_slope": "1/K",
    "conductivity": "W/m/K",
    "lubricant_factor": "1",
    "temperature": "K",
    "film_thickness": "m",
    "lambda_ratio": "1",
    "path_position": "1",
    "face_position": "m",
    "roughness_ra": "m",
    "roughness_rq": "m",
    "hardness": "Pa",
    "modulus": "Pa",
    "load_parameter": "1",
    "speed_parameter": "1",
    "material_parameter": "1",
    "roughness_parameter": "1",
    "hardness_parameter": "1",
    "thermal_loading": "1",
    "ellipticity": "1",
    "face_width": "m",
    "reference_line_load": "N/m",
    "reference_sum_speed": "m/s",
    "reference_radius": "m",
    "pitch_line_speed": "m/s",
}


_OF_SHAPE: Mapping[str, Shape] = {
    "line_load": "line",
    "half_width": "line",
    "reference_line_load": "line",
    "load": "ellipse",
    "transverse_radius": "ellipse",
    "semi_axis_along": "ellipse",
    "semi_axis_across": "ellipse",
    "ellipticity": "ellipse",
}
"""Conditions that mean something for one shape of contact; a line carries its load per length."""


@runtime_checkable
class Law(Protocol):
    """A published law: a function of conditions with what a user needs to choose it."""

    @property
    def name(self) -> str:
        """Name by which it is chosen."""
        ...

    @property
    def function(self) -> Callable[..., Array]:
        """The law; keyword-only, SI in and out."""
        ...

    @property
    def shape(self) -> Shape | None:
        """Shape of contact for which it holds; None where only what it asks for says that."""
        ...

    @property
    def rivals(self) -> "Iterable[Law]":
        """Laws of the library for the same effect."""
        ...


def shape_of(law: Law | Callable[..., Any]) -> Shape | None:
    """Shape of contact for which a law holds: as its record states, else by what it asks for.

    Args:
        law: a record of the library, or a function.

    Returns:
        None for a law that holds for every shape.

    Example:
        >>> shape_of(lambda *, transverse_radius: 0.05)
        'ellipse'
    """
    stated: Shape | None = getattr(law, "shape", None)
    return stated or _asked(_function(law))


def demand_shape(law: Law | Callable[..., Any], shape: Shape) -> None:
    """InputError if a law does not hold for contacts of this shape.

    Args:
        law: a record of the library, or a function.
        shape: of the contacts.
    """
    why_not = of_other_shape(law, shape)
    if why_not is None:
        return
    fitting = [
        rival.name for rival in getattr(law, "rivals", ()) if shape_of(rival) in (None, shape)
    ]
    choose = f"; choose one of {', '.join(fitting)}" if fitting else ""
    raise InputError(f"{why_not}{choose}")


def of_other_shape(law: Law | Callable[..., Any], shape: Shape) -> str | None:
    """None if a law holds for contacts of this shape, else why not, in one sentence without its stop.

    Args:
        law: a record of the library, or a function.
        shape: of the contacts.
    """
    law_shape = shape_of(law)
    if law_shape is None or law_shape == shape:
        return None
    name = getattr(law, "name", getattr(law, "__name__", "the law"))
    return f"'{name}' holds for {KINDS[law_shape]}, and these touch {TOUCH[shape]}"


def _function(law: Law | Callable[..., Any]) -> Callable[..., Any]:
    return law if callable(law) else law.function


@lru_cache(maxsize=256)
def _asked(function: Callable[..., Any]) -> Shape | None:
    """Shape that alone has what a law asks for; None if every contact has it."""
    parameters = inspect.signature(function).parameters
    return next((_OF_SHAPE[name] for name in parameters if name in _OF_SHAPE), None)


def law_arguments(law: Callable[..., Any]) -> tuple[list[str], dict[str, Any]]:
    """Conditions that a law asks for, and its own parameters with their defaults.

    Raises:
        InputError: the law asks for something that is neither a condition nor has a default.
    """
    if isinstance(law, FunctionType):
        wanted, parameters = _arguments(law)
        return [*wanted], {**parameters}
    return _read_arguments(law)


def _read_arguments(law: Callable[..., Any]) -> tuple[list[str], dict[str, Any]]:
    wanted, parameters = [], {}
    try:
        accepts = inspect.signature(law).parameters
    except (TypeError, ValueError):  # of a builtin, say
        reason = "takes no conditions at a contact by their names; give a function of them"
        raise InputError(f"the law {getattr(law, '__name__', 'given')} {reason}") from None
    for name, parameter in accepts.items():
        if name in UNITS:
            wanted.append(name)
        elif parameter.default is not inspect.Parameter.empty:
            parameters[name] = parameter.default
        else:
            raise InputError(
                f"the law {getattr(law, '__name__', 'given')} asks for '{name}', which is no condition "
                f"at a contact; conditions are {', '.join(UNITS)}"
            )
    return wanted, parameters


_arguments = lru_cache(maxsize=256)(_read_arguments)  # each case asks its laws anew


def evaluate(
    law: Law | Callable[..., Array],
    conditions: Conditions,
    parameters: Mapping[str, Any] | None = None,
) -> Lanes:
    """Value of a law at every contact.

    Args:
        law: a record of the library, or a function with keyword arguments named as in `UNITS`; others
            are its parameters.
        conditions: at the contacts.
        parameters: values of its parameters where they differ from the defaults.

    Raises:
        InputError: the law holds for contacts of another shape.
    """
    demand_shape(law, conditions.shape)
    film = getattr(law, "film", None)
    if film is not None:
        conditions = replace(conditions, film=film)
    function = _function(law)
    wanted, _ = law_arguments(function)
    values = {name: getattr(conditions, name) for name in wanted}
    law_value = _once(function)(**values, **(parameters or {}))
    heating = getattr(law, "heating", None)
    if heating is not None:
        law_value = law_value * evaluate(heating, conditions)
    return jnp.broadcast_to(law_value, conditions.load.shape).astype(conditions.load.dtype)


@lru_cache(maxsize=64)
def _once(law: Callable[..., Array]) -> Callable[..., Array]:
    """The law as a function that is traced once for all places of a program that ask it."""
    return jax.jit(law)

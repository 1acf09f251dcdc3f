"""The table [film] of a case file: contacts whose films are solved, and measured heights of surfaces."""

from collections.abc import Mapping
from math import pi
from typing import Annotated, Final, Literal

from pydantic import AfterValidator, BeforeValidator, model_validator

from pitchpoint.contact.contact_registry import (
    END_PROFILES,
    SUMMITS,
    USUAL_SUMMITS,
    SummitConstants,
)
from pitchpoint.errors import InputError
from pitchpoint.input.kinds import COEFFICIENT, RATIO, Flag, Text
from pitchpoint.input.quantities import Quantity, named
from pitchpoint.input.tables import Table
from pitchpoint.lubrication.ehl.ehl_registry import (
    ASPERITIES,
    MOST_LINE_NODES,
    MOST_PATCH_NODES,
    SMOOTH,
    THERMAL,
    coarser_count,
)
from pitchpoint.materials.materials_registry import DENSITY as LAWS_OF_DENSITY
from pitchpoint.materials.materials_registry import (
    SHEAR_STRESS,
    USUAL_SHEAR_STRESS,
    USUAL_VISCOSITY,
)
from pitchpoint.materials.materials_registry import VISCOSITY as LAWS_OF_VISCOSITY

__all__ = ["MEMBERS", "OF_VISCOSITY", "FilmTable", "HeightTable", "HeightTables"]


FALL = Quantity("temperature coefficient", 0.0, 0.05, "1/K")
FILM_NODES = Quantity("dimensionless", 33, MOST_LINE_NODES, whole=True)
FILM_CELLS = Quantity("dimensionless", 32, 256, whole=True)
END_LENGTH = Quantity("length", 0.0, 1.0, "mm", open_low=True)
END_RADIUS = Quantity("length", 0.0, 1e5, "mm", open_low=True)
END_ANGLE = Quantity("angle", 0.0, pi / 2.0, "deg", open_low=True)
LINE_LOAD = Quantity("line load", 0.0, 1e9, "N/mm", open_low=True)
FILM_PHASES = Quantity("dimensionless", 3, 400, whole=True)
STRESS = Quantity("pressure", 1e3, 1e10, "MPa")
MCEWEN_EXPONENT = Quantity("dimensionless", 0.0, 1000.0, open_low=True)
PALUCH_SHARE = Quantity("dimensionless", 0.0, 1.0)
DIVERGENCE = Quantity("pressure", 1e8, 1e12, "GPa")
REFRACTIVE_INDEX = Quantity("dimensionless", 1.0, 2.0, open_low=True)
OF_SUMMITS = Quantity("dimensionless", 0.0, 10.0, open_low=True)
PATTERN = Quantity("dimensionless", 1 / 9, 9.0)
INLET = Quantity("length", 0.0, 10.0, "mm", open_low=True)
FILM_MOMENTS = Quantity("dimensionless", 2, 400, whole=True)
MAP_STEP = Quantity("length", 0.0, 0.1, "um", open_low=True)
MAP_UNIT = Quantity("length", 0.0, 1.0, "um", open_low=True)
MAP_PLACE = Quantity("length", -1.0, 1.0, "mm")


def _asperities() -> list[str]:
    return [SMOOTH, *ASPERITIES]


def _nodes(value: float) -> float:
    coarser_count(int(value))
    return value


def _cells(value: float) -> float:
    if int(value) & (int(value) - 1):
        raise InputError(f"{value:g} cells along a contact line; allowed are 32, 64, 128 and 256")
    return value


class HeightTable(Table):
    """Measured heights of a surface in a file: rows across the contact, columns along it.

    One column of heights is a profile, and so are two, of places and heights: it was measured along the
    surface speeds, or across them as `direction` says, and is the same everywhere the other way. A profile
    takes the step of its own way alone; places are evenly apart, in any unit of length. Files x3p
    (ISO 25178-72) say steps and unit themselves.

    `unit` is what a height of one in the file is. The middle of the map lies in that of the contact unless
    `middle_along` and `middle_across` say otherwise. It has to cover the contact unless it is `periodic`: one
    that repeats, whose last row and column are the first ones of the next period, with the same heights.
    """

    file: Text
    """File of the heights beside the case file: .csv, .txt, .npy or .x3p."""
    step_along: Annotated[float, MAP_STEP] | None = None
    """Distance between columns, along the surface speeds; needed by maps and by profiles along them."""
    step_across: Annotated[float, MAP_STEP] | None = None
    """Distance between rows, across the surface speeds; needed by maps and by profiles across them."""
    direction: Literal["along", "across"] = "along"
    """Way along which a profile was measured; a map has both."""
    unit: Annotated[float, MAP_UNIT] = 1e-6
    """What a height of one in the file is."""
    middle_along: Annotated[float, MAP_PLACE] = 0.0
    """Middle of the map from that of the contact, along the surface speeds."""
    middle_across: Annotated[float, MAP_PLACE] = 0.0
    """Middle of the map from that of the contact, across the surface speeds."""
    periodic: Flag = False
    """Whether the map repeats; else it has to cover the contact."""


class HeightTables(Table):
    """Height maps of the surfaces in contact, or of both together, which stays where it is."""

    gear_1: HeightTable | None = None
    """Height map of gear 1, which moves along with its surface in films with squeeze."""
    gear_2: HeightTable | None = None
    """Height map of gear 2, which moves along with its surface in films with squeeze."""
    both: HeightTable | None = None
    """Height map of both together, which stays where it is."""


class FilmTable(Table):
    """Films of the contacts solved over the mesh cycle; what is left out is as `FilmModel` has it.

    `phases` are the least number of states over a mesh cycle; `in_series` asks what the films take from the
    torsional stiffness. With the `time` "squeeze" one pair is followed through its engagement as well, at no
    more than `moments`. The parameters are those of the shear law, and
    of the profile of the ends.
    """

    solver: Literal["line", "finite_line", "elliptic"]
    """Contacts that are solved: lines without ends, lines as long as they are, or ellipses."""
    phases: Annotated[float, FILM_PHASES] = 24.0
    """Least number of states over a mesh cycle."""
    in_series: Flag = False
    """Whether to tell what films in series take from the torsional stiffness."""
    nodes: Annotated[float, FILM_NODES, AfterValidator(_nodes)] | None = None
    """Nodes along the motion: 33, 65, ...; unless given 129, or 65 over patches, doubled above M = 100."""
    cells: Annotated[float, FILM_CELLS, AfterValidator(_cells)] | None = None
    """Cells across the motion: 32, 64, 128 or 256; one less than nodes unless given."""
    time: Literal["steady", "squeeze"] | None = None
    """Steady films alone, or one pair followed with squeeze as well; steady unless given."""
    moments: Annotated[float, FILM_MOMENTS] | None = None
    """Most moments of the engagement with squeeze; 40 unless given."""
    heights: HeightTables | None = None
    """Measured heights of the surfaces; none unless given."""
    ends: Literal["half_space", "mirrored"] | None = None
    """Whether bodies go on beyond a line or both end with it; half_space unless given."""
    end_profile: Annotated[str, BeforeValidator(named(END_PROFILES.keys, "end profile"))] | None = (
        None
    )
    """Profile of the ends of contact lines; none unless given."""
    end_length: Annotated[float, END_LENGTH] | None = None
    """Length of each end along the face, of chamfered and dub_off ends."""
    end_radius: Annotated[float, END_RADIUS] | None = None
    """Radius of the arc of crowned and dub_off ends."""
    end_angle: Annotated[float, END_ANGLE] | None = None
    """Angle between bevel and face of chamfered ends."""
    end_line_load: Annotated[float, LINE_LOAD] | None = None
    """Line load for which log_relieved ends make the pressure even."""
    end_drop: Annotated[float, END_LENGTH] | None = None
    """Largest drop of log_relieved ends; without bound unless given."""
    viscosity_law: (
        Annotated[
            str, BeforeValidator(named(LAWS_OF_VISCOSITY.keys, "law of viscosity under pressure"))
        ]
        | None
    ) = None
    """Law of the viscosity under pressure; roelands_1966 unless given."""
    density_law: (
        Annotated[
            str, BeforeValidator(named(LAWS_OF_DENSITY.keys, "law of density under pressure"))
        ]
        | None
    ) = None
    """Law of the density under pressure; dowson_higginson_1966 unless given."""
    shear_law: (
        Annotated[str, BeforeValidator(named(SHEAR_STRESS.keys, "law of shear stress"))] | None
    ) = None
    """Law of the shear stress; ree_eyring_1955 unless given."""
    mcewen_exponent: Annotated[float, MCEWEN_EXPONENT] | None = None
    """Exponent q of bair_2015; 3 unless given, assumed."""
    paluch_share: Annotated[float, PALUCH_SHARE] | None = None
    """Part of the pressure-viscosity coefficient by the Paluch term of bair_2015; 0.36 unless given."""
    divergence_pressure: Annotated[float, DIVERGENCE] | None = None
    """Pressure at which that term goes to infinity; 4.7 GPa unless given, assumed."""
    eyring_stress: Annotated[float, STRESS] | None = None
    """Eyring stress of ree_eyring_1955; 5 MPa unless given, assumed."""
    critical_stress: Annotated[float, STRESS] | None = None
    """Shear stress from which on carreau_1972 thins; 7 MPa unless given, recalled of thin hydrocarbons."""
    shear_exponent: Annotated[float, RATIO] | None = None
    """Exponent n of carreau_1972; 0.45 unless given, assumed."""
    limiting_coefficient: Annotated[float, COEFFICIENT] | None = None
    """Rise of the limiting shear stress with pressure, where the law has one; 0.08 unless given, assumed."""
    limiting_stress: Annotated[float, STRESS] | None = None
    """Limiting shear stress without pressure, where the law has one; 2 MPa unless given, assumed."""
    limiting_fall: Annotated[float, FALL] | None = None
    """Relative fall of the limiting shear stress per kelvin; none unless given, no figure was found."""
    asperities: (
        Annotated[str, BeforeValidator(named(_asperities, "law of asperity contact"))] | None
    ) = None
    """Law of asperity contact, or none for smooth flanks; greenwood_tripp_1970 unless given."""
    summits: Annotated[str, BeforeValidator(named(SUMMITS.keys, "set of summits"))] | None = None
    """Set of constants of the summits of asperities; textbooks unless given, all sets are assumed."""
    eta_beta_sigma: Annotated[float, OF_SUMMITS] | None = None
    """Summits per area times their radius times Rq; that of the set of summits unless given, 0.05."""
    sigma_over_beta: Annotated[float, OF_SUMMITS] | None = None
    """Rq over the radius of summits; that of the set of summits unless given, 0.01."""
    pattern: Annotated[float, PATTERN] | None = None
    """Peklenik's number γ of the roughness; 1, without a direction, unless given."""
    boundary_friction: Annotated[float, COEFFICIENT] | None = None
    """Friction coefficient of asperities that touch; 0.1 unless given, assumed."""
    refractive_index: Annotated[float, REFRACTIVE_INDEX] | None = None
    """Index of the oil at ambient pressure, with which interferometry reads films; none unless given."""
    inlet: Annotated[float, INLET] | None = None
    """Distance ahead of a contact at which oil begins; a module, without teeth flooded, unless given."""
    thermal: (
        Annotated[str, BeforeValidator(named(THERMAL.keys, "thermal effect of a film"))] | None
    ) = None
    """Heat in the film; isothermal unless given."""

    @property
    def shear_parameters(self) -> dict[str, float]:
        """Parameters of the shear law that were given, by name [SI]."""
        return self._named(_OF_SHEAR)

    @property
    def viscosity_parameters(self) -> dict[str, float]:
        """Parameters of the law of viscosity that were given, by name [SI]."""
        return self._named(OF_VISCOSITY)

    def _named(self, names: tuple[str, ...]) -> dict[str, float]:
        values = {name: getattr(self, name) for name in names}
        return {name: value for name, value in values.items() if value is not None}

    @property
    def set_of_summits(self) -> SummitConstants:
        """Constants of summits of which nothing else is given."""
        return SUMMITS[self.summits or USUAL_SUMMITS]

    @property
    def over_patch(self) -> bool:
        """True if films are solved over the whole patch of a contact, not as those of lines without ends."""
        return self.solver != "line"

    @property
    def squeezes(self) -> bool:
        """True if the film of a pair is followed through its engagement, with squeeze."""
        return self.time == "squeeze"

    @property
    def profile_parameters(self) -> dict[str, float]:
        """Parameters of the profile of the ends that were given, by the names that it has for them [SI]."""
        stated = {name.removeprefix("end_"): getattr(self, name) for name in _OF_ENDS}
        return {name: value for name, value in stated.items() if value is not None}

    @model_validator(mode="after")
    def _of_solver(self) -> "FilmTable":
        for key, why in _NOT_OF[self.solver].items():
            if getattr(self, key) is not None:
                raise InputError(f"was given; {why}", key=key)
        if self.over_patch:
            _check_patch(self)
        else:
            _check_line(self)
        if self.squeezes and self.thermal not in (None, "isothermal"):
            message = f'"{self.thermal}" was given; films with squeeze are isothermal: leave it or time out'
            raise InputError(message, key="thermal")
        if self.moments is not None and not self.squeezes:
            message = 'was given without time = "squeeze", to which it belongs'
            raise InputError(message, key="moments")
        return self

    @model_validator(mode="after")
    def _of_profile(self) -> "FilmTable":
        stated = self.profile_parameters
        if self.end_profile is None:
            for name in stated:
                raise InputError(
                    "was given without end_profile, to which it belongs", key=f"end_{name}"
                )
            return self
        needed, parameters = END_PROFILES[self.end_profile].parameters
        for name in stated:
            if name not in parameters:
                has = ", ".join(f"end_{parameter}" for parameter in parameters) or "none"
                message = f"is no parameter of {self.end_profile}; it has {has}"
                raise InputError(message, key=f"end_{name}")
        for name in needed:
            if name not in stated:
                raise InputError(f"is missing; {self.end_profile} asks for it", key=f"end_{name}")
        return self

    @model_validator(mode="after")
    def _own(self) -> "FilmTable":
        laws = (
            (SHEAR_STRESS[self.shear_law or USUAL_SHEAR_STRESS], self.shear_parameters),
            (LAWS_OF_VISCOSITY[self.viscosity_law or USUAL_VISCOSITY], self.viscosity_parameters),
        )
        for law, named_here in laws:
            has = [name for name in law.parameters if name in FilmTable.model_fields]
            for key in named_here.keys() - {*has}:
                message = f"is no parameter of {law.name}; it has {', '.join(has) or 'none'}"
                raise InputError(message, key=key)
        for key in _OF_ROUGH if self.asperities == SMOOTH else ():
            if getattr(self, key) is not None:
                message = "was given without asperities, to which it belongs"
                raise InputError(message, key=key)
        if None not in (self.summits, self.eta_beta_sigma, self.sigma_over_beta):
            message = "was given with both constants of a set: leave out it or one of them"
            raise InputError(message, key="summits")
        return self


_OF_SHEAR = (
    "eyring_stress",
    "critical_stress",
    "shear_exponent",
    "limiting_coefficient",
    "limiting_stress",
    "limiting_fall",
)
OF_VISCOSITY = ("mcewen_exponent", "paluch_share", "divergence_pressure")
"""Keys of `[film]` that are parameters of a law of viscosity under pressure."""

_OF_ROUGH = ("summits", "eta_beta_sigma", "sigma_over_beta", "pattern", "boundary_friction")
_OF_ENDS = ("end_length", "end_radius", "end_angle", "end_line_load", "end_drop")
_NO_ENDS = 'lines of this solver have no ends; take solver = "finite_line", or leave it out'
_STEADY = (
    'films of this solver are steady; take solver = "finite_line" or "elliptic", or leave it out'
)
_EVEN = (
    '"across" was given; lines of this solver are the same all along, and take profiles along the surface '
    'speeds; take solver = "finite_line", or leave it out'
)
_NOT_READ = 'films that are read by interferometry are those of solver = "elliptic"; leave it out'
_ELLIPSE = "an ellipse ends by itself; leave it out"
_NOT_OF: Mapping[str, Mapping[str, str]] = {
    "line": {
        **{key: _NO_ENDS for key in ("cells", "ends", "end_profile", *_OF_ENDS)},
        **dict.fromkeys(("time", "moments"), _STEADY),
        "refractive_index": _NOT_READ,
    },
    "finite_line": {"refractive_index": _NOT_READ},
    "elliptic": {key: _ELLIPSE for key in ("ends", "end_profile", *_OF_ENDS)},
}
"""Keys that a solver of films has nothing to do with, and why."""


def _check_line(table: FilmTable) -> None:
    """InputError for profiles that lines without ends do not take."""
    for name, heights in table.heights or ():
        if heights is not None and heights.direction == "across":
            raise InputError(_EVEN, key=f"heights.{name}.direction")


def _check_patch(table: FilmTable) -> None:
    """InputError for what solvers over a patch do not take."""
    if table.nodes is not None and table.nodes > MOST_PATCH_NODES:
        message = (
            f"{table.nodes:g} nodes along a patch; allowed are 33, 65, 129 and {MOST_PATCH_NODES}"
        )
        raise InputError(message, key="nodes")
    if table.pattern not in (None, 1.0):
        message = "over a patch oil flows both ways, and only the pattern 1 is the same for both"
        raise InputError(f"{table.pattern:g} was given; {message}", key="pattern")


MEMBERS: Final[Mapping[str, int | None]] = {"gear_1": 0, "gear_2": 1, "both": None}
"""Surfaces that a map is of, by key, and the body that takes it along."""

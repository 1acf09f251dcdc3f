"""What a case may choose by name of lubricated contacts: laws of friction, film, rolling and asperities."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

from pitchpoint.registry import Deferred, Registry

if TYPE_CHECKING:
    from jaxtyping import Array

    from pitchpoint.contact.contacts import Shape
    from pitchpoint.lubrication.ehl.model import FilmModel

__all__ = [
    "ASPERITY_LOAD",
    "BOUNDARY",
    "FILM_THICKNESS",
    "INLET_HEATING",
    "LAWS",
    "ROLLING_RESISTANCE",
    "USUAL_BOUNDARY",
    "AsperityLoad",
    "ChosenLaws",
    "FilmThickness",
    "FrictionLaw",
    "InletHeating",
    "RollingResistance",
]

BOUNDARY: Final = 0.2
"""Coefficient that steel in oil does not exceed in boundary lubrication."""

USUAL_BOUNDARY: Final = 0.1
"""Coefficient of steel in oil in boundary lubrication, about."""


@dataclass(frozen=True, eq=False)
class FrictionLaw:
    """A friction law with what a user needs to choose it.

    Attributes:
        name: name of the function.
        title: name to show.
        function: the law; keyword-only, SI in, coefficient out.
        sources: keys of the bibliography.
        ranges: range of arguments in SI, of its fit or of its form, as the note says; empty where
            no source states one.
        largest: coefficient beyond which it describes no lubricated contact that it was fitted to.
        whole: True if it was fitted to whole losses of gears, with those of rolling in them.
        local: True if the law holds at each contact, False if it gives one mean for the mesh.
        note: what it was fitted on, and cautions.
        full_film: True if it describes contacts that a film separates.
        check: arguments in SI and the value computed from the printed formula in printed units; None of a
            law that is no formula.
        shape: of the contacts for which it holds; None where what it asks for says that.
        films: choices by which the films of the contacts are solved, in turns with the balance of forces;
            None of a formula.
        film: law of the film thickness, for one that asks for it; None for others.
    """

    name: str
    title: str
    function: Deferred[Callable[..., Array]] = Deferred()
    sources: tuple[str, ...] = ()
    check: tuple[dict[str, float], float] | None = None
    ranges: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    local: bool = True
    note: str = ""
    full_film: bool = False
    largest: float = math.inf
    whole: bool = False
    shape: Shape | None = None
    films: FilmModel | None = None
    film: FilmThickness | None = None

    @property
    def rivals(self) -> "Iterable[FrictionLaw]":
        """Laws of the library."""
        return LAWS


ChosenLaws = tuple[FrictionLaw | str, ...]
"""Laws in place of those of a case: the user's own, and by name those of the library; none if empty."""


LAWS: Final[tuple[FrictionLaw, ...]] = (
    FrictionLaw(
        name="constant",
        title="Constant coefficient",
        function="pitchpoint.lubrication.friction_coefficient:constant",
        sources=(),
        check=({"coefficient": 0.06}, 0.06),
        note="One coefficient for every contact. The default 0.05 is a round figure, not a fit.",
    ),
    FrictionLaw(
        name="frictionless",
        title="Frictionless",
        function="pitchpoint.lubrication.friction_coefficient:frictionless",
        sources=(),
        check=({}, 0.0),
        note="No friction: the reference case.",
    ),
    FrictionLaw(
        name="iso_tr_14179_2",
        title="ISO/TR 14179-2 (Schlenk), mesh mean",
        function="pitchpoint.lubrication.friction_coefficient:iso_tr_14179_2",
        sources=("iso_tr_14179_2_2001", "tian_2024"),
        check=(
            {
                "reference_line_load": 117.3e3,
                "reference_sum_speed": 2.90,
                "reference_radius": 6.156e-3,
                "viscosity": 0.050,
                "roughness_ra": 0.8e-6,
                "lubricant_factor": 1.0,
            },
            0.0543983233897726,
        ),
        local=False,
        note=(
            "Mean coefficient fitted to losses of gear test rigs, those of rolling among them; use it"
            " with the load of the whole mesh and without a rolling resistance. The factor X_L of the oil,"
            " lubricant.lubricant_factor, multiplies it, and acts nowhere else: for oils of the catalogue"
            " 0.846 of mineral ones, 0.65 of PAO and ester, 0.585 of polyglycol, fitted (Fernandes 2022)"
            " and not those of the standard, in which mineral oil has 1. No range of the"
            " fit was found: the limits are those of its form, by which flanks without roughness have no"
            " friction, and of steel in oil."
        ),
        shape="line",
        ranges={"roughness_ra": (1e-8, math.inf)},
        largest=BOUNDARY,
        whole=True,
    ),
    FrictionLaw(
        name="xu_2007",
        title="Xu and Kahraman 2007, EHL regression",
        function="pitchpoint.lubrication.friction_coefficient:xu_2007",
        sources=("xu_2007", "xu_2005"),
        check=(
            {
                "pressure": 1e9,
                "slide_roll_ratio": 0.3,
                "entrainment": 10.0,
                "viscosity": 0.010,
                "radius": 0.01,
                "roughness_rq": 0.5e-6,
            },
            0.0210243789171055,
        ),
        note=(
            "Regression of thermal EHL solutions for one 75W90 gear oil. Zero at pure rolling;"
            " doubly exponential in roughness, so too high for rough flanks or mixed friction. No"
            " range of the fit was found: the limits are those of its form, which takes the logarithm"
            " of the viscosity in mPa s, and of a full film."
        ),
        ranges={"viscosity": (1e-3, math.inf)},
        full_film=True,
        largest=BOUNDARY,
    ),
)


@dataclass(frozen=True, eq=False)
class FilmThickness:
    """A named film law; `function` gives metres, `place` says minimum or central film.

    It holds for contacts of one `shape`; outside of its `ranges`, of conditions in SI, it still answers,
    and the result says so. Without any no source was found that states one. Where `heating` is given it
    is multiplied by that factor of the heat in the inlet.
    """

    name: str
    title: str
    function: Deferred[Callable[..., Array]] = Deferred()
    sources: tuple[str, ...] = ()
    place: str = "minimum"
    shape: Shape = "line"
    note: str = ""
    ranges: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    heating: Deferred[Callable[..., Array] | None] = Deferred(None)

    @property
    def rivals(self) -> "Iterable[FilmThickness]":
        """Film laws of the library."""
        return FILM_THICKNESS.values()


_HAMROCK_DOWSON = {"ellipticity": (1.0, 8.0)}


_PAN_HAMROCK = {
    "load_parameter": (0.2045e-4, 5.0e-4),
    "speed_parameter": (1.0e-12, 5.05e-11),
    "material_parameter": (2504.0, 7511.0),
}


_PAN_HAMROCK_NOTE = (
    "Fitted to an oil that is compressible and follows Roelands; limits recalled, unconfirmed."
)


FILM_THICKNESS = Registry(
    "film thickness law",
    FilmThickness(
        "dowson_higginson_1959",
        "Dowson-Higginson, line",
        "pitchpoint.lubrication.film_thickness:dowson_higginson_1959",
        ("dowson_higginson_1959",),
        "minimum",
    ),
    FilmThickness(
        "dowson_1968",
        "Dowson, line",
        "pitchpoint.lubrication.film_thickness:dowson_1968",
        ("dowson_1968",),
        "minimum",
        note="The later exponent of the material parameter, 0.54 for 0.6.",
    ),
    FilmThickness(
        "dowson_toyoda_1979",
        "Dowson-Toyoda, line, central film",
        "pitchpoint.lubrication.film_thickness:dowson_toyoda_1979",
        ("dowson_toyoda_1979",),
        "central",
    ),
    FilmThickness(
        "pan_hamrock_1989",
        "Pan-Hamrock, line",
        "pitchpoint.lubrication.film_thickness:pan_hamrock_1989",
        ("pan_hamrock_1989",),
        "minimum",
        note=_PAN_HAMROCK_NOTE,
        ranges=_PAN_HAMROCK,
    ),
    FilmThickness(
        "pan_hamrock_1989_central",
        "Pan-Hamrock, line, central film",
        "pitchpoint.lubrication.film_thickness:pan_hamrock_1989_central",
        ("pan_hamrock_1989",),
        "central",
        note=_PAN_HAMROCK_NOTE,
        ranges=_PAN_HAMROCK,
    ),
    FilmThickness(
        "moes_1992",
        "Moes, line, central film in every regime",
        "pitchpoint.lubrication.film_thickness:moes_1992",
        ("moes_1992",),
        "central",
        note=(
            "Of an incompressible oil that follows Barus: 12 to 19 % thicker than solutions with a "
            "compressible oil at 0.4 to 1.5 GPa."
        ),
    ),
    FilmThickness(
        "hamrock_dowson_1977",
        "Hamrock-Dowson, ellipse",
        "pitchpoint.lubrication.film_thickness:hamrock_dowson_1977",
        ("hamrock_dowson_1977",),
        "minimum",
        "ellipse",
        "Fitted to contacts as wide across the rolling direction as along it, or wider, up to a ratio of 8.",
        _HAMROCK_DOWSON,
    ),
    FilmThickness(
        "hamrock_dowson_1977_central",
        "Hamrock-Dowson, ellipse, central film",
        "pitchpoint.lubrication.film_thickness:hamrock_dowson_1977_central",
        ("hamrock_dowson_1977",),
        "central",
        "ellipse",
        "Fitted to contacts as wide across the rolling direction as along it, or wider, up to a ratio of 8.",
        _HAMROCK_DOWSON,
    ),
)


@dataclass(frozen=True, eq=False)
class RollingResistance:
    """A named model of rolling resistance; `function` gives N per metre of contact line and surface.

    Of elliptic contacts it gives N for each surface, over their whole width. It holds for contacts of one
    `shape`, or of any (None). Where `heating` is given it is multiplied by that factor of the heat in the
    inlet.
    """

    name: str
    title: str
    function: Deferred[Callable[..., Array]] = Deferred()
    sources: tuple[str, ...] = ()
    note: str = ""
    shape: Shape | None = None
    heating: Deferred[Callable[..., Array] | None] = Deferred(None)

    @property
    def rivals(self) -> "Iterable[RollingResistance]":
        """Models of the library."""
        return ROLLING_RESISTANCE.values()


ROLLING_RESISTANCE = Registry(
    "rolling resistance",
    RollingResistance(
        "none", "no rolling resistance", "pitchpoint.lubrication.rolling_resistance:none"
    ),
    RollingResistance(
        "wu_cheng_1991",
        "isothermal rolling resistance of a line contact",
        "pitchpoint.lubrication.rolling_resistance:wu_cheng_1991",
        ("goksem_hargreaves_1978", "wu_cheng_1991"),
        "Fully flooded line contacts; force per length and surface, it brakes both. Isothermal: it rises "
        "with speed where measured ones level off, which inlet_heating follows (Aihara 1987).",
        "line",
    ),
    RollingResistance(
        "wu_cheng_1991_strips",
        "isothermal rolling resistance of a wide elliptic contact, strip by strip",
        "pitchpoint.lubrication.rolling_resistance:wu_cheng_1991_strips",
        ("goksem_hargreaves_1978", "wu_cheng_1991"),
        "Fully flooded contacts, wide across the rolling direction; force per surface, it brakes both. "
        "Isothermal: it rises with speed where measured ones level off, which inlet_heating follows.",
        "ellipse",
    ),
)


@dataclass(frozen=True, eq=False)
class InletHeating:
    """A named effect of the heat in the inlet.

    Attributes:
        name: by which it is chosen.
        title: name to show.
        film: factor of the film thickness; None for none.
        rolling: factor of the rolling resistance; None for none.
        sources: keys of the bibliography.
        note: what it was fitted to, and cautions.
    """

    name: str
    title: str
    film: Deferred[Callable[..., Array] | None] = Deferred(None)
    rolling: Deferred[Callable[..., Array] | None] = Deferred(None)
    sources: tuple[str, ...] = ()
    note: str = ""


INLET_HEATING = Registry(
    "inlet heating",
    InletHeating("none", "isothermal inlet"),
    InletHeating(
        "murch_wilson_1975",
        "Murch-Wilson, Aihara; pure rolling",
        "pitchpoint.lubrication.inlet_heating:murch_wilson_1975",
        "pitchpoint.lubrication.inlet_heating:aihara_1987",
        ("murch_wilson_1975", "wilson_sheu_1983", "aihara_1987"),
        "Line contacts that roll; the resistance was measured for a thermal loading up to several tens.",
    ),
    InletHeating(
        "wilson_sheu_1983",
        "Wilson-Sheu, Aihara; sliding too",
        "pitchpoint.lubrication.inlet_heating:wilson_sheu_1983",
        "pitchpoint.lubrication.inlet_heating:aihara_1987",
        ("wilson_sheu_1983", "aihara_1987"),
        "Line contacts that roll and slide; sliding does not enter the factor of the resistance.",
    ),
    InletHeating(
        "zhu_cheng_1988",
        "Zhu-Cheng, one factor for film and rolling resistance",
        "pitchpoint.lubrication.inlet_heating:zhu_cheng_1988",
        "pitchpoint.lubrication.inlet_heating:zhu_cheng_1988",
        ("zhou_hoeprich_1991",),
        "Rolling and sliding contacts under pressure; known from Gupta et al. (1992) too. Torques of tapered "
        "roller bearings support it for the resistance.",
    ),
)


@dataclass(frozen=True, eq=False)
class AsperityLoad:
    """A named law of the asperity load ratio; `function` gives the part of the load, 0 to 1.

    It holds for contacts of one `shape`, or of any (None); outside of its `ranges`, of conditions in SI, it
    still answers, and the result says so.
    """

    name: str
    title: str
    function: Deferred[Callable[..., Array]] = Deferred()
    sources: tuple[str, ...] = ()
    note: str = ""
    shape: Shape | None = None
    ranges: Mapping[str, tuple[float, float]] = field(default_factory=dict)

    @property
    def rivals(self) -> "list[AsperityLoad]":
        """Laws of the library."""
        return list(ASPERITY_LOAD.values())


ASPERITY_LOAD = Registry(
    "asperity load law",
    AsperityLoad("none", "no load on asperities", "pitchpoint.lubrication.asperity_load:none"),
    AsperityLoad(
        "masjedi_khonsari_2012",
        "Masjedi-Khonsari, rough line contact",
        "pitchpoint.lubrication.asperity_load:masjedi_khonsari_2012",
        ("masjedi_khonsari_2012", "zhao_2022"),
        "Asks for the hardness of both gears, of which the softer one counts. The limits are recalled, "
        "unconfirmed, as are its film formulas, which are left out for that.",
        "line",
        {
            "load_parameter": (2e-5, 5e-4),
            "speed_parameter": (1e-12, 1e-10),
            "material_parameter": (2500.0, 7500.0),
            "roughness_parameter": (0.0, 5e-5),
            "hardness_parameter": (0.005, 0.03),
        },
    ),
)

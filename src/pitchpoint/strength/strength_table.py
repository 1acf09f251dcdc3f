"""The table [strength] of a case file."""

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, model_validator

from pitchpoint.errors import InputError
from pitchpoint.gears.gears_table import BORE
from pitchpoint.gears.planetary import PLANETS
from pitchpoint.input.kinds import LIFE, LOAD_FACTOR
from pitchpoint.input.quantities import Pair, Quantity, for_both, named
from pitchpoint.input.tables import Table
from pitchpoint.strength.treatments import TREATMENTS

__all__ = ["MESH_LOAD", "UNRATED", "StrengthTable"]


ACCURACY = Quantity("dimensionless", 3, 8, whole=True)
OFFSET = Quantity("length", -100.0, 100.0, "mm")
ENDURED = Quantity("pressure", 1e6, 2.5e9, "MPa")
HARDENING = Quantity("dimensionless", 0.5, 2.0)
REVERSED = Quantity("dimensionless", 0.1, 1.0)
PEAK_TO_VALLEY = Quantity("length", 0.0, 4e-4, "um", open_low=True)
_TREATMENT = named(TREATMENTS.keys, "heat treatment")
_MOST_OFFSET = 0.3  # of the span: ISO 6336-1:2006, arrangements a and b
_SHAFT = ("bearing_span", "pinion_offset", "pinion_shaft_diameter")


def _year(value: Any) -> Any:
    """An edition as text, also of a number."""
    return str(value) if isinstance(value, int) and not isinstance(value, bool) else value


UNRATED = "was given; ISO 6336 rates pairs of cylindrical gears, not these; leave it out"


class StrengthTable(Table):
    """What the strength of a pair of cylindrical gears depends on beside its dimensions and its load.

    Load factors are at least 1: `application_factor` K_A, `mesh_load_factor` K_gamma, `dynamic_factor` K_v,
    `face_load_factor` K_Hbeta, `transverse_load_factor` K_Halpha, and those of the root. Without a K_v it
    follows for gears of `accuracy_class` of ISO 1328-1, by method C or by the `dynamic_method` that is named;
    K_Hbeta follows by method C where `bearing_span`, `pinion_offset` and `pinion_shaft_diameter` are given,
    for a pinion between two bearings without modifications of its helix, with a misalignment of the gears as
    f_ma, without one that of their class. `sigma_hlim` and `sigma_flim` take the place of those of the
    materials, for plastics at the temperature and life of the case; steels then say their `treatment`.
    Without a `life` the teeth are to endure. `mean_stress_factor` is below 1 for teeth that are loaded both
    ways, 0.7 for the same load. Roughness is Rz.
    """

    edition: Annotated[Literal["2006", "2019"], BeforeValidator(_year)] = "2019"
    """Edition of ISO 6336-2 and ISO 6336-3 by which the pair is rated."""
    application_factor: Annotated[float, LOAD_FACTOR] | None = None
    """Application factor K_A; 1 unless given."""
    mesh_load_factor: Annotated[float, LOAD_FACTOR] | None = None
    """Mesh load factor K_γ of planets; by IEC 61400-4 for 3 to 7, else 1, or by their pins, unless given."""
    dynamic_factor: Annotated[float, LOAD_FACTOR] | None = None
    """Dynamic factor K_v; by ISO 6336-1, of plastics 1, unless given."""
    dynamic_method: Literal["B", "C"] = "C"
    """Method of ISO 6336-1 by which K_v follows."""
    face_load_factor: Annotated[float, LOAD_FACTOR] | None = None
    """Face load factor K_Hβ; by method C where the shaft is given, else 1, unless given."""
    bearing_span: Annotated[float, BORE] | None = None
    """Distance l between the bearings of the pinion; unknown unless given."""
    pinion_offset: Annotated[float, OFFSET] | None = None
    """Offset s of the pinion from mid-span, positive towards the torque's end; unknown unless given."""
    pinion_shaft_diameter: Annotated[float, BORE] | None = None
    """Diameter d_sh of the pinion's shaft; unknown unless given."""
    transverse_load_factor: Annotated[float, LOAD_FACTOR] | None = None
    """Transverse load factor K_Hα; 1 unless given."""
    root_face_load_factor: Annotated[float, LOAD_FACTOR] | None = None
    """Face load factor of the root K_Fβ; by K_Hβ unless given."""
    root_transverse_load_factor: Annotated[float, LOAD_FACTOR] | None = None
    """Transverse load factor of the root K_Fα; K_Hα unless given."""
    accuracy_class: Annotated[float, ACCURACY] | None = None
    """Class of ISO 1328-1 for K_v; that of deviations or inspection, without one 7, unless given."""
    profile_correction: Annotated[float, LOAD_FACTOR] | None = None
    """Factor f_ZCa for the profile modification of helical gears; 1.2, none, unless given."""
    life: Annotated[float, LIFE] | None = None
    """Time under load; the teeth are to endure unless given."""
    sigma_hlim: Annotated[tuple[float, float], Pair(ENDURED)] | None = None
    """Allowable stress number for contact σ_Hlim; that of the materials unless given."""
    sigma_flim: Annotated[tuple[float, float], Pair(ENDURED)] | None = None
    """Nominal stress number for bending σ_Flim; that of the materials unless given."""
    treatment: Annotated[tuple[str, str], BeforeValidator(for_both(_TREATMENT))] | None = None
    """Heat treatment, one name or a list of two; that of the materials unless given."""
    work_hardening: Annotated[tuple[float, float], Pair(HARDENING)] | None = None
    """Work hardening factor Z_W; 1 unless given."""
    mean_stress_factor: Annotated[tuple[float, float], Pair(REVERSED)] | None = None
    """Mean stress factor Y_M of teeth loaded both ways; in trains 0.7 with two mates, else 1."""
    engagements: Annotated[tuple[float, float], Pair(PLANETS)] | None = None
    """Engagements of a tooth in a turn of its gear; of sun and ring one a planet, else 1, unless given."""
    flank_roughness: Annotated[tuple[float, float], Pair(PEAK_TO_VALLEY)] | None = None
    """Mean peak-to-valley roughness Rz of the flanks; 6 Ra unless given."""
    root_roughness: Annotated[tuple[float, float], Pair(PEAK_TO_VALLEY)] | None = None
    """Mean peak-to-valley roughness Rz of the roots; 10 um unless given."""

    @property
    def shaft(self) -> tuple[float, float, float] | None:
        """Span, offset and diameter of the pinion's shaft [m]; None where they are not known."""
        span, offset, diameter = self.bearing_span, self.pinion_offset, self.pinion_shaft_diameter
        return (
            None if span is None or offset is None or diameter is None else (span, offset, diameter)
        )

    @model_validator(mode="after")
    def _by_one_way(self) -> "StrengthTable":
        stated = self.model_fields_set
        if self.dynamic_factor is not None and "dynamic_method" in stated:
            raise InputError(
                "was given beside dynamic_factor, which is K_v itself; give one",
                key="dynamic_method",
            )
        if self.engagements is not None and self.life is None:
            raise InputError(
                "was given without life, whose load cycles it counts", key="engagements"
            )
        if self.edition == "2006" and self.profile_correction is not None:
            raise InputError(
                "was given with edition = 2006, which has no f_ZCa; leave it out, or rate by 2019",
                key="profile_correction",
            )
        return self

    @model_validator(mode="after")
    def _whole_shaft(self) -> "StrengthTable":
        stated = [key for key in _SHAFT if getattr(self, key) is not None]
        missing = [key for key in _SHAFT if getattr(self, key) is None]
        if stated and missing:
            raise InputError(
                f"was given without {' and '.join(missing)}; K_Hβ by method C takes all three",
                key=stated[0],
            )
        if stated and self.face_load_factor is not None:
            raise InputError(
                f"was given beside face_load_factor, which is K_Hβ itself; give it or {', '.join(_SHAFT)}",
                key="bearing_span",
            )
        if self.shaft is not None:
            span, offset, _ = self.shaft
            if abs(offset) > _MOST_OFFSET * span:
                raise InputError(
                    f"{OFFSET.show(offset)} is outside {_MOST_OFFSET:g} of the bearing_span, "
                    f"{BORE.show(span)}, up to which K_Hβ by method C is known for a pinion between "
                    f"bearings; allowed is at most {OFFSET.show(_MOST_OFFSET * span)} to either side",
                    key="pinion_offset",
                )
        return self


MESH_LOAD = {3: 1.1, 4: 1.25, 5: 1.35, 6: 1.44, 7: 1.47}
"""Mesh load factor K_gamma by the number of planets, IEC 61400-4:2012."""

"""Friction laws that a case file may name: those of the library, and those of published cases."""

from typing import Annotated, Any, ClassVar, Literal

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, model_validator

from pitchpoint.contact.contact_registry import ELLIPTIC_CONTACT
from pitchpoint.dynamics.dynamics_registry import CONTACT_LAWS
from pitchpoint.efficiency.efficiency_registry import TOOTH_TEMPERATURE
from pitchpoint.errors import InputError, shorten
from pitchpoint.input.kinds import COEFFICIENT
from pitchpoint.input.quantities import Quantity, named, shown
from pitchpoint.input.tables import Table
from pitchpoint.loading.loading_registry import LINE_STIFFNESS, LOAD_SHARING, TOOTH_COMPLIANCE
from pitchpoint.lubrication.lubrication_registry import (
    ASPERITY_LOAD,
    FILM_THICKNESS,
    INLET_HEATING,
    LAWS,
    ROLLING_RESISTANCE,
    FrictionLaw,
)
from pitchpoint.published.publication_registry import LAWS_OF_CASES
from pitchpoint.registry import Registry, letters, nearest

__all__ = ["FRICTION", "Choices", "FrictionChoice"]

SOLVED = {"ehl_line": "pitchpoint.lubrication.ehl.traction:EHL_LINE"}
"""Places of laws that are no formula."""

FRICTION: Registry[FrictionLaw] = Registry(
    "friction law", *LAWS, places={**SOLVED, **LAWS_OF_CASES}
)


SLICES = Quantity("dimensionless", 1, 400, whole=True)


class FrictionChoice(BaseModel):
    """A friction law with values for its own parameters."""

    model_config = ConfigDict(extra="allow", frozen=True, defer_build=True)

    further_keys: ClassVar[Quantity] = COEFFICIENT
    """What parameters of a law are, see `quantity_in`."""
    name: Annotated[str, BeforeValidator(named(FRICTION.keys, "friction law"))]
    """Friction law; parameters of its own may stand beside it."""

    @property
    def parameters(self) -> dict[str, float]:
        """Values of the law's own parameters."""
        return {key: COEFFICIENT.read(value) for key, value in (self.model_extra or {}).items()}

    @model_validator(mode="after")
    def _own(self) -> "FrictionChoice":
        if not self.model_extra:
            return self
        from pitchpoint.lubrication.conditions import law_arguments

        _, constants = law_arguments(FRICTION[self.name].function)
        for key, value in self.model_extra.items():
            if key not in constants:
                has = nearest(key, constants) if constants else "; it has none"
                raise InputError(f"is no parameter of {self.name}{has}", key=shorten(key))
            try:
                COEFFICIENT.read(value)
            except InputError as error:
                raise error.at(key=key) from None
        return self


def _choices(value: Any) -> Any:
    several = value if isinstance(value, list | tuple) else [value]
    if not 1 <= len(several) <= 12:
        raise InputError(f"{len(several)} friction laws were given; allowed are 1 to 12")
    tables = [
        choice if isinstance(choice, dict | FrictionChoice) else {"name": choice}
        for choice in several
    ]
    names = [str(choice.get("name")) for choice in tables if isinstance(choice, dict)]
    plain = [letters(name) for name in names]
    for name in names:
        if plain.count(letters(name)) > 1:
            raise InputError(f"{shown(name)} was given twice; name each friction law once")
    return tables


def _slices(value: float) -> float:
    if value != 1.0 and value % 2.0:
        raise InputError(
            f"{value:.0f} slices were given; allowed is an even number, half of them on each side of the "
            "pitch line, or 1 for the middle of each contact line alone"
        )
    return value


class Choices(Table):
    """Which law stands for which effect; friction and load sharing, where not given, by the gears."""

    friction: Annotated[tuple[FrictionChoice, ...], BeforeValidator(_choices)] = (
        FrictionChoice(name="iso_tr_14179_2"),
    )
    """Friction laws, a name or a list, the first one leading; that usual for the family unless given."""
    load_sharing: Annotated[
        str, BeforeValidator(named(LOAD_SHARING.keys, "load sharing model"))
    ] = "equal"
    """How pairs share the load; from_stiffness where the family or modified flanks ask for it."""
    rolling_resistance: Annotated[
        str, BeforeValidator(named(ROLLING_RESISTANCE.keys, "rolling resistance"))
    ] = "none"
    """Law of the rolling resistance of the contacts."""
    film_thickness: Annotated[
        str, BeforeValidator(named(FILM_THICKNESS.keys, "film thickness law"))
    ] = "dowson_higginson_1959"
    """Law of the film thickness; hamrock_dowson_1977 for contacts that are ellipses."""
    inlet_heating: Annotated[str, BeforeValidator(named(INLET_HEATING.keys, "inlet heating"))] = (
        "none"
    )
    """How the heat of shear in the inlet thins films and lowers rolling resistance."""
    asperity_load: Annotated[
        str, BeforeValidator(named(ASPERITY_LOAD.keys, "asperity load law"))
    ] = "none"
    """Law of the part of the load that asperities carry L_a."""
    elliptic_contact: Annotated[
        str, BeforeValidator(named(ELLIPTIC_CONTACT.keys, "elliptic contact"))
    ] = "hertz_1881"
    """How axes and pressure of an elliptic contact follow from its load."""
    tooth_compliance: Annotated[
        str, BeforeValidator(named(TOOTH_COMPLIANCE.keys, "tooth compliance model"))
    ] = "beam_foundation_weber"
    """Model by which teeth yield under load."""
    line_stiffness: Annotated[
        str, BeforeValidator(named(LINE_STIFFNESS.keys, "stiffness of a contact line"))
    ] = "integrated"
    """Whether teeth yield at each place of an inclined contact line, or all along it as in its middle."""
    tooth_temperature: Annotated[
        str, BeforeValidator(named(TOOTH_TEMPERATURE.keys, "tooth temperature model"))
    ] = "isothermal"
    """Model of the temperature that their own loss gives plastic teeth."""
    tooth_contact: Annotated[
        str, BeforeValidator(named(CONTACT_LAWS.keys, "law of tooth contact"))
    ] = "linear"
    """Whether teeth in a vibration never part, or part and meet their back flanks."""
    slices: Annotated[float, SLICES, AfterValidator(_slices)] = 12.0
    """Slices of each contact line: an even number, or 1 for its middle alone."""
    averaging: Literal["base_pitch", "path"] = "base_pitch"
    """Whether mean loss and efficiency are those of a mesh cycle, or over the path of one pair."""

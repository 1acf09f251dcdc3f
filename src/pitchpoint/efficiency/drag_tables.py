"""A table under [losses] of a case file: a place beside the teeth where power is lost."""

from collections.abc import Collection, Mapping, Sequence
from typing import Annotated

from pydantic import BeforeValidator, Field, model_validator

from pitchpoint.efficiency.efficiency_registry import BEARING_LOSS, BREAKAWAY
from pitchpoint.errors import Complaints, InputError
from pitchpoint.gears.gears_table import BORE
from pitchpoint.gears.planetary import BODIES
from pitchpoint.input.kinds import FORCE, LIFE_EXPONENT, PLACE, SPEED, TORQUE, Flag, Text
from pitchpoint.input.quantities import Quantity, named, shown
from pitchpoint.input.tables import Table, is_stated
from pitchpoint.registry import nearest

__all__ = ["Loss", "bearings_of", "check_losses"]


SPREAD = Quantity("dimensionless", 1.0, 10.0)
BEARING_FACTOR = Quantity("dimensionless", 0.0, 100.0)
RATING = Quantity("force", 0.0, 1e9, "N", open_low=True)
OVER_SQUARE = Quantity("line load", 0.0, 1e6, "N/m")
PRELOAD_RATIO = Quantity("dimensionless", 0.0, 100.0)
EXPONENT = Quantity("dimensionless", 0.0, 3.0, open_low=True)


class Loss(Table):
    """A place beside the teeth where two bodies brake each other, or one of them and the housing.

    Torques are those between the two bodies. A bearing between a body and the housing bears, beside its
    preload, what the teeth put on that body: all of it where it stands for all bearings of the body, its
    part where two are given with their positions along the axis, counted from the middle of the face
    towards the end that a contact line reaches last. The one that is locating takes the axial force. A
    bearing between wave generator and flexspline bears the radial load of the teeth in both zones.
    In a train a place that names the planet is at every planet, and a bearing stands for all of its body:
    of a planet in its carrier, or of a body in the housing; between two others it bears its preload.
    A bearing with its dynamic load rating has a life by ISO 281 at the speed between its bodies, and with a
    static one a static safety; those of planets bear K_γ times an equal share of the teeth, and the
    centrifugal force of the planet.
    A breakaway model and its torque by value hold the bodies at rest, beside the bearing and the seal.
    """

    between: Annotated[tuple[Text, Text], Field(examples=[["gear 1", "housing"]])]
    """The two bodies that brake each other; one of them may be the housing."""
    bearing: Annotated[str, BeforeValidator(named(BEARING_LOSS.keys, "bearing loss model"))] = (
        "none"
    )
    """Model of a rolling bearing between them."""
    mean_diameter: Annotated[float, BORE] | None = None
    """Mean diameter d_m of bearing or seal lip; needed by models of bearing and breakaway."""
    f0: Annotated[float, BEARING_FACTOR] | None = None
    """Factor of the lubricant f0 of the bearing model, as the maker has it."""
    f1: Annotated[float, BEARING_FACTOR] | None = None
    """Factor of the load f1 of the bearing model, as the maker has it."""
    preload: Annotated[float, FORCE] = 0.0
    """Load on the bearing without any on the teeth, which adds to theirs."""
    dynamic_load_rating: Annotated[float, RATING] | None = None
    """Basic dynamic load rating C of the bearing by its maker; gives its life by ISO 281."""
    static_load_rating: Annotated[float, RATING] | None = None
    """Basic static load rating C_0 of the bearing by its maker, which limits the torque by ISO 76."""
    life_exponent: Annotated[float, LIFE_EXPONENT] | None = None
    """Exponent of that life over the load, 3 of balls, 10/3 of rollers and needles; 3 unless given."""
    position: Annotated[float, PLACE] | None = None
    """Place of one of two bearings along the axis, from the middle of the face; of stages, as their place."""
    locating: Flag | None = None
    """Whether this one of two bearings takes the axial force; the first one unless either says."""
    seal_torque: Annotated[float, TORQUE] = 0.0
    """Torque of sliding seals, the same at every speed."""
    churning_torque: Annotated[float, TORQUE] = 0.0
    """Torque of the lubricant that is displaced, at churning_speed."""
    churning_speed: Annotated[float, SPEED] | None = None
    """Relative speed to which churning_torque belongs; needed with it."""
    churning_exponent: Annotated[float, EXPONENT] = 1.0
    """Exponent of the relative speed in the churning torque."""
    breakaway_torque: Annotated[float, TORQUE] = 0.0
    """Torque that holds the bodies at rest, beside bearing and seal; for starting alone."""
    breakaway: Annotated[str, BeforeValidator(named(BREAKAWAY.keys, "breakaway model"))] = "none"
    """Model of a torque that holds the bodies at rest, which adds to breakaway_torque."""
    breakaway_dry: Annotated[float, OVER_SQUARE] | None = None
    """Dry part of that model at a preload of 1, over the square of mean_diameter."""
    breakaway_viscous: Annotated[float, OVER_SQUARE] | None = None
    """Viscous part of that model at 100 mm2/s, over the square of mean_diameter."""
    breakaway_preload: Annotated[float, PRELOAD_RATIO] | None = None
    """Preload over that to which breakaway_dry belongs; 1 unless given."""
    breakaway_spread: Annotated[float, SPREAD] = 1.0
    """Factor by which what holds at rest may be more or less; makes a band of the torques from rest."""

    @property
    def factors(self) -> dict[str, float]:
        """Factors of the bearing model by name."""
        factors = {"f0": self.f0, "f1": self.f1}
        return {name: value for name, value in factors.items() if value is not None}

    @property
    def breakaway_factors(self) -> dict[str, float]:
        """Factors of the breakaway model by name."""
        factors = {"dry": self.breakaway_dry, "viscous": self.breakaway_viscous}
        named = {name: value for name, value in factors.items() if value is not None}
        if self.breakaway == "none" and self.breakaway_preload is None:
            return named
        ratio = 1.0 if self.breakaway_preload is None else self.breakaway_preload
        return {**named, "preload": ratio}

    @model_validator(mode="after")
    def _complete(self) -> "Loss":
        moving = self._asked(self.bearing, BEARING_LOSS[self.bearing].factors, self.factors)
        holding = [f"breakaway_{name}" for name in self.breakaway_factors]
        wanted = [f"breakaway_{name}" for name in BREAKAWAY[self.breakaway].factors]
        held = self._asked(self.breakaway, wanted, holding)
        if not (moving or held) and self.mean_diameter is not None:
            raise InputError(
                "was given, and without a bearing nothing asks for it: a seal takes its torque by value; "
                "leave it out, or name a model in bearing or breakaway",
                key="mean_diameter",
            )
        if self.churning_torque > 0.0 and self.churning_speed is None:
            raise InputError(
                "is missing; churning_torque is that at this speed", key="churning_speed"
            )
        of_bearing = dict.fromkeys(
            ("preload", "dynamic_load_rating", "static_load_rating", "position", "locating"),
            "a bearing",
        )
        alone = of_bearing if self.bearing == "none" else {}
        if not is_stated(self, "dynamic_load_rating"):
            alone |= {"life_exponent": "dynamic_load_rating"}
            alone = {"static_load_rating": "dynamic_load_rating"} | alone
        if not is_stated(self, "churning_torque"):
            alone |= dict.fromkeys(("churning_speed", "churning_exponent"), "churning_torque")
        if not (held or is_stated(self, "breakaway_torque")):
            alone |= {"breakaway_spread": "a breakaway model or breakaway_torque"}
        for name in (key for key in alone if is_stated(self, key)):
            raise InputError(f"was given without {alone[name]}, to which it belongs", key=name)
        beside = (self.seal_torque, self.churning_torque, self.breakaway_torque)
        parts = (self.breakaway_dry, self.breakaway_viscous)
        if not any((*self.factors.values(), *beside, *parts)):
            raise InputError(
                "all torques and factors are zero: nothing is lost; leave the table out, or write "
                '"none" in place of one that a set has'
            )
        return self

    def _asked(self, model: str, wanted: Sequence[str], given: Collection[str]) -> Sequence[str]:
        """What a model asks for; InputError if something of it is missing, or more was given."""
        needed = () if model == "none" else ("mean_diameter", *wanted)
        there = {*given, *(["mean_diameter"] if self.mean_diameter is not None else [])}
        for name in (*needed, *sorted(given)):
            if (name in needed) != (name in there):
                if not needed:
                    kind = name.partition("_")[0] if name.startswith("breakaway") else "bearing"
                    raise InputError(
                        f'was given, and no model asks for it: {kind} is "none"; name one, or leave this out',
                        key=name,
                    )
                complaint = "is missing" if name in needed else "was given"
                raise InputError(f"{complaint}; {model} asks for {', '.join(needed)}", key=name)
        return needed


def bearings_of(losses: Mapping[str, Loss], body: str) -> dict[str, Loss]:
    """Bearings between a body and the housing, by name of their loss."""
    return {
        name: loss
        for name, loss in losses.items()
        if loss.bearing != "none" and {*loss.between} == {body, "housing"}
    }


def check_losses(
    losses: Mapping[str, Loss],
    turning: Sequence[str],
    bodies: Sequence[str],
    sets: Sequence[str] = (),
) -> None:
    """InputError if losses arise between bodies that do not turn, or bearings have no span."""
    wrong = Complaints()
    for name, loss in losses.items():
        wrong.under(f"losses.{name}").tried(_check_bodies, loss, turning, bodies, sets)
    for body in turning:
        wrong.tried(_check_span, body, bearings_of(losses, body))
    wrong.demand_none()


def _check_bodies(
    loss: Loss, turning: Sequence[str], bodies: Sequence[str], sets: Sequence[str]
) -> None:
    """InputError if a loss arises between bodies that the drive does not have, or that travel."""
    allowed = (*turning, "housing")
    inner, outer = loss.between
    strange = next((body for body in loss.between if body not in allowed), None)
    message = (
        f"{shown(strange)} travels, and losses are torques between bodies that turn; name two of "
        f"{', '.join(allowed)}"
        if strange in bodies
        else f"{shown(strange)} is no body of this drive{nearest(strange, allowed)}"
        + _within_set(strange, sets)
        if strange is not None
        else f"{shown(inner)} was given twice; name two bodies of {', '.join(dict.fromkeys(allowed))}"
    )
    if strange is not None or inner == outer:
        raise InputError(message, key="between")


def _within_set(body: str, sets: Sequence[str]) -> str:
    """Where losses at a body of planetary sets stand that are stages of these numbers, as a clause."""
    tables = [f"stages.{number}.losses" for number in sets if body in ("planet", *BODIES)]
    return f"; losses within a set stand in its stage, {' or '.join(tables)}" if tables else ""


def _check_span(body: str, bearings: Mapping[str, Loss]) -> None:
    """InputError if the loads on the bearings of a body do not follow from their places."""
    placed = [name for name, bearing in bearings.items() if bearing.position is not None]
    for name, bearing in bearings.items():
        wrong = _out_of_place(
            body, bearing, [mate for mate in bearings.values() if mate is not bearing]
        )
        if wrong is not None:
            raise InputError(wrong[1], key=f"losses.{name}.{wrong[0]}")
        if placed and bearing.position is None:
            message = (
                f"is missing; {placed[0]} has one, and the load of two bearings on {body} follows"
            )
            raise InputError(f"{message} from the places of both", key=f"losses.{name}.position")


def _out_of_place(body: str, one: Loss, others: Sequence[Loss]) -> tuple[str, str] | None:
    """Key and sentence on a bearing whose load does not follow from its place and those of the others."""
    if len(others) > 1:
        count = f"{len(others) + 1} bearings hold {body}"
        return "between", f"{count}; the loads of more than two do not follow from their places"
    for key in ("position", "locating"):
        if not others and getattr(one, key) is not None:
            message = f"was given for the only bearing of {body}, which takes all load"
            return key, f"{message}; give the second bearing too, or leave it out"
    if others and one.position is None and others[0].position is None:
        return "position", (
            f"is missing; the load of two bearings on {body} follows from the places of both: give "
            "position to each, or one bearing alone that stands for both"
        )
    if others and one.position == others[0].position:
        return "position", (
            f"{PLACE.show(one.position or 0.0)} is where the other bearing of {body} sits too; two "
            "bearings need a span between them"
        )
    if others and one.locating is not None and one.locating == others[0].locating:
        return (
            "locating",
            f"is {str(one.locating).lower()} for both bearings of {body}; one is locating",
        )
    return None

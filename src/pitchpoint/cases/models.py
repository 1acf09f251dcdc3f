"""Laws of a case as they act together, and those that its gears do not take."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING

from pitchpoint._jax import array, jax, jnp
from pitchpoint.cases.laws import FRICTION, Choices
from pitchpoint.cases.schema import CaseFile
from pitchpoint.cases.solids import SolidInUse
from pitchpoint.contact.contact_registry import USUAL_ELLIPSE
from pitchpoint.contact.contacts import TOUCH, Shape
from pitchpoint.efficiency.quasi_static import Models
from pitchpoint.errors import Complaints, InputError
from pitchpoint.gears.contact_lines import pitch_point
from pitchpoint.gears.mesh import Mesh, has
from pitchpoint.gears.nominal_motion import tooth_size
from pitchpoint.gears.pairs import touching
from pitchpoint.input.remembered import remembering
from pitchpoint.loading.loading_registry import LOAD_SHARING
from pitchpoint.loading.sharing import demand_sharing
from pitchpoint.loading.tooth_compliance import terms_of
from pitchpoint.lubrication.applicability import why_inapplicable
from pitchpoint.lubrication.conditions import FILM, Law, demand_shape, law_arguments
from pitchpoint.lubrication.ehl.film_tables import FilmTable
from pitchpoint.lubrication.inlet_heating import Inlet, with_inlet_heating
from pitchpoint.lubrication.lubrication_registry import (
    ASPERITY_LOAD,
    FILM_THICKNESS,
    INLET_HEATING,
    LAWS,
    ROLLING_RESISTANCE,
    ChosenLaws,
    FilmThickness,
    FrictionLaw,
)
from pitchpoint.materials.solids import SolidRecord
from pitchpoint.registry import code_at

if TYPE_CHECKING:
    from pitchpoint.lubrication.ehl.model import FilmModel

__all__ = [
    "FILM_SOLVERS",
    "check_hardness",
    "check_models",
    "check_shapes",
    "inlet_law",
    "model_of_films",
    "models_of",
    "solved_first",
    "under_laws",
]


def model_of_films(
    table: FilmTable, solids: Sequence[SolidRecord], size: float | None
) -> "FilmModel":
    """How films are solved; loaded with what solves them, which few cases ask for."""
    film_model: FilmModel = code_at("pitchpoint.cases.film_choices:film_model")(table, solids, size)
    return film_model


def models_of(
    case: CaseFile, own: ChosenLaws, used: Sequence[SolidInUse], mesh: Mesh
) -> tuple[Models, ...]:
    """Models under each law of the case, or under those among which the user's own are."""
    laws = [
        _beside_film(law, case) if isinstance(law, FrictionLaw) else _law(law, case, used, mesh)
        for law in own or [choice.name for choice in case.models.friction]
    ]
    if any(law.films is not None for law in laws):
        return under_laws(laws, _common(case.models), _given(case.models))
    return _under_formulas(tuple(laws), case.models)


def _beside_film(own: FrictionLaw, case: CaseFile) -> FrictionLaw:
    """A law of the user's own, with the film law of the case where it asks for a film."""
    wanted, _ = law_arguments(own.function)
    if own.film is not None or not {*FILM} & {*wanted}:
        return own
    return _of_film(own, inlet_law(FILM_THICKNESS[case.models.film_thickness], case.models))


@lru_cache(maxsize=64)
def _of_film(own: FrictionLaw, film: FilmThickness) -> FrictionLaw:
    """One record for each pair: another one of the same content would be another program."""
    return replace(own, film=film)


@remembering
def _under_formulas(laws: tuple[FrictionLaw, ...], choices: Choices) -> tuple[Models, ...]:
    return under_laws(laws, _common(choices), _given(choices))


def _given(choices: Choices) -> dict[str, Mapping[str, float]]:
    """Parameters of friction laws that the case gives, by name of the law."""
    return {choice.name: choice.parameters for choice in choices.friction}


def _common(choices: Choices) -> Models:
    """Models without a friction law."""
    return Models(
        friction=(),
        choice=array(0),
        parameters={},
        sharing=LOAD_SHARING[choices.load_sharing],
        rolling=inlet_law(ROLLING_RESISTANCE[choices.rolling_resistance], choices),
        compliance=terms_of(choices.tooth_compliance, choices.line_stiffness),
        film=inlet_law(FILM_THICKNESS[choices.film_thickness], choices),
    )


def inlet_law(law: Inlet, choices: Choices) -> Inlet:
    """A law of film or of rolling resistance with the heat in the inlet that the case asks for."""
    return with_inlet_heating(law, INLET_HEATING[choices.inlet_heating])


def under_laws(
    laws: Sequence[FrictionLaw], models: Models, given: Mapping[str, Mapping[str, float]]
) -> tuple[Models, ...]:
    """Models under each of some laws, with the parameters that are given of them.

    Formulas share programs; a law that solves films is in none.
    """
    formulas = tuple(law for law in laws if law.films is None)
    parameters = {law.name: _parameters(law, given.get(law.name, {})) for law in formulas}
    sharing = iter(replace(models, friction=formulas, parameters=parameters).each)
    alone = replace(models.without_friction, film=models.film)
    return tuple(
        next(sharing) if law.films is None else replace(alone, friction=(law,)) for law in laws
    )


def _law(name: str, case: CaseFile, used: Sequence[SolidInUse], mesh: Mesh) -> FrictionLaw:
    """A friction law; one that solves films does so by the choices of the case."""
    law = FRICTION[name]
    if law.films is None:
        return law
    size = tooth_size(mesh)
    if case.film is not None:
        return replace(law, films=model_of_films(case.film, [solid.record for solid in used], size))
    return law if size is None else replace(law, films=replace(law.films, inlet=size))


def _parameters(law: FrictionLaw, given: Mapping[str, float]) -> dict[str, jax.Array]:
    """Values of a law's own parameters, by default those of its formula."""
    _, defaults = law_arguments(law.function)
    return {key: array(given.get(key, default), jnp.float64) for key, default in defaults.items()}


FILM_SOLVERS: Mapping[Shape, tuple[str, ...]] = {
    "line": ("line", "finite_line"),
    "ellipse": ("elliptic",),
}
"""Solvers of films for contacts of a shape, by their names in `[film]`."""

_WHY_NOT: Mapping[Shape, str] = {
    "line": "lines have no elliptic solver",
    "ellipse": "ellipses have no line solver",
}
"""What contacts of a shape are not solved by."""


def check_shapes(case: CaseFile, mesh: Mesh, own: ChosenLaws, wrong: Complaints) -> None:
    """Complains of a film, a rolling law or a user's own law that hold for contacts of another shape."""
    models = case.models
    chosen: dict[str, Law] = {
        "models.film_thickness": FILM_THICKNESS[models.film_thickness],
        "models.rolling_resistance": ROLLING_RESISTANCE[models.rolling_resistance],
        "models.asperity_load": ASPERITY_LOAD[models.asperity_load],
    }
    for key, law in chosen.items():
        wrong.under(key).tried(demand_shape, law, mesh.shape)
    for friction in own:
        if isinstance(friction, FrictionLaw):
            wrong.tried(demand_shape, friction, mesh.shape)
    if case.film is not None and case.film.solver not in FILM_SOLVERS[mesh.shape]:
        message = (
            f"these gears touch {TOUCH[mesh.shape]}, and {_WHY_NOT[mesh.shape]}; take "
            f"{' or '.join(FILM_SOLVERS[mesh.shape])}, or leave the table out"
        )
        wrong.add(InputError(message, key="film.solver"))
    if mesh.shape == "line" and models.elliptic_contact != USUAL_ELLIPSE:
        message = f"these gears touch along lines; leave it at {USUAL_ELLIPSE}"
        wrong.add(InputError(message, key="models.elliptic_contact"))


def check_hardness(case: CaseFile, used: Sequence[SolidInUse]) -> None:
    """InputError if a law asks for the hardness of a gear whose material has none."""
    law = ASPERITY_LOAD[case.models.asperity_load]
    if "hardness" not in law_arguments(law.function)[0]:
        return
    for gear, solid in enumerate(used, 1):
        if solid.record.hardness is None:
            raise InputError(
                f"'{law.name}' asks for the hardness of both gears, and that of gear {gear} is not known; "
                "give its material by value, with its hardness",
                key=f"materials.gear_{gear}",
            )


def check_models(case: CaseFile, mesh: Mesh, wrong: Complaints) -> None:
    """Complains of models of the case that do not hold for these gears."""
    models = case.models
    for place, choice in enumerate(models.friction):
        if why_not := why_inapplicable(FRICTION[choice.name], mesh):
            others = ", ".join(law.name for law in LAWS if why_inapplicable(law, mesh) is None)
            message = f"{why_not}; choose one of {others}"
            wrong.add(InputError(message, key="models.friction", value=place))
    wrong.under("models.load_sharing").tried(
        demand_sharing, LOAD_SHARING[models.load_sharing], mesh
    )
    wrong.tried(_check_map, case, mesh)
    if models.tooth_temperature != "isothermal":
        wrong.tried(_check_heat, case, mesh)


def _check_map(case: CaseFile, mesh: Mesh) -> None:
    """InputError for a loss map whose friction is that of films between teeth with gaps."""
    solved = [
        choice.name for choice in case.models.friction if FRICTION[choice.name].films is not None
    ]
    if case.loss_map is not None and solved and not touching(mesh):
        raise InputError(
            f"teeth with gaps share each load in another way, and '{solved[0]}' solves the films of every "
            "operating point; leave the table out, or name formulas alone in models.friction",
            key="loss_map",
        )


def _check_heat(case: CaseFile, mesh: Mesh) -> None:
    """InputError for gears that a model of the tooth temperature is not for."""
    missing = (
        "a pitch point, which these gears do not have"
        if not has(mesh, pitch_point)
        else "two gears that turn, each with its number of teeth"
    )
    if not has(mesh, pitch_point) or not case.gears.tooth_numbers:
        raise InputError(
            f"'{case.models.tooth_temperature}' asks for {missing}; use isothermal",
            key="models.tooth_temperature",
        )
    if reason := solved_first(case):
        raise InputError(f"the heat of the teeth {reason}", key="models.friction")


def solved_first(case: CaseFile) -> str | None:
    """What is wrong with a first friction law that solves films, where a formula is asked for."""
    formula = FRICTION[case.models.friction[0].name]
    if formula.films is None:
        return None
    return (
        f"follows from the first friction law of a case, and '{formula.name}' is no formula; name a formula "
        "before it"
    )

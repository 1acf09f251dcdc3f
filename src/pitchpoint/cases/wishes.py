"""Quantities that a case file says by other keys: what to write in their place, with its number.

A name that is spelled like a key may mean something else: "input_torque" is no misspelt "torque". What is
asked for often stands here, and is answered before any neighbour is offered.
"""

import re
import tomllib
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from math import atan, cos, inf, pi, tan
from typing import Any

from pydantic import TypeAdapter

from pitchpoint import units
from pitchpoint.cases.document import STAGES
from pitchpoint.cases.drive_schema import check_stage, form_of
from pitchpoint.errors import InputError
from pitchpoint.gears.cylindrical.drawing_dimensions import Toothing
from pitchpoint.gears.cylindrical.table import TIP, CylindricalGears
from pitchpoint.gears.families import Gears
from pitchpoint.gears.gears_table import (
    ANGLE,
    DEVIATION,
    DISTANCE,
    FILLET,
    HELIX,
    MODULE,
    RACK,
    SHIFT,
    GearsTable,
)
from pitchpoint.gears.planetary import PLANETARY, PlanetaryGears
from pitchpoint.input.quantities import Pair, Quantity
from pitchpoint.input.tables import quantity_in
from pitchpoint.materials.data import oil_names
from pitchpoint.registry import letters, listed, nearest

__all__ = ["WISHES", "Wish", "keys_for_wish", "other_table_hint", "value_advice", "wish_answer"]

Tree = Mapping[str, Any]
Write = Callable[[Any, Tree, Tree], str]
"""What to write for a value, by the table in which it stands and the whole case."""

_LENGTH, _RATIO = Quantity("length", 0.0, inf, "mm"), Quantity("dimensionless", -inf, inf)
_TORQUE = Quantity("torque", 0.0, 1e8, "N m")
_FORCE = Quantity("force", 0.0, 1e7, "N")
_SPEED = Quantity("rotational speed", 0.0, 1e5, "rpm", open_low=True)
_ROUGHNESS = Quantity("length", 0.0, 1e-4, "um")

_TEETH = Pair(Quantity("dimensionless", -10_000, 10_000, whole=True))
_OF_PAIR: Mapping[str, Quantity | Pair] = {
    "teeth": _TEETH,
    "module": MODULE,
    "helix_angle": HELIX,
    "pressure_angle": ANGLE,
    "profile_shift": Pair(SHIFT),
    "addendum": Pair(RACK),
}


@dataclass(frozen=True)
class Wish:
    """A quantity under names that are no keys.

    Attributes:
        names: under which it is asked for, in whatever case and with whatever signs between the words.
        keys: of the same table that say it; empty where nothing in the table does.
        why: what is to be known, a clause.
        write: the line to write in its place; an error where no number follows.
    """

    names: tuple[str, ...]
    keys: tuple[str, ...]
    why: str
    write: Write | None = None


def wish_answer(
    place: Sequence[str], value: Any, tree: Tree, fields: Collection[str]
) -> str | None:
    """What is told of a key that is a wish, after "is not a known key"; None where it is none.

    Args:
        place: tables and key.
        value: that stands there.
        tree: plain values of the case.
        fields: keys of the table in which it stands.
    """
    wish = _wish(place, tree, fields)
    if wish is None:
        return None
    if wish.keys and not any(key in fields for key in wish.keys):
        return f"; known are {listed(fields)}"  # a neighbour in spelling would mean something else
    line = _line(wish, place, value, tree)
    if line or not wish.keys or wish in WISHES[""]:
        return f": {wish.why}{f'; write {line}' if line else ''}"
    return f": {wish.why}; the key is {wish.keys[0]}"


def value_advice(key: str, value: Any) -> str:
    """What is to be known of a value that its key does not take but others use, as a clause; else empty.

    Args:
        key: dotted, of the case or of one of its stages.
        value: that stands there.
    """
    key = re.sub(r"^stages\.\d+\.", "", key)
    words = value.strip().casefold() if isinstance(value, str) else ""
    several = isinstance(value, list | tuple) and key.split(".")[-1] != "teeth"
    if several and (len(value) > 2 or key.startswith("operation.")):
        return f"several values are swept: --sweep {key}=FIRST:LAST:COUNT, or a study in Python"
    if key == "lubricant.name":
        return "any other oil is given by base, viscosity_40 and viscosity_100 in place of its name"
    if key == "roughness.ra" and (grade := re.fullmatch(r"n\s?(1[0-2]|[1-9])", words)):
        return f"grade N{grade[1]} is Ra {_RA_OF_GRADES[int(grade[1]) - 1]} um: write that length"
    if key == "roughness.ra" and words.startswith("rz"):
        return "Rz has a key of its own in [strength], and Ra is about Rz/6 as in ISO 6336-2"
    if key == "strength.life" and words.startswith(("inf", "endless", "permanent", "unlimited")):
        return "leave life out for teeth that are to endure"
    if key in ("operation.torque", "operation.force", "operation.speed") and words.startswith("-"):
        return "it has no sign: which member drives says driver in [operation]"
    return ""


_RA_OF_GRADES = (0.025, 0.05, 0.1, 0.2, 0.4, 0.8, 1.6, 3.2, 6.3, 12.5, 25, 50)
"""Ra of the roughness grades N1 to N12 [um], ISO 1302."""


def no_family(name: str, known: Collection[str]) -> str:
    """End of a sentence on a family of gears that is not there: the one that is meant, or where to read."""
    if letters(name).startswith("epicyclic"):
        return nearest(PLANETARY, known)
    if letters(name).removesuffix("set") in ("3k", "threek", "wolfrom"):
        if "3K" in known:
            return "; did you mean 3K?"
        return (
            ": it is planetary with second gears, second = { teeth = [planet, ring], face_width = ... } "
            "under [gears]; pitchpoint new 3K --ratio 100 writes one for a ratio"
        )
    if letters(name).removesuffix("set").removesuffix("planetary") in ("compound", "stepped"):
        return (
            ": it is planetary with second gears, second = { teeth = [planet, ring], face_width = ... } "
            "under [gears]; pitchpoint new planetary --ratio 20 writes one for a ratio"
        )
    plain = letters(name).removesuffix("s").removesuffix("gear").removesuffix("drive")
    if {plain, letters(name)} & _NO_FAMILIES:
        return " of Pitchpoint; pitchpoint docs not_included says what to use instead"
    return nearest(name, known)


_NO_FAMILIES = {
    *(
        "bevel",
        "hypoid",
        "worm",
        "crossedhelical",
        "cycloidal",
        "cycloid",
        "rv",
    ),
    *("face", "chain", "belt"),
}


def keys_for_wish(place: Sequence[str], tree: Tree) -> tuple[str, ...]:
    """Keys that say what stands at a place under a name of its own; none where it is no wish.

    Args:
        place: tables and key.
        tree: plain values of the case.
    """
    wish = _wish(place, tree)
    return () if wish is None else wish.keys


def other_table_hint(name: str) -> str:
    """End of a sentence on a wish that one other table answers; empty where none does, or several do.

    A name of one letter is none: it means too much.
    """
    plain = letters(name)
    tables = [table for table, table_name in _BY_NAME if table_name == plain and table in _OF_CASE]
    if len(plain) < 2 or len(tables) != 1:
        return ""
    wish = _BY_NAME[tables[0], plain]
    return f"; {wish.why}{f': {wish.keys[0]} in [{tables[0]}]' if wish.keys else ''}"


def _wish(place: Sequence[str], tree: Tree, fields: Collection[str] = ()) -> Wish | None:
    """The wish of a name in its table: that of a stage as of a case alone, of a set before that of a pair.

    The table of a set is read by itself, before its meshes are.
    """
    tables = [part for part in place[:-1] if not part.isdecimal()]
    tables = tables[1:] if tables[:1] == ["stages"] else tables
    if tables[:1] == ["losses"] and len(tables) == 2:
        tables[1] = "NAME"
    table, name = ".".join(tables), letters(place[-1])
    if tree.get("family") == PLANETARY or (table == "gears" and "planets" in fields):
        return _BY_NAME.get((_SET, name)) or _BY_NAME.get(("gears", name))
    return _BY_NAME.get((table, name))


def _line(wish: Wish, place: Sequence[str], value: Any, tree: Tree) -> str:
    """The line to write; empty where no number follows from what the case says."""
    table: Any = tree
    try:
        for part in place[:-1]:
            table = table[part]
        line = "" if wish.write is None else wish.write(value, table, tree)
    except (ArithmeticError, LookupError, TypeError, ValueError):
        return ""
    return line if _taken(place[:-1], line, tree) else ""


def _taken(table: Sequence[str], line: str, tree: Tree) -> bool:
    """False for a line whose value its key would refuse, such as a number without its unit."""
    try:
        ((key, value),) = tomllib.loads(line).items()
        dotted = ".".join((*table, key))
        check_stage(dotted, tree.get(STAGES))
        quantity = quantity_in(dotted, tree, [form_of(tree)])
    except (
        InputError,
        ValueError,
    ):  # a remark stands behind the line, or its key takes no quantity
        return True
    try:
        for entry in value if isinstance(value, list) else [value]:
            if quantity is not None:
                quantity.read(entry)
    except InputError:
        return False
    return True


def _said(key: str, quantity: Quantity, *values: float) -> str:
    """A line of a case file with one value, or a list; InputError for one that the key does not take."""
    shown = [
        quantity.show(quantity.read(f"{value!r} {units.si_unit(quantity.kind)}"))
        for value in values
    ]
    written = [number if quantity.unit == "1" else f'"{number}"' for number in shown]
    several = ", ".join(written)
    return f"{key} = {several if len(written) == 1 else f'[{several}]'}"


def _renamed(key: str) -> Write:
    """The same value under its key."""
    return lambda value, table, tree: f"{key} = {_each(value)}"


def _plain(value: Any) -> str:
    if isinstance(value, str) and value.isprintable() and '"' not in value and len(value) < 40:
        return f'"{value}"'
    if isinstance(value, int | float) and not isinstance(value, bool):
        return f"{value:.6g}"
    raise TypeError


def _of_pair(table: Tree, key: str) -> Any:
    """SI value at a key of a cylindrical pair, the usual one where it is left out."""
    if table.get("family", "cylindrical") != "cylindrical":
        raise LookupError
    info = CylindricalGears.model_fields[key]
    if key not in table and not info.is_required():
        return info.default
    return _OF_PAIR[key].read(table[key])


def _both(value: Any, quantity: Quantity) -> tuple[float, float]:
    return Pair(quantity).read(value)


def _sides(value: Any, table: Tree) -> list[tuple[float, float, float]]:
    """Of each gear how far a diameter lies beyond the reference circle, in modules; x; addendum."""
    module, teeth = _of_pair(table, "module"), _of_pair(table, "teeth")
    shift, addendum = _of_pair(table, "profile_shift"), _of_pair(table, "addendum")
    cosine = cos(_of_pair(table, "helix_angle"))
    beyond = [
        (diameter / module * (1.0 if z > 0 else -1.0) - z / cosine) / 2.0
        for diameter, z in zip(_both(value, _LENGTH), teeth, strict=True)
    ]
    return list(zip(beyond, shift, addendum, strict=True))


def _by_tips(value: Any, table: Tree, tree: Tree) -> str:
    return _said("tip_alteration", TIP, *(far - x - h for far, x, h in _sides(value, table)))


def _by_roots(value: Any, table: Tree, tree: Tree) -> str:
    return _said("dedendum", RACK, *(x - far for far, x, _ in _sides(value, table)))


def _by_reference(value: Any, table: Tree, tree: Tree) -> str:
    cosine, teeth = cos(_of_pair(table, "helix_angle")), _of_pair(table, "teeth")
    modules = [d * cosine / abs(z) for d, z in zip(_both(value, _LENGTH), teeth, strict=True)]
    if abs(modules[0] / modules[1] - 1.0) > 1e-3:
        raise ValueError  # of one gear only, or of no pair
    return _said("module", MODULE, modules[0])


def _by_transverse_module(value: Any, table: Tree, tree: Tree) -> str:
    return _said("module", MODULE, MODULE.read(value) * cos(_of_pair(table, "helix_angle")))


def _by_circular_pitch(value: Any, table: Tree, tree: Tree) -> str:
    return _said("module", MODULE, _LENGTH.read(value) / pi * cos(_of_pair(table, "helix_angle")))


def _by_diametral_pitch(value: Any, table: Tree, tree: Tree) -> str:
    pitch, helix = _RATIO.read(value), _of_pair(table, "helix_angle")
    normal = f'module = "{pitch:.6g} DP"'
    MODULE.read(f"{pitch:.6g} DP")
    if not helix:
        return normal
    transverse = _said("module", MODULE, 0.0254 / pitch * cos(helix))
    return f"{normal} if it is that of the normal section, {transverse} if of the transverse one"


def _by_transverse_angle(value: Any, table: Tree, tree: Tree) -> str:
    normal = atan(tan(ANGLE.read(value)) * cos(_of_pair(table, "helix_angle")))
    return _said("pressure_angle", ANGLE, normal)


def _by_lead_angle(value: Any, table: Tree, tree: Tree) -> str:
    return _said("helix_angle", HELIX, pi / 2.0 - units.parse(value, "angle"))


def _base_radii(table: Tree) -> float:
    """Sum of the base radii, of a ring their difference [m]."""
    module, pressure, helix = (
        _of_pair(table, key) for key in ("module", "pressure_angle", "helix_angle")
    )
    every = (Toothing(z, module, pressure, helix, 0.0) for z in _of_pair(table, "teeth"))
    return abs(sum(gear.base_radius for gear in every))


def _by_working_angle(value: Any, table: Tree, tree: Tree) -> str:
    distance = _base_radii(table) / cos(units.parse(value, "angle"))
    return _said("centre_distance", DISTANCE, distance)


def _by_normal_backlash(value: Any, table: Tree, tree: Tree) -> str:
    """The backlash on the pitch circles of one along the normal; an error where the gears cannot have it."""
    stated = {key: table[key] for key in table if key in CylindricalGears.model_fields}
    gears = CylindricalGears.model_validate(stated)
    slope = _base_radii(table) / gears.operating_distance
    if not slope < 1.0:
        raise ValueError("the base circles reach beyond the centre distance")
    on_circles = DEVIATION.read(value) / (slope * cos(gears.toothings[0].base_helix_angle))
    CylindricalGears.model_validate(stated | {"backlash": DEVIATION.show(on_circles)})
    return _said("backlash", DEVIATION, on_circles)


def _in_modules(key: str, quantity: Quantity) -> Write:
    """A dimension of the basic rack under its key, in modules."""

    def write(value: Any, table: Tree, tree: Tree) -> str:
        lengths = value if isinstance(value, list) else [value]
        module = _of_pair(table, "module")
        return _said(
            key,
            quantity,
            *(_LENGTH.read(v) / module if isinstance(v, str) else _RATIO.read(v) for v in lengths),
        )

    return write


def _share_of_planets(value: Any, table: Tree, tree: Tree) -> str:
    torque = _TORQUE.read(tree["operation"]["torque"]) / _RATIO.read(value)
    return f"{_said('torque', _TORQUE, torque)} in [operation] for one of {value} planets"


def _chain(tree: Tree) -> list[tuple[GearsTable, str]]:
    """Gears from the input to the output, each with the member that drives."""
    point: Any = tree.get("operation", {})
    tables = [*tree["stages"].values()] if "stages" in tree else [{**point, "gears": tree["gears"]}]
    every = [
        (TypeAdapter(Gears).validate_python(stage["gears"]), stage.get("driver"))
        for stage in tables
    ]
    return [(gears, driver or gears.drivers[0]) for gears, driver in every]


def _at_output(tree: Tree) -> tuple[float, bool]:
    """Load of the output for a unit torque of the input without losses [N m or N], and True for a force."""
    ratio, force = 1.0, False
    if "train" in tree and "gears" not in tree:
        raise LookupError  # by what turns and is held, not by a chain of stages
    if "train" in tree:
        planetary = PlanetaryGears.model_validate(tree["gears"])
        second = planetary.second
        if second is not None and not planetary.stepped:
            raise LookupError  # by both rings
        train, (sun, planet, *ring) = tree["train"], planetary.teeth
        of_ring = planet * second.teeth[1] / second.teeth[0] if second is not None else ring[0]
        loads = {"sun": sun, "ring": of_ring, "carrier": sun + of_ring}
        return loads[train["output"]] / loads[train["input"]], False
    for gears, driver in _chain(tree):
        torques = gears.relative_torques
        ratio *= torques[gears.loaded_member(driver) or ""] / torques[driver]
        force = gears.load == "force"
    return ratio, force


def _load(torque: float, tree: Tree) -> str:
    """The load of the output for a torque of the input without losses."""
    ratio, force = _at_output(tree)
    line = (
        _said("force", _FORCE, torque * ratio)
        if force
        else _said("torque", _TORQUE, torque * ratio)
    )
    return f"{line}, what arrives there without losses"


def _by_input_torque(value: Any, table: Tree, tree: Tree) -> str:
    return _load(_TORQUE.read(value), tree)


def _by_power(value: Any, table: Tree, tree: Tree) -> str:
    return _load(units.parse(value, "power") / _SPEED.read(table["speed"]), tree)


def _by_output_speed(value: Any, table: Tree, tree: Tree) -> str:
    ratio, force = _at_output(tree)
    speed = units.parse(value, "velocity") if force else _SPEED.read(value)
    return _said("speed", _SPEED, speed * ratio)


def _by_rz(value: Any, table: Tree, tree: Tree) -> str:
    depths = value if isinstance(value, list) else [value]
    return f"{_said('ra', _ROUGHNESS, *(_ROUGHNESS.read(rz) / 6.0 for rz in depths))}, Rz/6 as ISO 6336-2"


def _iso_class(value: Any, table: Tree, tree: Tree) -> str:
    return f"iso_class = {_RATIO.read(value):.0f}"


def _by_class(value: Any, table: Tree, tree: Tree) -> str:
    return f"inspection = {{ {_iso_class(value, table, tree)} }}"


def _in_rpm(value: Any, table: Tree, tree: Tree) -> str:
    number = isinstance(value, int | float) and not isinstance(value, bool)
    return _said("speed", _SPEED, _SPEED.read(f"{value:g} rpm" if number else value))


def _floating(body: str) -> Write:
    """The body that floats where a key named after it is true."""
    return lambda value, table, tree: f'floating = "{body}"' if value is True else ""


def _of_members(*names: str) -> Write:
    """Numbers of teeth of sun, planet and ring, each of which stands under a name of its own."""

    def write(value: Any, table: Tree, tree: Tree) -> str:
        by_letters = {letters(name): number for name, number in table.items()}
        teeth = [abs(_TEETH.each.read(by_letters[letters(name)])) for name in names]
        return f"teeth = [{', '.join(f'{number:g}' for number in teeth)}]"

    return write


def _by_grade(value: Any, table: Tree, tree: Tree) -> str:
    names = [oil for oil in oil_names() if oil.endswith(f"-vg-{value}")]
    return f'name = "{names[0]}", say' if names else ""


def _of_both(key: str, *names: str) -> Write:
    """A list under one key of what stands for each gear under a name of its own."""

    def write(value: Any, table: Tree, tree: Tree) -> str:
        by_letters = {letters(name): number for name, number in table.items()}
        plain_names = [_plain(by_letters[letters(name)]) for name in names]
        return f"{key} = [{', '.join(plain_names)}]"

    return write


def _each(value: Any) -> str:
    return f"[{', '.join(map(_plain, value))}]" if isinstance(value, list) else _plain(value)


_IN_ONE_LIST = {
    ("teeth", "numbers of teeth"): (("z1", "z2"), ("teeth_1", "teeth_2")),
    ("profile_shift", "profile shifts"): (("x1", "x2"), ("profile_shift_1", "profile_shift_2")),
    ("face_width", "face widths"): (("b1", "b2"), ("face_width_1", "face_width_2")),
}
"""Keys with a list of both gears' values, and names under which other programs have each."""

_RACK = "the teeth are those of a basic rack"

_SET = "gears of a set"
"""Place of the wishes for the table [gears] of a planetary set."""

_BODIES = ("sun", "carrier", "ring")
_TEETH_OF_SET = (
    ("sun_teeth", "planet_teeth", "ring_teeth"),
    ("teeth_sun", "teeth_planet", "teeth_ring"),
    ("z_sun", "z_planet", "z_ring"),
    ("z_s", "z_p", "z_r"),
    ("z_1", "z_2", "z_3"),
    ("sun", "planet", "annulus"),
)
_AS_STAGES = (
    "write its meshes as [[stages]] with a [train] (pitchpoint docs stages), where the gears of each mesh "
    "have"
)

WISHES: Mapping[str, tuple[Wish, ...]] = {
    "": (
        Wish(
            ("oil", "lubrication", "grease"),
            ("lubricant",),
            "the oil has a table [lubricant]",
        ),
        Wish(
            ("load", "loads", "operating_point"),
            ("operation",),
            "load, speed and temperature have a table [operation]",
        ),
        Wish(
            ("gear", "pair", "geometry", "gear_1", "gear_2", "pinion", "wheel"),
            ("gears",),
            "both gears have one table [gears]",
        ),
        Wish(
            ("material",),
            ("materials",),
            "materials have a table [materials] with gear_1 and gear_2",
        ),
        Wish(
            ("variant", "configurations", "load_cases", "loadcase"),
            (),
            "several forms of a case are tables [variants.NAME], each with what differs",
        ),
        Wish(
            ("size", "sizing", "task"),
            (),
            "it belongs to a file of its own, for which pitchpoint size FILE looks for drives",
        ),
        Wish(
            ("version", "author", "date", "project", "name", "description", "comment", "customer"),
            (),
            "it decides nothing; write it into title or summary, or behind a #",
        ),
    ),
    _SET: (
        Wish(
            (
                *("n_planets", "number_of_planets", "planet_count", "planets_count", "num_planets"),
                *("planet_number", "n_p"),
            ),
            ("planets",),
            "planets says how many there are",
            _renamed("planets"),
        ),
        *(
            Wish(
                names,
                ("teeth",),
                "numbers of teeth stand in one list, of sun, planet and ring, all positive"
                + "; planets says how many planets there are" * ("planet" in names),
                _of_members(*names),
            )
            for names in _TEETH_OF_SET
        ),
        Wish(
            ("z", "number_of_teeth", "numbers_of_teeth", "tooth_number", "tooth_count", "n_teeth"),
            ("teeth",),
            "numbers of teeth stand in one list, of sun, planet and ring, all positive",
            _renamed("teeth"),
        ),
        Wish(
            ("x_1", "x_2", "x_3", "x_sun", "x_planet", "x_ring", "profile_shift_sun"),
            ("profile_shift",),
            "profile shifts stand in one list, of sun, planet and ring",
        ),
        Wish(
            ("b_1", "b_2", "b_3", "b_sun", "b_planet", "b_ring"),
            ("face_width",),
            "face widths stand in one list, of sun, planet and ring",
        ),
        Wish(
            ("planet_angle", "planet_positions", "planet_position", "angles", "spacing"),
            ("planet_angles",),
            "planet_angles is a list with the angle of each planet on the carrier",
        ),
        Wish(
            ("pin_error", "pin_position_error", "pin_position_errors", "planet_position_error"),
            ("pin_errors",),
            "pin_errors is a list with one for each planet, and pin_tolerance the circle in which each lies",
            lambda value, table, tree: (
                f"pin_errors = {_each([*value])}" * (not isinstance(value, str))
            ),
        ),
        *(
            Wish(
                (f"floating_{body}", f"{body}_floating", f"{body}_floats", f"free_{body}"),
                ("floating",),
                "floating names the body that is free to move sideways, where pins are out of place",
                _floating(body),
            )
            for body in _BODIES
        ),
        Wish(
            (
                *("fixed", "fixed_member", "fixed_body", "stationary", "grounded", "ground"),
                "held_body",
            ),
            ("held",),
            "held names the body that stands still",
            _renamed("held"),
        ),
        Wish(
            ("driver", "driving", "input_body", "driving_member"),
            ("input",),
            "input names the body that drives",
            _renamed("input"),
        ),
        Wish(
            ("driven", "output_body", "load_body", "driven_member"),
            ("output",),
            "output names the body that takes the load",
            _renamed("output"),
        ),
        Wish(
            ("ratio", "gear_ratio", "transmission_ratio", "reduction"),
            ("teeth",),
            "the ratio follows from the numbers of teeth, and from which body is input, output and held",
        ),
        Wish(
            (
                *("backlash", "circumferential_backlash", "nominal_backlash", "j_wt", "j_t"),
                *("normal_backlash", "j_bn", "j_n"),
            ),
            (),
            "a set has no backlash by value; thickness allowances in [gears.inspection] are those of its "
            f"gears, or {_AS_STAGES} the same backlash",
        ),
        Wish(
            (
                *("quality", "accuracy", "accuracy_grade"),
                *("iso_quality", "din_quality", "agma_quality", "iso_class"),
            ),
            ("inspection",),
            "the class of ISO 1328-1 is a key of its table [gears.inspection]",
            _by_class,
        ),
        Wish(
            ("deviations", "modifications"),
            (),
            f"a set has no deviations or modified flanks; {_AS_STAGES} tables deviations or modifications",
        ),
    ),
    "gears.inspection": (
        Wish(
            ("quality", "accuracy", "accuracy_grade", "iso_quality", "din_quality", "class"),
            ("iso_class",),
            "the class is that of ISO 1328-1",
            _iso_class,
        ),
        Wish(
            ("backlash", "nominal_backlash", "normal_backlash", "j_bn", "j_wt"),
            (),
            "the backlash of toleranced teeth is a result of their thickness allowances; one by value is "
            "backlash in [gears]",
        ),
        Wish(
            ("span", "k", "teeth_spanned", "number_of_teeth_spanned"),
            ("span_teeth",),
            "the number of teeth over which a span is measured",
            _renamed("span_teeth"),
        ),
        Wish(
            ("ball", "pin_diameter", "measuring_ball", "d_m", "roller_diameter"),
            ("ball_diameter",),
            "tooth thickness is measured over balls",
            _renamed("ball_diameter"),
        ),
    ),
    "losses.NAME": (
        Wish(
            ("torque", "drag_torque", "friction_torque", "drag", "seal", "loss"),
            ("seal_torque",),
            "a torque that is the same at every speed is that of a sliding seal",
            _renamed("seal_torque"),
        ),
        Wish(
            ("diameter", "d_m", "pitch_diameter", "shaft_diameter", "bore"),
            ("mean_diameter",),
            "bearing and seal count by their mean diameter",
            _renamed("mean_diameter"),
        ),
        Wish(
            ("bodies", "location", "where", "shaft", "body", "gear"),
            ("between",),
            'between names the two bodies that brake each other, such as ["gear 1", "housing"]',
        ),
        Wish(
            ("friction", "mu", "coefficient", "friction_coefficient", "model", "type"),
            ("bearing",),
            "the friction of a rolling bearing has a model, bearing, with mean_diameter, f0 and f1",
        ),
        Wish(
            ("starting_torque", "static_torque", "stiction", "static_friction", "holding_torque"),
            ("breakaway_torque",),
            "what holds at rest is the breakaway torque",
            _renamed("breakaway_torque"),
        ),
        Wish(
            ("churning", "oil_churning", "splash_torque"),
            ("churning_torque",),
            "churning is a torque at a speed, churning_torque with churning_speed",
            _renamed("churning_torque"),
        ),
    ),
    "materials": (
        Wish(
            ("pinion", "wheel", "driver", "driven"),
            ("gear_1", "gear_2"),
            "gear_1 and gear_2 are the gears in the order of their numbers of teeth in [gears]",
        ),
        Wish(
            ("planets", "planet_gears"),
            ("planet",),
            "materials of a planetary set are those of its sun, planet and ring",
            _renamed("planet"),
        ),
        Wish(
            ("material", "steel", "name", "both"),
            ("gear_1", "gear_2"),
            "each gear has its own, gear_1 and gear_2",
        ),
    ),
    "gears": (
        Wish(
            ("z", "number_of_teeth", "numbers_of_teeth", "tooth_number", "tooth_count", "n_teeth"),
            ("teeth",),
            "numbers of teeth of both gears stand in one list",
            _renamed("teeth"),
        ),
        *(
            Wish(
                both,
                (key,),
                f"{what} of both gears stand in one list",
                _of_both(key, *both),
            )
            for (key, what), pairs in _IN_ONE_LIST.items()
            for both in pairs
        ),
        Wish(
            ("m", "m_n", "normal_module"),
            ("module",),
            "the module is that of the normal section",
            _renamed("module"),
        ),
        Wish(
            ("alpha", "alpha_n", "normal_pressure_angle", "phi"),
            ("pressure_angle",),
            "the pressure angle is that of the normal section",
            _renamed("pressure_angle"),
        ),
        Wish(
            ("beta", "helix", "spiral_angle"),
            ("helix_angle",),
            "the helix angle is that of the reference cylinders",
            _renamed("helix_angle"),
        ),
        Wish(
            ("b", "width", "tooth_width"),
            ("face_width",),
            "the width of the teeth is the face width",
            _renamed("face_width"),
        ),
        Wish(
            ("a", "a_w", "axis_distance", "shaft_distance", "centre_to_centre"),
            ("centre_distance",),
            "the distance of the axes is the centre distance",
            _renamed("centre_distance"),
        ),
        Wish(
            ("x", "shift", "addendum_modification", "profile_shift_coefficient", "x_coefficient"),
            ("profile_shift",),
            "profile shifts are counted in modules",
            _renamed("profile_shift"),
        ),
        Wish(
            ("transverse_module", "module_transverse", "m_t"),
            ("module",),
            "the module is that of the normal section",
            _by_transverse_module,
        ),
        Wish(
            ("diametral_pitch", "normal_diametral_pitch", "dp", "p_d", "p_nd", "pitch_diametral"),
            ("module",),
            "the module says the size of the teeth, also by a diametral pitch",
            _by_diametral_pitch,
        ),
        Wish(
            ("circular_pitch", "transverse_pitch"),
            ("module",),
            "the module says the size of the teeth",
            _by_circular_pitch,
        ),
        Wish(
            ("pitch_diameter", "reference_diameter", "pitch_diameters", "reference_diameters"),
            ("module",),
            "the reference diameter follows from module and teeth",
            _by_reference,
        ),
        Wish(
            (
                *("tip_diameter", "tip_diameters", "outside_diameter", "outside_diameters"),
                *("outer_diameter", "addendum_diameter", "d_a", "head_diameter"),
            ),
            ("tip_alteration", "addendum"),
            "the tip diameter follows from addendum, profile shift and tip alteration",
            _by_tips,
        ),
        Wish(
            ("root_diameter", "root_diameters", "d_f", "dedendum_diameter"),
            ("dedendum",),
            "the root diameter follows from dedendum and profile shift",
            _by_roots,
        ),
        Wish(
            ("form_diameter", "form_diameters", "d_ff", "sap_diameter", "tif_diameter"),
            ("fillet_radius", "dedendum"),
            "the form diameter follows from the rack and its fillet",
        ),
        Wish(
            ("internal", "internal_gear", "is_internal"),
            ("teeth",),
            "a ring is gear 2 with a negative number of teeth",
        ),
        Wish(
            ("base_pitch", "p_b", "p_bt", "base_diameter", "base_diameters", "d_b"),
            ("module", "pressure_angle"),
            "base circles and pitch follow from module and pressure angle",
        ),
        Wish(("backlash",), ("centre_distance",), "the backlash follows from the centre distance"),
        Wish(
            ("circumferential_backlash", "nominal_backlash", "j_wt", "j_t"),
            ("backlash",),
            "the backlash counts on the pitch circles",
            _renamed("backlash"),
        ),
        Wish(
            ("normal_backlash", "j_bn", "j_n"),
            ("backlash",),
            "the backlash counts on the pitch circles, not along the normal",
            _by_normal_backlash,
        ),
        Wish(
            ("working_pressure_angle", "operating_pressure_angle", "alpha_wt"),
            ("centre_distance",),
            "the working pressure angle follows from the centre distance",
            _by_working_angle,
        ),
        Wish(
            ("transverse_pressure_angle", "alpha_t"),
            ("pressure_angle",),
            "the pressure angle is that of the normal section",
            _by_transverse_angle,
        ),
        Wish(
            ("lead_angle",),
            ("helix_angle",),
            "the lead is given by the helix angle",
            _by_lead_angle,
        ),
        Wish(
            ("planets", "number_of_planets", "planet_count", "n_planets"),
            (),
            'planets are those of gears with family = "planetary", teeth of sun, planet and ring; a pair of '
            "them alone is at its share of the torque",
            _share_of_planets,
        ),
        Wish(
            ("sun", "ring", "planet", "carrier", "sun_teeth", "planet_teeth", "ring_teeth"),
            (),
            'a planetary set is family = "planetary", with teeth = [sun, planet, ring]; a pair of them alone '
            "has the number of teeth of a ring negative",
        ),
        Wish(
            ("hand", "hand_of_helix", "helix_hand", "helix_direction", "handedness"),
            (),
            "a pair of the other hand is the mirror image, with the same loads and losses, its axial "
            "forces the other way; leave it out",
        ),
        Wish(
            ("hob_addendum", "cutter_addendum", "tool_addendum", "rack_addendum"),
            ("dedendum",),
            f"{_RACK}, whose addendum makes the dedendum",
            _in_modules("dedendum", RACK),
        ),
        Wish(
            (
                *(
                    "tip_radius",
                    "cutter_tip_radius",
                    "hob_tip_radius",
                    "tool_tip_radius",
                    "edge_radius",
                ),
                *("root_fillet", "root_radius", "rack_tip_radius"),
            ),
            ("fillet_radius",),
            f"{_RACK}, whose rounding makes the fillet",
            _in_modules("fillet_radius", FILLET),
        ),
        Wish(
            (
                "protuberance",
                "protuberance_angle",
                "protuberance_amount",
                "grinding_stock",
                "stock",
            ),
            (),
            f"{_RACK} without protuberance or stock; dedendum and fillet_radius say the finished root",
        ),
        Wish(
            ("shaper_teeth", "pinion_cutter", "cutter"),
            ("cutter_teeth",),
            "the root of a ring is that of its pinion cutter",
        ),
        Wish(
            ("cutter_shift", "shaper_shift"),
            ("cutter_profile_shift",),
            "the root of a ring is that of its pinion cutter",
        ),
        Wish(
            ("material", "materials", "steel"),
            (),
            "materials have a table [materials] with gear_1 and gear_2",
        ),
        Wish(
            ("hob", "tool"),
            (),
            f"{_RACK}, of a ring those of its counterpart; dedendum and fillet_radius say the root",
        ),
        Wish(
            ("shaft_angle", "axis_angle", "axes_angle", "crossing_angle"),
            (),
            "gears whose axes cross are not here; leave it out where they are parallel",
        ),
        Wish(
            ("ratio", "gear_ratio", "transmission_ratio", "reduction"),
            ("teeth",),
            "the ratio follows from the numbers of teeth",
        ),
        Wish(
            ("contact_ratio",),
            ("addendum",),
            "the contact ratio follows from the teeth, and stands in the result",
        ),
        Wish(
            (
                "quality",
                "accuracy",
                "accuracy_grade",
                "iso_quality",
                "din_quality",
                "agma_quality",
                "iso_class",
            ),
            ("inspection",),
            "the class of ISO 1328-1 is a key of [gears.deviations] and of [gears.inspection]",
            _by_class,
        ),
    ),
    "operation": (
        Wish(
            (
                *("input_torque", "torque_in", "torque_input", "driver_torque", "driving_torque"),
                *("motor_torque", "pinion_torque", "torque_1", "drive_torque"),
            ),
            ("torque", "force"),
            "torque counts at the driven gear",
            _by_input_torque,
        ),
        Wish(
            ("power", "input_power", "output_power", "motor_power", "power_in", "rated_power"),
            ("torque", "force"),
            "load and speed say the power",
            _by_power,
        ),
        Wish(
            ("output_torque", "load_torque", "torque_2", "driven_torque", "torque_out"),
            ("torque",),
            "the torque is that of the driven member",
            _renamed("torque"),
        ),
        Wish(
            ("output_speed", "driven_speed", "load_speed", "speed_2", "speed_out", "n_2"),
            ("speed",),
            "the speed counts at the driving member",
            _by_output_speed,
        ),
        Wish(
            (
                "input_speed",
                "motor_speed",
                "driver_speed",
                "driving_speed",
                "speed_1",
                "speed_in",
                "n_1",
            ),
            ("speed",),
            "the speed is that of the driving member",
            _renamed("speed"),
        ),
        Wish(
            (
                *("rpm", "n", "rotational_speed", "angular_velocity", "angular_speed", "omega"),
                "revolutions",
            ),
            ("speed",),
            "the speed is that of the driving member",
            _in_rpm,
        ),
        Wish(
            ("duty_cycle", "spectrum", "load_spectrum", "load_cases", "collective", "duty"),
            (),
            "an operating point is one load at one speed; each further one is a table [variants.NAME], or a "
            'step of --sweep operation.torque="10 N m:60 N m:6"; a load over time is the file of a '
            "table [duty]",
        ),
        Wish(
            ("oil_temperature", "ambient_temperature", "oil_temp", "temp"),
            ("temperature",),
            "the temperature is that of the oil and around the gears",
            _renamed("temperature"),
        ),
        Wish(
            ("planets", "number_of_planets"),
            (),
            "the load is that of one mesh; of equal planets, each carries its share",
            _share_of_planets,
        ),
    ),
    "strength": (
        Wish(
            ("k_a", "application", "service_factor", "overload_factor"),
            ("application_factor",),
            "K_A is the application factor",
            _renamed("application_factor"),
        ),
        Wish(
            ("k_v",),
            ("dynamic_factor",),
            "K_v is the dynamic factor",
            _renamed("dynamic_factor"),
        ),
        Wish(
            ("k_hbeta", "k_hb"),
            ("face_load_factor",),
            "K_Hβ is the face load factor",
            _renamed("face_load_factor"),
        ),
        Wish(
            ("k_gamma", "planet_load_factor", "load_sharing_factor", "mesh_load"),
            ("mesh_load_factor",),
            "K_γ is the mesh load factor",
            _renamed("mesh_load_factor"),
        ),
        Wish(
            ("k_halpha", "k_ha"),
            ("transverse_load_factor",),
            "K_Hα is the transverse load factor",
            _renamed("transverse_load_factor"),
        ),
        Wish(
            ("quality", "accuracy", "accuracy_grade", "iso_quality", "iso_class", "q"),
            ("accuracy_class",),
            "the class is that of ISO 1328-1",
            _renamed("accuracy_class"),
        ),
        Wish(
            ("hours", "life_hours", "lifetime", "service_life", "required_life", "l_h"),
            ("life",),
            "the life is a time under load",
            _renamed("life"),
        ),
        Wish(
            (
                "s_hmin",
                "s_fmin",
                "minimum_safety",
                "flank_safety",
                "root_safety",
                "safety_factor",
                "safety",
            ),
            (),
            "safeties are results; a bound on them stands in [targets] or in a study",
        ),
    ),
    "wear": (
        Wish(
            (
                "turns",
                "revolutions",
                "n_turns",
                "number_of_turns",
                "n_cycles",
                "load_cycles",
                "life",
            ),
            ("cycles",),
            "cycles are turns of the driver",
            _renamed("cycles"),
        ),
        Wish(
            ("k", "archard", "archard_coefficient", "wear_coefficient", "wear_factor"),
            ("coefficient",),
            "K of Archard's law is coefficient",
            _renamed("coefficient"),
        ),
    ),
    "roughness": (
        Wish(
            ("rz", "rz_1", "rz_iso"),
            ("ra",),
            "roughness counts by Ra or Rq, and Rz is neither",
            _by_rz,
        ),
        Wish(
            ("mq", "sq", "rms", "rrms", "rms_roughness"),
            ("rq",),
            "the root mean square of the heights of each flank is rq",
            _renamed("rq"),
        ),
        Wish(
            ("ma", "sa", "cla", "aa", "mean", "value", "roughness", "surface_roughness"),
            ("ra",),
            "the arithmetic mean of the heights of each flank is ra",
            _renamed("ra"),
        ),
        Wish(
            ("rt", "rmax", "ry", "rp", "rv", "rpk", "rk", "rvk", "rsk", "rku", "rmr"),
            (),
            "roughness counts by the mean of its heights alone: ra, or rq for the root mean square",
        ),
    ),
    "lubricant": (
        Wish(
            ("vg", "iso_vg", "grade", "viscosity_grade"),
            ("name",),
            "a grade is part of the name of an oil; pitchpoint models lists them",
            _by_grade,
        ),
        Wish(
            ("temperature", "oil_temperature", "t_oil"),
            (),
            "the temperature of the oil is that of the gears, `temperature` in [operation]",
        ),
        Wish(
            ("viscosity", "kinematic_viscosity", "dynamic_viscosity", "nu", "eta"),
            ("viscosity_40",),
            "viscosity changes with temperature; an oil has a name, or viscosity_40 with viscosity_100 and "
            "base",
        ),
    ),
}
"""What is asked for often, by table."""

_BY_NAME = {
    (table, letters(name)): wish
    for table, wishes in WISHES.items()
    for wish in wishes
    for name in wish.names
}

_OF_CASE = {"gears", "operation", "strength", "roughness", "lubricant", "materials"}
"""Tables whose wishes are answered in any other table."""

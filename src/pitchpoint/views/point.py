"""Where a result was run, and the period of its mesh."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isfinite
from typing import Any

import numpy as np

from pitchpoint.results.by_stage import Label
from pitchpoint.results.variable import angle, length
from pitchpoint.runs.run import Outcome
from pitchpoint.views import show
from pitchpoint.views.inputs import input_number, input_value

__all__ = [
    "OperatingPoint",
    "Period",
    "by_bodies",
    "by_members",
    "driver_speed_ratio",
    "member_names",
    "named_members",
    "of_geometry",
    "of_stage_by_bodies",
    "operating_point",
    "period_of",
    "ratio_words",
    "way_in_a_turn",
]

_WAY, _TURN = length("", ""), angle("", "")


@dataclass(frozen=True)
class OperatingPoint:
    """Where a variant is run.

    Attributes:
        torque: of the loaded member [N m], or force on one that travels [N].
        speed: of the driver [rad/s].
        temperature: of the oil [K].
    """

    torque: float
    speed: float
    temperature: float


@dataclass(frozen=True)
class Period:
    """What the phase of a mesh counts.

    Attributes:
        angle: driver angle after which the state of the mesh repeats [rad]; its way [m] where it travels.
        travels: True if the driver travels.
        time: after which it does [s].
        pitch: what it is called.
        against: why time runs against the phase; empty where it does not.
    """

    angle: float
    travels: bool
    time: float
    pitch: str
    against: str

    @property
    def backwards(self) -> bool:
        """True if the phase falls while the drive turns on."""
        return bool(self.against)

    @property
    def words(self) -> str:
        """How far the driver moves in a period."""
        if self.travels:
            angle = show.number_text(float(_WAY.displayed(self.angle)))
            return f"{angle} {show.display_unit(_WAY.display)} of the driver"
        turn, unit = (
            show.number_text(float(_TURN.displayed(self.angle))),
            show.display_unit(_TURN.display),
        )
        return f"{turn}{'' if unit == '°' else ' '}{unit} of the driver"

    @property
    def axis(self) -> str:
        """Title of an axis of the phase."""
        several = "es" if self.pitch.endswith("h") else "s"
        return f"phase of the mesh cycle [{self.pitch}{several}]"


def operating_point(outcome: Outcome) -> OperatingPoint:
    """Where a result was run, whatever its gears."""
    load = "torque" if input_value(outcome, "operation", "torque") is not None else "force"
    names = {"torque": load, "speed": "speed", "temperature": "temperature"}
    return OperatingPoint(
        **{name: input_number(outcome, "operation", key) for name, key in names.items()}
    )


def member_names(outcome: Outcome, stage: Label) -> dict[str, str]:
    """Members of a stage, "gear 1" say, and the bodies of a train that they are; else themselves."""
    record = next(one for one in outcome.manifest["stages"] if one["number"] == stage)
    return dict(zip(map(str, record["members"]), _by_bodies(record), strict=True))


def named_members(outcome: Outcome) -> list[str]:
    """Members of a mesh by the bodies of a train that they are, "sun" say; else by themselves."""
    return _by_bodies(outcome.manifest)


def by_members(outcome: Outcome, text: str) -> str:
    """A text on a planetary set whose case has no stages, with the members of its meshes in place of these.

    Args:
        outcome: of any case; other than of such a set the text stays as it is.
        text: that says "stage 1" of the mesh of sun and planet, say.
    """
    if not any(
        row["table"] == "gears" and row["key"] == "family" and row["value"] == "planetary"
        for row in outcome.manifest["inputs"]
    ):
        return text
    meshes = {str(record["number"]): _by_bodies(record) for record in outcome.manifest["stages"]}
    names = {number: _central(bodies) for number, bodies in meshes.items()}
    every = "|".join(map(re.escape, meshes))

    def member(at: re.Match[str]) -> str:
        own, central = at[1], names[at[2]]
        return own if own == central else f"{own} in {central} mesh"

    def gear(at: re.Match[str]) -> str:
        return f"{at[1]}tage {at[2]}: {meshes[at[2]][int(at[3]) - 1]}"

    def mesh(at: re.Match[str]) -> str:
        words = f"{names[at[2]]} mesh"
        return words if at[1] == "s" else words.capitalize()

    text = re.sub(rf"\b(\w+) of stage ({every})\b", member, text)
    text = re.sub(rf"\b([Ss])tage ({every}): gear (\d)", gear, text)
    text = re.sub(r"\b([Ss])tages 1 and 2\b", lambda at: f"{'Bb'[at[1] == 's']}oth meshes", text)
    return re.sub(rf"\b([Ss])tage ({every})\b", mesh, text)


def by_bodies(outcome: Outcome, text: str) -> str:
    """A text on a mesh of a train with bodies, "the ring" say, in place of its members, "gear 2"."""
    return _in_bodies(outcome.manifest, text)


def of_stage_by_bodies(outcome: Outcome, text: str) -> str:
    """A text that begins with its stage, with the bodies of that in place of the members of its mesh."""
    stages = outcome.manifest.get("stages", ()) if text[1:].startswith("tage ") else ()
    records = [record for record in stages if text[1:].startswith(f"tage {record['number']}: ")]
    return _in_bodies(records[0], text) if records else text


def _in_bodies(record: Mapping[str, Any], text: str) -> str:
    if not record.get("bodies"):
        return text
    bodies = dict(zip(map(str, record["members"]), _by_bodies(record), strict=True))
    bodies = {member: body for member, body in bodies.items() if member != body}
    if not bodies:
        return text

    def named(at: re.Match[str]) -> str:
        if at["member"] is None:  # quoted, as a name of the user's
            return at[0]
        body = bodies.get(at["member"]) or bodies[f"{at['member'][0].lower()}{at['member'][1:]}"]
        if at["label"]:
            return f": {body}"
        return (
            show.with_article(body)
            if at["member"] in bodies
            else show.sentence(show.with_article(body), False)
        )

    every = "|".join(re.escape(name) for own in bodies for name in (own, own.capitalize()))
    return re.sub(rf'"[^"]*"|(?P<label>: (?=(?:{every}): ))?\b(?P<member>{every})\b', named, text)


def _central(bodies: Sequence[str]) -> str:
    """The body of a mesh of a planetary set that is no planet."""
    return next((body for body in bodies if body != "planet"), bodies[0])


def _by_bodies(record: Mapping[str, Any]) -> list[str]:
    """Members of a mesh, or of a stage, by the bodies of its record as far as these are as many."""
    members = [str(member) for member in record["members"]]
    bodies = str(record.get("bodies", "")).split(" and ")
    return bodies if len(bodies) == len(members) else members


def driver_speed_ratio(outcome: Outcome) -> float:
    """Speed of the driver over that of the loaded member; NaN where one of them travels."""
    manifest = outcome.manifest
    motion = dict(zip(manifest["members"], manifest["motion"], strict=True))
    driver, loaded = manifest["driver"], manifest["loaded"]
    if manifest.get("travels") or not motion.get(loaded) or driver not in motion:
        return np.nan
    return float(motion[driver]) / float(motion[loaded])


def ratio_words(outcome: Outcome) -> str:
    """That ratio as a number; empty where one of them travels."""
    ratio = driver_speed_ratio(outcome)
    return show.number_text(ratio, 6) if isfinite(ratio) else ""


def way_in_a_turn(outcome: Outcome) -> str:
    """How far a loaded member that travels goes in a turn of the driver, in words; empty where it turns."""
    manifest = outcome.manifest
    if manifest.get("travels") != ["loaded"]:
        return ""
    motion = dict(zip(manifest["members"], manifest["motion"], strict=True))
    ratio = abs(float(motion[manifest["loaded"]]) / float(motion[manifest["driver"]]))
    return f"{show.number_text(float(_WAY.displayed(2.0 * np.pi * ratio)))} {show.display_unit(_WAY.display)}"


def period_of(outcome: Outcome) -> Period:
    """Period of a result's mesh."""
    manifest = outcome.manifest
    angle = float(manifest["period"])
    return Period(
        angle,
        "driver" in manifest["travels"],
        angle / input_number(outcome, "operation", "speed"),
        str(manifest["pitch"]),
        str(manifest["against"]),
    )


def of_geometry(outcomes: dict[str, Outcome]) -> list[tuple[str, Outcome]]:
    """Names of the variants that share their teeth, and one of them; no names if all do, stages have theirs.

    Args:
        outcomes: by variant, or by stage, whose teeth are there.
    """
    groups: list[tuple[list[str], Outcome]] = []
    for variant, outcome in outcomes.items():
        for names, drawn in groups:
            if _same_geometry(drawn, outcome):
                names.append(variant)
                break
        else:
            groups.append(([variant], outcome))
    return [
        (", ".join(names) if len(groups) > 1 or "number" in outcome.manifest else "", outcome)
        for names, outcome in groups
    ]


def _same_geometry(first: Outcome, second: Outcome) -> bool:
    """True if both variants have the same teeth and turn the same way, driven by the same member."""
    one, two = first.parts["teeth"], second.parts["teeth"]
    return (
        one.sizes == two.sizes
        and set(one.data_vars) == set(two.data_vars)
        and all(
            np.array_equal(one[name].values, two[name].values, equal_nan=True)
            for name in one.data_vars
        )
        and all(first.manifest[key] == second.manifest[key] for key in ("driver", "motion"))
    )

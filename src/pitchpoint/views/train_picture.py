"""A set of meshes that turn together, whole: sun, planets on their carrier, rings, placed tooth in space.

Angles are counter-clockwise here and clockwise in the page. Gears that lie in planes of their own, as those
of stepped planets, are drawn side by side.
"""

from collections.abc import Mapping
from math import atan2, degrees, pi
from typing import Any

from pitchpoint.runs.run import Outcome
from pitchpoint.views.picture import PictureBody, picture_of
from pitchpoint.views.section import of_meshes

__all__ = ["train_pictures"]

Record = Mapping[str, Any]

_EDGE = 1.03
"""Half the width of a picture over the largest radius in it."""


def train_pictures(outcome: Outcome, train: Record) -> list[dict[str, Any]]:
    """What the page draws of each plane of a set, in mm and degrees, y downwards.

    Args:
        outcome: of a set, or of a drive with it among its stages, with teeth.
        train: its record in the manifest.
    """
    meshes = dict(of_meshes(outcome, "teeth"))
    planes: dict[tuple[float, int], list[tuple[Record, dict[str, PictureBody]]]] = {}
    for one in train["meshes"]:
        mesh = meshes.get(f"stage {one['label']}")
        if one["carrier"] not in train["rates"] or mesh is None:
            continue
        bodies = dict(zip(one["bodies"], picture_of(mesh).bodies, strict=True))
        planet = next(body for body in one["bodies"] if body in train["planets"])
        teeth = one["teeth"][one["bodies"].index(planet)]
        planes.setdefault((teeth, one["planet_gear"]), []).append((one, bodies))
    drawn = [_plane(every, train) for every in planes.values()]
    outside = max((one["outside"] for one in drawn), default=0.0)  # one scale for all
    return [one | {"window": (-outside, -outside, 2.0 * outside, 2.0 * outside)} for one in drawn]


def _plane(meshes: list[tuple[Record, dict[str, PictureBody]]], train: Record) -> dict[str, Any]:
    """Gears in one plane, each placed by those before it."""
    settled: dict[tuple[str, int], float] = {}
    gears: dict[tuple[str, int], PictureBody] = {}
    distance = 0.0
    for copy, angle in enumerate(train["angles"]):
        for one, bodies in meshes:
            distance = _place(one["bodies"], bodies, train["planets"], copy, angle, settled)
            gears |= {
                (name, copy * (name in train["planets"])): body for name, body in bodies.items()
            }
    rates = train["rates"]
    carrier = rates[meshes[0][0]["carrier"]]
    drawn = []
    for (name, copy), body in gears.items():
        on_carrier = name in train["planets"]
        rate = rates[name] - carrier if on_carrier else rates[name]
        drawn.append(
            body.svg()
            | {
                "name": name,
                "turn": round(-degrees(settled[name, copy]), 5),
                "rate": -rate,
                "at": round(-degrees(train["angles"][copy]), 5) if on_carrier else None,
                "kind": 2 if body.ring else 3 if on_carrier else 1,
            }
        )
    outside = _EDGE * max(distance * on + body.outside for body, on in _reaches(gears, train))
    return {
        "gears": sorted(drawn, key=lambda one: not one["ring"]),
        "carrier": -carrier,
        "distance": round(1e3 * distance, 4),
        "pins": [round(-degrees(angle), 5) for angle in train["angles"]],
        "pin": round(0.09e3 * distance, 4),
        "outside": round(1e3 * outside, 4),
        "names": list(dict.fromkeys(name for name, _ in gears)),
    }


def _reaches(
    gears: Mapping[tuple[str, int], PictureBody], train: Record
) -> list[tuple[PictureBody, bool]]:
    return [(body, name in train["planets"]) for (name, _), body in gears.items()]


def _place(
    names: list[str],
    bodies: Mapping[str, PictureBody],
    planets: list[str],
    copy: int,
    angle: float,
    settled: dict[tuple[str, int], float],
) -> float:
    """Turns the bodies of a mesh so that teeth stand in spaces; its centre distance [m].

    Args:
        names: of both bodies.
        bodies: in mesh at phase zero.
        planets: bodies of which there are several.
        copy: number of the planet.
        angle: of the planet about the axis of the carrier [rad].
        settled: rotation of what stands already, to which others are added [rad].
    """
    planet, central = sorted(names, key=lambda name: name not in planets)
    across, up = (a - b for a, b in zip(bodies[planet].place, bodies[central].place, strict=True))
    seen = angle - atan2(up, across)
    keys = {planet: (planet, copy), central: (central, 0)}
    phase = 0.0
    for name in (central, planet):
        if keys[name] in settled:
            body = bodies[name]
            off = settled[keys[name]] - body.turned - seen
            pitch = 2.0 * pi / body.count
            phase = (off - pitch * round(off / pitch)) / body.spin
            break
    for name in names:
        body = bodies[name]
        settled.setdefault(keys[name], body.turned + seen + phase * body.spin)
    return float((across**2 + up**2) ** 0.5)

"""Cases whose reports are read."""

from html.parser import HTMLParser
from math import pi
from pathlib import Path
from typing import Any

import bank
import numpy as np
from records import entries
from sound import SMOOTH

from pitchpoint.core.programs import program
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair
from pitchpoint.gears.cylindrical.family import FAMILY
from pitchpoint.gears.family import Family
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.mesh_bodies import drawing
from pitchpoint.gears.nominal_motion import mesh_ends, nominal_motion, nominal_period, phase_sense
from pitchpoint.gears.pairs import way_of_pairs
from pitchpoint.results.store import dataset
from pitchpoint.runs.run import Outcome

Outcomes = dict[str, Outcome]
TITLE = "<script>alert('title')</script>"
NOTED = '{ value = "15 mm", status = "assumed", note = "</script><b>" }\naddendum = 1.4'
GEARS = SMOOTH.replace('"15 mm"', NOTED)
PUBLISHED = f"""
title = "{TITLE}"
{GEARS}
[loss_map]
count = 3
[variants.as_published.models]
friction = ["iso_tr_14179_2", "xu_2007"]
averaging = "path"
[variants.physical.models]
friction = "constant"
[studies.point]
title = "One point"
[studies.shape]
title = "Shape"
sweep = {{ key = "gears.addendum", start = 1.0, stop = 1.4, count = 3 }}
[[targets]]
quantity = "number out of reach"
where = "Table 9"
kind = "predicted"
printed = 50.0
unit = "%"
tolerance = 0.01
study = "point"
variable = "mean_efficiency"
reason = "made to miss"
[[targets]]
quantity = "number left out"
where = "Table 9"
kind = "excluded"
printed = 1.0
reason = "never computed"
[[issues]]
where = "eq. 1"
issue = "<i>slip</i>"
verdict = "`physical` differs"
"""
IDLE = """
[gears]
teeth = 17
module = "2 mm"
face_width = "15 mm"
flank = "right"
[lubricant]
name = "75W90-A"
[roughness]
ra = "0.4 um"
[operation]
torque = "0 N m"
speed = "100 rpm"
temperature = "60 degC"
[loss_map]
count = 2
"""
WHEEL = """
[gears]
teeth = [12, 120]
module = "2 mm"
face_width = "15 mm"
profile_shift = [0.5, 0.0]
[lubricant]
name = "75W90-A"
[roughness]
ra = "0.4 um"
[operation]
driver = "gear 2"
torque = "5 N m"
speed = "100 rpm"
temperature = "60 degC"
[models]
friction = "constant"
[loss_map]
count = 2
"""


def computed(folder: Path, name: str, text: str) -> Outcomes:
    (folder / f"{name}.toml").write_text(text, encoding="utf-8")
    return bank.outcomes(folder / f"{name}.toml")


class Words(HTMLParser):
    """What a reader sees, and the identities of the places for figures."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.words: list[str] = []
        self.plots: list[str] = []
        self.tags: list[str] = []
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        known = dict(attrs)
        if known.get("class") == "plot" and "data-figure" not in known:
            self.plots.append(str(known["id"]))

    def handle_data(self, data: str) -> None:
        if self.tags[-1:] not in (["script"], ["style"]):
            self.words.append(data)

    def handle_endtag(self, tag: str) -> None:
        self.tags.append(f"/{tag}")

    @property
    def text(self) -> str:
        return " ".join(" ".join(self.words).split())


OUTSIDE = {
    "helical, four teeth": {
        "teeth": (4, 51),
        "helix_angle": np.deg2rad(20.0),
        "profile_shift": (0.74, 0.05),
        "least_tip": 0.25,
    },
    "helical, right flanks": {
        "teeth": (19, 33),
        "helix_angle": np.deg2rad(15.0),
        "right_flank": True,
    },
    "ring": {"teeth": (20, -60), "addendum": (1.0, 0.8), "profile_shift": (0.3, 0.2)},
    "helical ring, gear 2 drives": {
        "teeth": (17, -50),
        "addendum": (1.0, 0.8),
        "profile_shift": (0.3, 0.2),
        "helix_angle": np.deg2rad(18.0),
        "driver": 2,
    },
}


def shown(driver: int = 1, **changes: Any) -> Outcome:
    """A result that holds nothing but the teeth of a pair."""
    pair = build_cylindrical_pair(
        module=0.002, pressure_angle=np.deg2rad(20.0), face_width=0.016, **changes
    )
    outcome = drawn_teeth(pair, FAMILY, f"gear {driver}", ["gear 1", "gear 2"])
    outcome.manifest["inputs"] += entries(
        {"gears.module": 0.002, "gears.profile_shift": [0.74, -0.05]}
    )
    return outcome


DRAWING = program(drawing)


def drawn_teeth(mesh: Mesh, family: Family, driver: str, members: list[str]) -> Outcome:
    """The part `teeth` of a mesh, and the record that a picture needs."""
    numbers = {name: np.asarray(value) for name, value in DRAWING(mesh).items()}
    teeth = dataset(
        {n: (family.drawing.get(n, ("gear",)[: v.ndim]), v) for n, v in numbers.items()},
        dict(family.coordinates),
        title="teeth",
    )
    motion = nominal_motion(mesh, *mesh_ends(mesh, driver))
    teeth["points"].attrs.update(way_of_pairs(mesh).attributes(members))
    inputs = {
        "operation.torque": 5.0,
        "operation.speed": 60.0 * pi,
        "operation.temperature": 333.15,
    }
    manifest = {
        "inputs": entries(inputs),
        "driver": driver,
        "members": members,
        "motion": motion.tolist(),
        "period": float(nominal_period(mesh, motion)),
        "travels": ["driver"] if driver == "rack" else [],
        "pitch": "base pitch",
        "against": f"{driver} drives" if phase_sense(mesh, motion) < 0.0 else "",
    }
    return Outcome(manifest, {"teeth": teeth})

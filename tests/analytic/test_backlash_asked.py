"""A backlash that a case asks for: how deep the teeth are cut for it, and what stays where it was."""

import copy
import tomllib
from math import cos, pi, radians, tan
from typing import Any

import equinox as eqx
import numpy as np
import pytest
from jaxtyping import Array
from pydantic import ValidationError
from sound import PAIR

from pitchpoint.analyses.inspection import inspection_part
from pitchpoint.analyses.teeth import drawing_of
from pitchpoint.cases.resolved_inputs import resolved
from pitchpoint.cases.variant import Variant
from pitchpoint.gears.cylindrical.family import FAMILY
from pitchpoint.gears.cylindrical.involute_pair import InvolutePair
from pitchpoint.gears.cylindrical.table import CylindricalGears

COMMON = {"teeth": [20, 40], "module": "2 mm", "face_width": "20 mm"}
DRAWN = {"inspection": {"span_teeth": [3, 5]}}


def case(**gears: Any) -> Variant:
    tree = copy.deepcopy(tomllib.loads(PAIR)) | {"gears": COMMON | gears}
    return Variant(tree, "pair.toml", "default", {})


def table(**gears: Any) -> CylindricalGears:
    return CylindricalGears.model_validate(COMMON | gears)


@eqx.filter_jit
def _measured(pair: InvolutePair) -> tuple[Array, Array]:
    return pair.backlash, pair.tip_radii


def test_standard_teeth_are_thinned_by_half_the_backlash_each() -> None:
    # By hand: on the reference circles, which are those in operation, each tooth lacks 40 um of pi/2 modules;
    # its rack goes in by 40 um/(2 tan 20 deg) = 54.950 um, so does the root, and the tip stays.
    built = case(backlash="80 um", **DRAWN).built({})
    assert built.dimensions["circumferential_backlash"] == pytest.approx(80e-6, rel=1e-12)
    assert built.dimensions["normal_backlash"] == pytest.approx(80e-6 * cos(pi / 9), rel=1e-12)
    assert float(built.design.mesh.centre_distance) == pytest.approx(0.06, rel=1e-12)
    drawn = drawing_of(built)
    assert 2e3 * drawn["tip_radius"] == pytest.approx([44.0, 84.0], rel=1e-12)
    assert 2e3 * drawn["root_radius"][0] == pytest.approx(35.0 - 2 * 0.0549495, abs=1e-6)
    part = inspection_part(built)
    assert part["normal_thickness"].values[:, 0] == pytest.approx([1e-3 * pi - 40e-6] * 2)
    assert float(part["backlash_on_circle"][0]) == pytest.approx(80e-6)
    # W_3 = m cos(20 deg) (2.5 pi + 20 inv(20 deg)) less cos(20 deg) of what the tooth lacks
    nominal = 2e-3 * cos(pi / 9) * (2.5 * pi + 20 * (tan(pi / 9) - pi / 9))
    assert part["span_measurement"].values[0, 0] == pytest.approx(nominal - 40e-6 * cos(pi / 9))
    rows = {(row["table"], row["key"]): row for row in resolved(built, case().document())}
    cut = rows["dimensions", "generating_shift"]
    assert cut["status"] == "derived"
    assert cut["value"] == pytest.approx([-0.0274748] * 2, abs=1e-7)


@pytest.mark.parametrize(
    "gears",
    [
        {"profile_shift": [0.4, -0.2], "centre_distance": "60.5 mm"},
        {"centre_distance": "59.9 mm"},  # flanks of teeth that are not thinned overlap
        {"teeth": [20, -60], "profile_shift": [0.2, 0.1], "addendum": [1, 0.8]},
        {"teeth": [20, -60], "profile_shift": [0.2, -0.1], "centre_distance": "39.7 mm"}
        | {"addendum": [1, 0.8]},
        {"centre_distance": "61 mm", "profile_shift": "from centre distance"},
    ],
)
def test_the_pair_has_the_backlash_and_the_tips_of_nominal_teeth(gears: dict[str, Any]) -> None:
    asked, nominal = table(**gears, backlash="0.3 mm"), table(**gears)
    pair, told = FAMILY.build(asked, 1)
    backlash, tips = _measured(pair)
    assert float(backlash) == pytest.approx(3e-4, rel=1e-12)
    assert not any("overlap" in sentence for sentence in told)
    shift, other = asked.infeed
    assert shift == other < 0.0
    if nominal.centre_distance != 0.0599:
        unlike, _ = FAMILY.build(nominal, 1)
        assert np.asarray(tips) == pytest.approx(np.asarray(_measured(unlike)[1]), rel=1e-14)
        assert float(pair.centre_distance) == float(unlike.centre_distance)


def test_helical_teeth_lack_the_same_in_the_normal_section() -> None:
    gears = table(helix_angle="25 deg", backlash="80 um")
    # j_t of the reference circles, times cos(beta) in the normal section, by halves
    allowance = 2.0 * gears.module * tan(pi / 9) * gears.infeed[0]
    assert allowance == pytest.approx(-40e-6 * cos(radians(25.0)), rel=1e-10)


def refusal(**gears: Any) -> str:
    with pytest.raises(ValidationError) as error:
        table(**gears)
    return str(error.value)


def test_a_backlash_that_cannot_be_is_refused() -> None:
    by_field = refusal(backlash="50 um", inspection={"thickness_field": "cd25"})
    assert "each of them says how thin the teeth are, give one" in by_field
    assert "more than a tooth allows" in refusal(backlash="1.2 mm")
    wide = {"centre_distance": "60.1 mm"}
    told = refusal(backlash="50 um", **wide)
    least = told.partition("have more; give ")[2].partition(" or more")[0]
    assert 0.0 >= table(backlash=least, **wide).infeed[0] > -1e-4

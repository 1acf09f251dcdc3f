"""Points of a study that are built together are those that are built one by one."""

import jax
import numpy as np
import pytest

from pitchpoint.errors import InputError
from pitchpoint.gears import families
from pitchpoint.input.remembered import remembering
from pitchpoint.runs.case import as_case

SHIFTS = np.linspace(-0.6, 0.5, families.MANY + 4)


def test_gears_that_are_built_together_are_those_built_alone(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    variant = as_case("tian2024").held[0]
    changes = [{"gears.profile_shift.1": float(shift)} for shift in SHIFTS]
    monkeypatch.setattr(families, "_KEPT", {})
    together = variant.built_each(changes)
    monkeypatch.setattr(families, "_KEPT", {})
    refused = 0
    for change, one in zip(changes, together, strict=True):
        if isinstance(one, InputError):
            with pytest.raises(InputError) as told:
                variant.built(change)
            assert str(told.value).startswith(str(one))  # what mends it is sought for one alone
            refused += 1
            continue
        alone = variant.built(change)
        assert one.told == alone.told
        assert jax.tree.structure(one.design) == jax.tree.structure(alone.design)
        pairs = zip(jax.tree.leaves(one.design), jax.tree.leaves(alone.design), strict=True)
        for found, expected in pairs:
            np.testing.assert_allclose(found, expected, rtol=1e-12)
    assert 0 < refused < len(changes)


def test_equal_arguments_give_one_result_and_others_another() -> None:
    calls: list[dict[str, float]] = []

    @remembering
    def listed(table: dict[str, float]) -> list[float]:
        calls.append(table)
        return [*table.values()]

    first = listed({"a": 1.0})
    assert listed({"a": 1.0}) is first
    assert listed({"a": 2.0}) == [2.0]
    assert len(calls) == 2

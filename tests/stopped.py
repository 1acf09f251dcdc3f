"""Runs that are stopped in the middle, and go on."""

from collections.abc import Callable
from typing import Any

import pytest

from pitchpoint.analyses.analysis import Analysis


def stopped_and_gone_on(
    analysis: Analysis, run: Callable[[], Any], monkeypatch: pytest.MonkeyPatch
) -> tuple[Any, list[int]]:
    """What a run of films finds that was stopped in its second piece, and where each piece began."""
    begins: list[int] = []

    def stop(built: Any, piece: Any, progress: Any) -> Any:
        begins.append(piece["first"])
        if len(begins) == 2:
            raise KeyboardInterrupt
        return part(built, piece, progress)

    part = analysis.compute
    monkeypatch.setitem(vars(analysis), "compute", stop)
    with pytest.raises(KeyboardInterrupt):
        run()
    return run(), begins

"""Results whose reports and pictures several files read."""

from pathlib import Path

import pytest
from reported import IDLE, OUTSIDE, PUBLISHED, WHEEL, Outcomes, computed, shown

from pitchpoint.views.report import report_page


@pytest.fixture(scope="module")
def report_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("report")


@pytest.fixture(scope="module")
def published(report_folder: Path) -> Outcomes:
    return computed(report_folder, "published", PUBLISHED)


@pytest.fixture(scope="module")
def page(published: Outcomes) -> str:
    return report_page(published)


@pytest.fixture(scope="module")
def idle(report_folder: Path) -> Outcomes:
    return computed(report_folder, "idle", IDLE)


@pytest.fixture(scope="module")
def wheel(report_folder: Path) -> Outcomes:
    return computed(report_folder, "wheel", WHEEL)


@pytest.fixture(scope="module")
def outside() -> Outcomes:
    return {name: shown(**changes) for name, changes in OUTSIDE.items()}

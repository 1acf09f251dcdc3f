"""All publications that bring something of their own: each is loaded for the cases that name it."""

from typing import TYPE_CHECKING

from pitchpoint.registry import Registry

if TYPE_CHECKING:
    from pitchpoint.published.publication import Publication

__all__ = ["LAWS_OF_CASES", "PUBLICATIONS", "publication_of"]

PUBLICATIONS: "Registry[Publication]" = Registry(
    "publication",
    places={
        "atanasiu_2011": "pitchpoint.published.atanasiu2011.publication:PUBLICATION",
        "liu_xiong_2017": "pitchpoint.published.liu_xiong_torus.publication:PUBLICATION",
        "tian_2024": "pitchpoint.published.tian2024.publication:PUBLICATION",
        "xu_2021": "pitchpoint.published.xu2021.publication:PUBLICATION",
        "zhao_2022": "pitchpoint.published.zhao2022.publication:PUBLICATION",
    },
)

LAWS_OF_CASES = {
    "tian2024.method_1": "pitchpoint.published.tian2024.friction:METHOD_1",
    "tian2024.method_1_factor_1": "pitchpoint.published.tian2024.friction:METHOD_1_FACTOR_1",
    "tian2024.method_1_nominal": "pitchpoint.published.tian2024.friction:METHOD_1_NOMINAL",
    "tian2024.method_2": "pitchpoint.published.tian2024.friction:METHOD_2",
}
"""Places of readings of friction that are needed to reproduce tables; no spread counts them."""


def publication_of(source: str) -> "Publication | None":
    """What the publication with this key brings, its variables known from now on; None for others."""
    listed = source in PUBLICATIONS
    return PUBLICATIONS[source] if listed else None

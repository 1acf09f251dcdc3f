"""All publications that bring something of their own."""

from pitchpoint.published.atanasiu2011.publication import PUBLICATION as ATANASIU_2011
from pitchpoint.published.liu_xiong_torus.publication import PUBLICATION as LIU_XIONG_TORUS
from pitchpoint.published.publication import Publication
from pitchpoint.published.tian2024.publication import PUBLICATION as TIAN_2024
from pitchpoint.published.xu2021.publication import PUBLICATION as XU_2021
from pitchpoint.published.zhao2022.publication import PUBLICATION as ZHAO_2022
from pitchpoint.registry import Registry
from pitchpoint.results.variables import VARIABLES

__all__ = ["PUBLICATIONS"]

PUBLICATIONS: Registry[Publication] = Registry(
    "publication", ATANASIU_2011, LIU_XIONG_TORUS, TIAN_2024, XU_2021, ZHAO_2022
)

for _each in PUBLICATIONS.values():
    if _taken := [key for key, one in _each.variables.items() if VARIABLES.get(key, one) != one]:
        raise ValueError(f"{_each.name} calls others by names that are taken: {', '.join(_taken)}")
    VARIABLES.update(_each.variables)

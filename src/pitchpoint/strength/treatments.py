"""What ISO 6336 tells apart among steels: by their heat treatment."""

from collections.abc import Mapping
from dataclasses import dataclass

__all__ = ["PLASTIC", "TREATMENTS", "Life", "Treatment"]

NORMALISED = (5.306, 4.203, 0.01)
HARDENED = (1.674, 0.529, 0.1)
NITRIDED = (4.299, 3.259, 0.0058)


@dataclass(frozen=True)
class Life:
    """A life factor in the logarithms: level below the first number of cycles, 1 at the second, 0.85 at 1e10.

    Attributes:
        level: of the factor up to `few` cycles.
        few, many: numbers of load cycles.
    """

    level: float
    few: float
    many: float


@dataclass(frozen=True, kw_only=True)
class Treatment:
    """Constants of a group of materials.

    Attributes:
        name: in case files.
        title: in words.
        flank, root: life factors Z_NT (no pitting allowed) and Y_NT.
        slip_layer: rho' of the notch sensitivity [mm].
        surface: a, b, n of the relative surface factor a - b (Rz + 1)^n, Rz in um.
        smooth: that factor below Rz = 1 um.
        root_size: a, b, least of the size factor a - b m_n above m_n = 5 mm.
        flank_size: slope of the size factor of the flank above m_n = 10 mm [1/mm].
    """

    name: str
    title: str
    flank: Life
    root: Life
    slip_layer: float
    surface: tuple[float, float, float]
    smooth: float
    root_size: tuple[float, float, float]
    flank_size: float = 0.0


_SOFT = (1.03, 0.006, 0.85)
_HARD = (1.05, 0.01, 0.80)
_PITTING = Life(1.6, 1e5, 5e7)

TREATMENTS: Mapping[str, Treatment] = {
    one.name: one
    for one in (
        Treatment(
            name="normalised",
            title="normalised steel",
            flank=_PITTING,
            root=Life(2.5, 1e4, 3e6),
            slip_layer=0.0445,  # yield point 400 MPa
            surface=NORMALISED,
            smooth=1.07,
            root_size=_SOFT,
        ),
        Treatment(
            name="through_hardened",
            title="through-hardened steel",
            flank=_PITTING,
            root=Life(2.5, 1e4, 3e6),
            slip_layer=0.0064,  # yield point 800 MPa
            surface=HARDENED,
            smooth=1.12,
            root_size=_SOFT,
        ),
        Treatment(
            name="case_hardened",
            title="case-hardened steel",
            flank=_PITTING,
            root=Life(2.5, 1e3, 3e6),
            slip_layer=0.003,
            surface=HARDENED,
            smooth=1.12,
            root_size=_HARD,
            flank_size=0.005,
        ),
        Treatment(
            name="induction_hardened",
            title="flame- or induction-hardened steel",
            flank=_PITTING,
            root=Life(2.5, 1e3, 3e6),
            slip_layer=0.003,
            surface=HARDENED,
            smooth=1.12,
            root_size=_HARD,
            flank_size=0.005,
        ),
        Treatment(
            name="nitrided",
            title="gas-nitrided steel",
            flank=Life(1.3, 1e5, 2e6),
            root=Life(1.6, 1e3, 3e6),
            slip_layer=0.1005,
            surface=NITRIDED,
            smooth=1.025,
            root_size=_HARD,
        ),
        Treatment(
            name="nitrocarburised",
            title="nitrocarburised steel",
            flank=Life(1.1, 1e5, 2e6),
            root=Life(1.1, 1e3, 3e6),
            slip_layer=0.1005,
            surface=NITRIDED,
            smooth=1.025,
            root_size=_HARD,
        ),
    )
}
"""Steels by their treatment.

Source: ISO 6336-2:2006 and ISO 6336-3:2006, tables of life, notch, surface and size factors, where public
programs agree (two or more); IACS UR M56 Rev.4 (2021), 3.11 to 3.13, for notch, surface and size.
"""

_FLAT = Life(1.0, 1.0, 2.0)

PLASTIC = Treatment(
    name="plastic",
    title="plastic",
    flank=_FLAT,
    root=_FLAT,
    slip_layer=0.0,
    surface=(1.0, 0.0, 1.0),
    smooth=1.0,
    root_size=(1.0, 0.0, 1.0),
)
"""Plastics: their limits hold for a temperature and a life, and take no factors (VDI 2736)."""

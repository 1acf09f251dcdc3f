"""What ISO 6336 tells apart among steels: by their heat treatment."""

from collections.abc import Mapping
from dataclasses import dataclass

__all__ = ["PLASTIC", "PLASTIC_CYCLES", "TREATMENTS", "Life", "Treatment"]

NORMALISED = (5.306, 4.203, 0.01)
HARDENED = (1.674, 0.529, 0.1)
NITRIDED = (4.299, 3.259, 0.0058)


@dataclass(frozen=True)
class Life:
    """A life factor in the logarithms: level below the first number of cycles, 1 at the second, 0.85 at 1e10.

    Attributes:
        level: of the factor up to `few` cycles.
        few, many: numbers of load cycles.

    Source: ISO 6336-2:2019 for Z_NT, ISO 6336-3:2019 for Y_NT.
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
        static_notch: slope over Y_S of the notch sensitivity for static strength.
        surface: a, b, n of the relative surface factor a - b (Rz + 1)^n, Rz in um.
        smooth: that factor below Rz = 1 um.
        root_size: a, b, least of the size factor a - b m_n above m_n = 5 mm.
        flank_size: a, b, least of the size factor of the flank a - b m_n, at most 1.

    Source: ISO 6336-2:2019 and ISO 6336-3:2019.
    """

    name: str
    title: str
    flank: Life
    root: Life
    slip_layer: float
    static_notch: float
    surface: tuple[float, float, float]
    smooth: float
    root_size: tuple[float, float, float]
    flank_size: tuple[float, float, float] = (1.0, 0.0, 1.0)


_SOFT = (1.03, 0.006, 0.85)
_HARD = (1.05, 0.01, 0.80)
_HARD_FLANK = (1.05, 0.005, 0.90)
_NITRIDED_FLANK = (1.08, 0.011, 0.75)
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
            static_notch=0.4389,
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
            static_notch=0.3909,
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
            static_notch=0.44,
            surface=HARDENED,
            smooth=1.12,
            root_size=_HARD,
            flank_size=_HARD_FLANK,
        ),
        Treatment(
            name="induction_hardened",
            title="flame- or induction-hardened steel",
            flank=_PITTING,
            root=Life(2.5, 1e3, 3e6),
            slip_layer=0.003,
            static_notch=0.44,
            surface=HARDENED,
            smooth=1.12,
            root_size=_HARD,
            flank_size=_HARD_FLANK,
        ),
        Treatment(
            name="nitrided",
            title="gas-nitrided steel",
            flank=Life(1.3, 1e5, 2e6),
            root=Life(1.6, 1e3, 3e6),
            slip_layer=0.1005,
            static_notch=0.20,
            surface=NITRIDED,
            smooth=1.025,
            root_size=_HARD,
            flank_size=_NITRIDED_FLANK,
        ),
        Treatment(
            name="nitrocarburised",
            title="nitrocarburised steel",
            flank=Life(1.1, 1e5, 2e6),
            root=Life(1.1, 1e3, 3e6),
            slip_layer=0.1005,
            static_notch=0.20,
            surface=NITRIDED,
            smooth=1.025,
            root_size=_HARD,
            flank_size=_NITRIDED_FLANK,
        ),
    )
}
"""Steels by their treatment.

Source: ISO 6336-2:2006 and ISO 6336-3:2006, tables of life, notch, surface and size factors, where public
programs agree (two or more); IACS UR M56 Rev.4 (2021), 3.11 to 3.13, for notch, surface and size; DIN
3990-11:1989 for static notch sensitivity and for nitrided flanks above m_n = 7.5 mm.
"""

_FLAT = Life(1.0, 1.0, 2.0)

PLASTIC_CYCLES = 1e8
"""Load cycles of plastic roots where no life is asked; they endure none for ever. The number is assumed."""

PLASTIC = Treatment(
    name="plastic",
    title="plastic",
    flank=_FLAT,
    root=Life(1.0, 1.0, PLASTIC_CYCLES),
    slip_layer=0.0,
    static_notch=0.0,
    surface=(1.0, 0.0, 1.0),
    smooth=1.0,
    root_size=(1.0, 0.0, 1.0),
)
"""Plastics: their limits hold for a temperature and a life, and take no factors but Y_St (VDI 2736)."""

"""Allowances and tolerances of the tooth thickness by DIN 3967, in fields such as cd25."""

from pitchpoint.errors import InputError

__all__ = ["FIELDS", "thickness_allowances"]

_UP_TO = (10, 50, 125, 280, 560, 1000, 1600, 2500, 4000, 6300, 10000)
_UPPER_IN_UM = {
    "a": (100, 135, 180, 250, 330, 450, 600, 820, 1100, 1500, 2000),
    "ab": (85, 110, 150, 200, 280, 370, 500, 680, 920, 1250, 1650),
    "b": (70, 95, 125, 170, 230, 310, 420, 560, 760, 1020, 1350),
    "bc": (58, 75, 105, 140, 190, 260, 340, 460, 620, 840, 1150),
    "c": (48, 65, 85, 115, 155, 210, 290, 390, 520, 700, 940),
    "cd": (40, 54, 70, 95, 130, 175, 240, 320, 430, 580, 780),
    "d": (33, 44, 60, 80, 110, 145, 200, 270, 360, 480, 640),
    "e": (22, 30, 40, 56, 75, 100, 135, 180, 250, 330, 450),
    "f": (10, 14, 19, 26, 35, 48, 64, 85, 115, 155, 210),
    "g": (5, 7, 9, 12, 17, 22, 30, 41, 56, 75, 100),
    "h": (0,) * 11,
}
_TOLERANCE_IN_UM = {
    21: (3, 5, 6, 8, 10, 12, 16, 20, 25, 30, 40),
    22: (5, 8, 10, 12, 16, 20, 25, 30, 40, 50, 60),
    23: (8, 12, 16, 20, 25, 30, 40, 50, 60, 80, 100),
    24: (12, 20, 25, 30, 40, 50, 60, 80, 100, 130, 160),
    25: (20, 30, 40, 50, 60, 80, 100, 130, 160, 200, 250),
    26: (30, 50, 60, 80, 100, 130, 160, 200, 250, 300, 400),
    27: (50, 80, 100, 130, 160, 200, 250, 300, 400, 500, 600),
    28: (80, 130, 160, 200, 250, 300, 400, 500, 600, 800, 1000),
    29: (130, 200, 250, 300, 400, 500, 600, 800, 1000, 1300, 1600),
    30: (200, 300, 400, 500, 600, 800, 1000, 1300, 1600, 2000, 2400),
}

FIELDS = tuple(f"{letters}{series}" for letters in _UPPER_IN_UM for series in _TOLERANCE_IN_UM)
"""Fields that are known: series of the upper allowance, then that of the tolerance, 24 to 27 preferred."""


def thickness_allowances(*, field: str, diameter: float) -> tuple[float, float]:
    """Upper and lower allowance of the tooth thickness in the normal section, A_sne and A_sni [m].

    Args:
        field: such as cd25, out of `FIELDS`.
        diameter: of the reference circle without sign, up to 10 m [m].

    Raises:
        InputError: a larger gear.

    Source: DIN 3967:1978, tables 1 and 2, as two public repositories have them, tkuhn39/semesterthesis and
    hakangunes258/mekanika.

    Example:
        >>> upper, lower = thickness_allowances(field="cd27", diameter=0.1)  # the standard's own
        >>> round(1e6 * upper), round(1e6 * lower)
        (-70, -170)
    """
    letters, series = field.rstrip("0123456789"), int(field.lstrip("abcdefgh"))
    size = 1e3 * diameter * (1.0 - 1e-9)  # the end of a range belongs to it, whatever units leave
    place = next((at for at, most in enumerate(_UP_TO) if size <= most), None)
    if place is None:
        raise InputError(f"a gear of {1e3 * diameter:.6g} mm is larger than the 10 m of DIN 3967")
    upper = _UPPER_IN_UM[letters][place]
    return -1e-6 * upper, -1e-6 * (upper + _TOLERANCE_IN_UM[series][place])

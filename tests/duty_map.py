"""A loss map whose losses can be added up by hand."""

from pitchpoint.efficiency.loss_table import LossTable

WARM = 313.15
RATIO = 0.02


def table(back: float = 1.0) -> LossTable:
    """Loses 2 N m at 40 degC and 3 at 20 beside a tenth of the load, at any speed."""
    torques, speeds, degrees = (-50.0, 0.0, 50.0), (0.0, 1.0, 10.0), (20.0, 40.0)
    lost = [
        [[(0.1 * abs(load) + base) * (back if load < 0.0 else 1.0) for base in (3.0, 2.0)]] * 3
        for load in torques
    ]
    return LossTable(torques, speeds, degrees, {"own": lost}, RATIO)

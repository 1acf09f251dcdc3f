"""Tian, Wang, Jiang (2024): instantaneous efficiency and torque ripple of a spur pair."""

"""Zhao et al. (2022): load and wear of the teeth of a strain-wave gear, double arc and involute."""

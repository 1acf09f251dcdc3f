"""Xu et al. (2021): load and lubrication of the meshing zones of a strain-wave gear."""

"""Dynamics of meshes: excitation, equations of motion, steady states, spectra, sweeps, transients."""

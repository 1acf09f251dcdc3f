"""Figures and the report: results made visible, with nothing computed anew."""

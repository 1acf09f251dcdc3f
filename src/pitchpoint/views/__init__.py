"""Figures and the report: results made visible; nothing but the geometry of drawings is computed."""

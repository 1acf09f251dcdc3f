"""Strain wave gears with each form of tooth, and the same by positions alone."""

from strain_wave_positions import drive

from pitchpoint.gears.strain_wave.design import InvoluteForm, build_strain_wave
from pitchpoint.gears.strain_wave.strain_wave_registry import DOUBLE_ARCS

MODULE, RIM = 0.3e-3, 0.7e-3
INVOLUTE = InvoluteForm(3.32)
FORMS = {"flat": DOUBLE_ARCS["flat"], "liu": DOUBLE_ARCS["liu"], "involute": INVOLUTE}


def build(**options):
    form = options.setdefault("form", DOUBLE_ARCS["flat"])
    options.setdefault("clearance", 0.35 if isinstance(form, InvoluteForm) else 0.25)
    options = {"teeth": (200, 202), "rim_thickness": RIM} | options
    return build_strain_wave(module=MODULE, face_width=0.01, **options)


BY = {name: drive(form) for name, form in FORMS.items()}

"""A strain-wave gear of size 32 and ratio 100 beside the torsional stiffness of a catalogue."""

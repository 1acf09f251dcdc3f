"""A strain-wave gear of size 25 and ratio 100 beside the efficiencies of a catalogue."""

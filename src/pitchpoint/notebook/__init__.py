"""Results and studies for people at a Python prompt or in a notebook."""

"""Analyses: what is computed of a case, each an entry that says what it needs and what it gives."""

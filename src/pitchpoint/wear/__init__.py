"""Wear of flanks: how much is worn off per force and sliding distance, and what that makes of a flank."""

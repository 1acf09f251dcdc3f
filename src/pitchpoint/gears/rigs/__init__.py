"""Test rigs: one contact that stays where it is, with closed forms everywhere."""

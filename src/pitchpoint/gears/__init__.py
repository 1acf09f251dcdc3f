"""Gear families: where their teeth touch and how they move there."""

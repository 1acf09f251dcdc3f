"""Elastohydrodynamic contacts solved: pressure and film from Reynolds' equation, elasticity and load."""

"""How the load is shared between pairs, and the balance of torques with friction."""

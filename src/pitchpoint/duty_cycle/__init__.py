"""What a drive does over its duty cycle: energy, motor, heat, life; of the loss map, in arrays."""

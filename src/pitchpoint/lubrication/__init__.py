"""Film thickness, friction laws and rolling resistance, all functions of the conditions at a contact."""

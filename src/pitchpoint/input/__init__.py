"""Numbers with units, and tables, as a user writes them."""

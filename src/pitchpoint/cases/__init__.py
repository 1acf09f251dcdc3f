"""Cases: TOML files that describe a gear pair and what to compute; published ones ship with the package."""

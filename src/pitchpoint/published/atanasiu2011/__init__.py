"""Atanasiu et al. (2011): helical steel/plastic pairs with few pinion teeth."""

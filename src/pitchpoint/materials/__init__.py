"""What touches and what is between: solids, lubricants, surfaces."""

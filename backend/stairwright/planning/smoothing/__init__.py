"""From lattice poses to a smooth, dense path with its margins and times."""

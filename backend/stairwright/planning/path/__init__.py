"""The dense certified path: lattice search, polish, timing (`method: path`)."""

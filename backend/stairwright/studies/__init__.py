"""Studies: one question asked over a whole range of terrains, frictions, robots."""

"""How fast a certified path can be driven: time-optimal parameterisation under dynamic limits."""

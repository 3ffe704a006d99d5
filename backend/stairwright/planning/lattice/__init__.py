"""Search over a lattice of body poses: where wheels and trunk may be, and the path through."""

"""Rollouts and trials on Dask's workers, and what studies share with them."""

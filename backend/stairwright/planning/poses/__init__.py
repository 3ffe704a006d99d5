"""The paper's pose optimisation: critical poses, its baseline, and the motion between them."""

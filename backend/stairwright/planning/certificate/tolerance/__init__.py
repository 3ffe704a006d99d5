"""What a plan keeps on every terrain within its tolerance: sets, bounded, not samples of them."""

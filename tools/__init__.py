"""What `./dev` does. Needs nothing but Python 3.11: it is what sets everything else up."""

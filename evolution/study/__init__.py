"""Which reading of the paper comes nearest to its figures: the study of readings (spec section 12)."""

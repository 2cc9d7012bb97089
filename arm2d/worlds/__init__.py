"""The world for controllers of one's own: step by step, one trial or thousands, and as Gymnasium knows it."""

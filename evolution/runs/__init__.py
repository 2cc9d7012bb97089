"""One run on disk: the loop that evolves, history, checkpoint, replay, lock and lease."""

"""The parts of the study that were declared before their first run (docs/declaration.md)."""

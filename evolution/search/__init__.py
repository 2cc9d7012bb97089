"""From one generation to the next: settings, randomness, the genetic algorithm, scoring."""

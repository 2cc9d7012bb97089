"""The questions that the paper ends with: other tasks, other networks, more and fewer words held out."""

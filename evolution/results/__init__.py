"""From run folders to numbers: analysis, statistics, the published figures."""

"""The confirmation with fresh seeds: which worlds, who wins, and whether the winner becomes the default.

worlds    the worlds and runs of each part
verdict   who is nearest to the paper, who beats the printed readings, which departures are needed
figure    the worlds beside the paper
decision  the winner against the printed readings once more, with seeds of their own
"""

"""The compiled trial: all trials of one genotype advance together in lanes.

    lanes          where each quantity of a lane stands in the flat state arrays
    network        how large a network is: the kernel is compiled for each size
    world          what the readings fix for every trial: joint grid, limits, cones
    controller     sense, think, turn
    camera_at_end  what a camera at the end of S1 sees, where the readings have it there
    contact        discs against S2
    scores         criteria step by step, F1 to F3 at the end
    loop           one genotype's trials from first to last; lanes are refilled as trials end

Only + - * / and square root are used, without fused or reordered operations, so results are the
same bits on every x86-64 processor. `arm2d.reference` is the same trial in plain Python.
"""

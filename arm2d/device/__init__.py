"""The kernel on a graphics card, by NVIDIA Warp (extra `gpu`): one thread a trial, the processor's bits.

    opening        which device is meant, or why there is none; nothing else here is imported before
    groups         genotypes with trials of their own, many groups in one batch
    memory         where a device is asked for memory or an answer
    errors         what is said if it has none, or gives none
    numbers        constants as Warp needs them
    arithmetic     sigmoid, sine and cosine, arc tangent, as in `arm2d.arithmetic`
    lanes          the state of one trial
    world          what the readings fix, as records and tables on the device
    drives         what inputs drive, tabulated for each network
    controller     sense, think, turn
    camera_at_end  what a camera at the end of S1 sees
    contact        discs against S2
    scores         criteria step by step, F1 to F3 at the end
    loop           one trial from first to last, and the kernels

`numbers` to `loop` are `arm2d.kernel` once more, file by file and sum by sum: float64, + - * / and square
root in the same order, no product and sum fused into one rounding. `arm2d.reference` remains the definition.
"""

"""Controllers made by hand, for worlds small enough to predict."""

import numpy as np

from arm2d import Networks, Readings, Trials, encode


def steady_controller(turn1: int, turn2: int, readings: Readings | None = None) -> np.ndarray:
    """A genotype [84] whose S1 and S2 turn by -1, 0 or +1 times the turn of a step, always."""
    motor = np.zeros((1, 3, 4))
    # Outputs of the inter-neurons stay at 0.5: three weights of w add up to an input of 1.5 w.
    motor[0, :, 0], motor[0, :, 1] = (1.0 if turn1 else -1.0), -float(turn1)
    motor[0, :, 2], motor[0, :, 3] = (1.0 if turn2 else -1.0), -float(turn2)
    networks = Networks(
        sensory_weights=np.zeros((1, 18, 3)),
        recurrent_weights=np.zeros((1, 3, 3)),
        motor_weights=motor,
        decay_constants=np.ones((1, 3)),
        input_bias=np.zeros(1),
        inter_biases=np.zeros((1, 3)),
        motor_bias=np.zeros(1),
        gain=np.ones(1),
    )
    return encode(networks, readings or Readings())[0]


def one_trial(action: int, target: int, alpha: float, discs: dict[int, tuple[float, float]]) -> Trials:
    """One trial with the named discs at (distance [cm], bearing [deg]); the others stand far off."""
    far = {0: (400.0, -80.0), 1: (400.0, 255.0), 2: (400.0, 265.0)}
    polar = np.array([{**far, **discs}[disc] for disc in range(3)])
    angles = np.radians(polar[:, 1])
    centres = polar[:, :1] * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    return Trials(np.array([action]), np.array([target]), np.array([alpha]), centres[np.newaxis])

"""Every number of the arm and its world that no reading changes, with its source.

Units are the paper's: centimetres, degrees, seconds. What the paper leaves open is a
field of `arm2d.readings.Readings` instead.
"""

from typing import Final

# The arm (section III, Fig. 1a). Angles are anticlockwise; x points right, y straight ahead.
S1_LENGTH: Final = 100.0  # [cm]
S2_LENGTH: Final = 50.0  # [cm]
ALPHA_MIN: Final = -30.0  # [deg], right bound of S1
ALPHA_MAX: Final = 210.0  # [deg], left bound of S1
BETA_MIN: Final = 0.0  # [deg], S2 straight
BETA_MAX: Final = 90.0  # [deg], S2 fully bent to the left; every trial starts here

# The objects. Index 0 is blue, 1 green, 2 red everywhere in the project.
N_OBJECTS: Final = 3
CHORD_END_DISTANCE: Final = 150.0  # [cm], from J1 to both ends of a sector's chord (Fig. 1b)

# The camera, bound to S1's direction and seen from J1 (section III).
VIEW_HALF_WIDTH: Final = 15.0  # [deg]
MIDDLE_SECTOR_HALF_WIDTH: Final = 5.0  # [deg]

# Time (section VI).
DT: Final = 0.1  # [s], one control step and one Euler step
MAX_STEPS: Final = 250  # 25 s

# Contact (spec section 3). Chosen: the paper does not describe its contact code.
SUB_STEPS: Final = 4  # equal parts of a control step's motion
PENETRATION_TOLERANCE: Final = 1e-9  # [cm], a disc nearer than rho minus this is hit
TOUCH_TOLERANCE: Final = 1e-6  # [cm], a disc nearer than rho plus this is touched

# Scores (section VI).
GOOD_STEPS_FOR_SUCCESS: Final = 100  # 10 s
THRESHOLD_TOLERANCE: Final = 1e-9  # [deg], a sum this near a threshold has reached it
STRAIGHT: Final = 0.99  # F3 above which S2 counts as stretched, where success asks for it (spec section 12)
COLLISION_FACTOR: Final = 0.6  # P1 after touching an object that is not the target

# The controller (section IV). The paper's has three inter-neurons, and 84 genes; a network may have others
# (arm2d/network/genes.py).
N_INPUTS: Final = 18
N_INTER: Final = 3
N_MOTORS: Final = 4
N_GENES: Final = 84
MOST_INTER: Final = 16

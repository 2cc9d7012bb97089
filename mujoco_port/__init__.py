"""The champion on the humanoid: planar map, inverse kinematics, motors and contacts, video.

    import mujoco_port
    mujoco_port.port_trial(record, "touch-green.mp4")                     # the robot follows a trial
    mujoco_port.port_physical_trial(record, genotype, "touch-green.mp4")  # it acts, and is judged
    record = mujoco_port.drive("move red", alpha, beta)                   # a trajectory of your own
    mujoco_port.Lab("icub", record.readings).follow(record)               # every physics step, and a verdict

    reach     the plane on the table, inverse kinematics, what can be reached
    acting    motors, contacts, eyes, open and closed loop, the verdict in three dimensions
    film      stage, captions, videos
    doctor    what the machine lacks

`__init__.pyi` names what is here; a name is loaded when it is first used.
"""

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)

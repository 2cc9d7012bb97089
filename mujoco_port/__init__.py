"""The champion on the humanoid: planar map, inverse kinematics, control, video."""

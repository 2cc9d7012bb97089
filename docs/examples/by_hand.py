"""A controller written by hand: it looks for the object, points at it, and does what it is told.

python docs/examples/by_hand.py
"""

import arm2d

RIGHT, MIDDLE, LEFT = (
    {word: arm2d.INPUT_NAMES.index(f"camera {side} {word} [0 or 1]") for word in ("blue", "green", "red")}
    for side in ("right", "middle", "left")
)
BEND = arm2d.INPUT_NAMES.index("bend [beta / 90 degrees]")


class ByHand:
    """Obeys one instruction; remembers which way it turns and whether it points at the object."""

    def __init__(self, instruction):
        self.action, self.object = str(instruction).lower().split()
        self.way, self.pointing = 1, False

    def __call__(self, inputs):
        """Turns of shoulder and elbow, -1, 0 or 1 each, from the 18 inputs."""
        right, middle, left = (inputs[place[self.object]] == 1 for place in (RIGHT, MIDDLE, LEFT))
        if self.action == "ignore":
            return (1 if right or middle else -1 if left else 0), 0
        if not self.pointing:
            self.pointing = middle
            if inputs[2:5].all() or inputs[8:11].all():  # white: the shoulder goes no further
                self.way = 1 if right else -1
            elif right or left:
                self.way = 1 if left else -1
            return self.way, 0
        if self.action == "indicate":
            return 0, 0
        if inputs[0] == 0:  # nothing at the forearm's right side: let it come down, then feel there
            return (-1 if inputs[BEND] == 0 else 0), -1
        return (-1 if self.action == "move" else 0), 0


if __name__ == "__main__":
    world = arm2d.World()
    for instruction in arm2d.Condition.WITH_INDICATE.instructions:
        inputs, controller = world.reset(instruction, seed=1), ByHand(instruction)
        while not world.ended:
            inputs = world.step(controller(inputs))
        print(f"{instruction}: {'carried out' if world.score().success[0, 0] else 'failed'}")

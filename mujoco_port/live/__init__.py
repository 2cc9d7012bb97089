"""The robot acts in a web page, in real time: `wordarm live AGENT`.

session.py is the heart, and knows neither page nor socket:

    orders     what a viewer asks for, as text and as a record
    trial      a robot's trial in which the words may change
    planar     the same trial in the 2D world, judged beside the robot's
    placing    where a reader may put objects
    session    what viewers see and may ask for

Around it stands what a browser needs:

    posture    where every part of the robot is at a moment
    surfaces   triangles of MuJoCo's shapes
    scene      shapes and colours for the page
    files      the page itself, in the folder page/
    door       who may come in: hosts, origins, the token
    server     page and socket
    live       from an agent to an address
"""

from mujoco_port.neighbours import check

check()

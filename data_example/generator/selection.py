"""Name the frames that the example's artist has locked as key shapes.

They are picked as an artist picks them, by eye: poses that the actor holds in the
range-of-motion take. The neutral is none of them: its sculpt would be the neutral mesh. What a
region's frame shows of other regions does not matter, its sculpt leaves that out; frames on which
the gaze lifts or lowers the lids much are avoided for the eyes.
"""

SHOT = "rom"
LOCKED = {
    "mouth": (41, 57, 74, 91, 106, 121, 137, 166, 181, 219, 244, 370),
    "eyes": (57, 163, 272, 286, 299, 311, 322, 335, 346, 356),
    "pupils": (88, 106, 133, 150, 177),
}

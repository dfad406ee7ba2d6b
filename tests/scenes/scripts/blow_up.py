"""The test tooth with a time step that its own check would never let pass."""
from rockwear.run.main import main
from rockwear.scenes import cutting


def make(values):
    """The scene of the test tooth at three times its critical step."""
    scene = cutting.make(values)
    scene.time_step = 3 * scene.bonded_step
    return scene


main("blow_up", cutting.GROUPS, make)

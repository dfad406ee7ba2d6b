"""A run whose user presses Ctrl-C while its scene is made."""
import os
import signal
import time

from rockwear.run.main import main


def make_scene(values):
    os.kill(os.getpid(), signal.SIGINT)
    time.sleep(10)


# A shell's background jobs are started with it ignored.
signal.signal(signal.SIGINT, signal.default_int_handler)
main("interrupted", [], make_scene)

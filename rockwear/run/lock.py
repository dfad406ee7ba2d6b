"""One run at a time in a folder, whoever starts it and on whichever machine of a shared file system."""
import fcntl

from rockwear.kernels.checks import ParameterError

FILE = "lock"
"""In the folder of a run."""


def hold(folder):
    """Lock `folder` for this process until it ends, however it ends. -> the open file, to be kept.

    Raises ParameterError while another process holds the lock. Where a file system knows no locks, nothing is locked.
    """
    file = open(folder / FILE, "a", encoding="utf-8")
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        file.close()
        raise ParameterError("out", str(folder), "a folder that no other run writes at present") from None
    except OSError:
        pass
    return file

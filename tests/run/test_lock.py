"""One run at a time writes a folder."""
import pytest

from rockwear.kernels.checks import ParameterError
from rockwear.run import lock


def test_a_folder_is_held_until_its_run_ends(tmp_path):
    held = lock.hold(tmp_path)
    with pytest.raises(ParameterError, match=r"^out = .*: must be a folder that no other run writes at present$"):
        lock.hold(tmp_path)
    held.close()
    lock.hold(tmp_path).close()

"""Makes the packages beside this folder importable; YADE looks for modules in the system's folders only."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

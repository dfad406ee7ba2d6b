"""Layers: what each part of the project may import."""
import ast
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PLAIN = {"numpy", "scipy", "numba"}
PAPER = PLAIN | {"matplotlib", "mpl_toolkits", "PIL"}
YADE = PLAIN | {"yade", "minieigen"}

LAYERS = {
    # folder or file: (parts of the project, packages beside the standard library)
    "rockwear/kernels": ({"rockwear.kernels"}, PLAIN),
    "rockwear/model": ({"rockwear.kernels", "rockwear.model"}, PLAIN | {"stl"}),
    "rockwear/engines": ({"rockwear.kernels", "rockwear.model", "rockwear.engines"}, YADE),
    "rockwear/report": ({"rockwear.kernels", "rockwear.report"}, PAPER),
    "rockwear/run": ({"rockwear.kernels", "rockwear.engines", "rockwear.report", "rockwear.run"}, YADE),
    "rockwear/scenes": (
        {"rockwear.kernels", "rockwear.model", "rockwear.engines", "rockwear.run", "rockwear.scenes"}, YADE),
    "yade_scripts": ({"rockwear.scenes", "rockwear.run", "calibration.laboratory"}, set()),
    # A command that runs scenes and draws; no scene imports it.
    "calibration/laboratory/envelope.py": (
        {"rockwear.kernels", "rockwear.report", "calibration.campaigns.runs", "calibration.command",
         "calibration.generated", "calibration.laboratory.envelope_figure",
         "calibration.laboratory.strength_table"}, PAPER),
    "calibration/laboratory": (
        {"rockwear.kernels", "rockwear.model", "rockwear.engines", "rockwear.run", "rockwear.report", "rockwear.scenes",
         "calibration.laboratory"}, YADE),
}


def imports(file):
    """Full names of the modules that a file imports; of `from package import name`, package.name."""
    package = file.relative_to(ROOT).with_suffix("").parts[:-1]
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = ".".join(package[:len(package) - node.level + 1]) if node.level else ""
            yield from (".".join(filter(None, [base, node.module, alias.name])) for alias in node.names)


def allowed(name, parts, packages):
    """Whether a module may be imported. The version of the package may be everywhere."""
    first = name.partition(".")[0]
    if first not in {"rockwear", "calibration", "tests", "yade_scripts"}:
        return first in packages or first in sys.stdlib_module_names
    return name == "rockwear.__version__" or any(f"{name}.".startswith(f"{part}.") for part in parts)


@pytest.mark.parametrize("layer", LAYERS)
def test_a_layer_imports_only_what_lies_below(layer):
    place = ROOT / layer
    files = [file for file in (sorted(place.rglob("*.py")) or [place])
             if file == place or str(file.relative_to(ROOT)) not in LAYERS]
    wrong = [f"{file.relative_to(ROOT)} imports {name}" for file in files for name in imports(file)
             if not allowed(name, *LAYERS[layer])]
    assert files and not wrong, "\n".join(wrong)


def test_every_folder_of_the_package_is_a_layer():
    folders = {f"rockwear/{path.parent.name}" for path in (ROOT / "rockwear").glob("*/__init__.py")}
    assert folders == {layer for layer in LAYERS if layer.startswith("rockwear/")}


@pytest.mark.parametrize("name, right", [
    ("rockwear.kernels.checks", True), ("rockwear.kernels", True), ("rockwear.kernelsx", False), ("math", True),
    ("rockwear.engines.base", False), ("numpy", True), ("yade", False), ("rockwear", False)])
def test_the_rule_itself(name, right):
    assert allowed(name, *LAYERS["rockwear/kernels"]) == right
